// SPDX-License-Identifier: MIT
#include "gltf/textures.h"

#include "gltf/uri.h"

namespace fragtrace {
namespace {

Wrap wrapOf(int mode, const std::string& place, Diagnostics& diagnostics) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::Repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::ClampToEdge;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::MirroredRepeat;
    default:
      diagnostics.refuse(place, std::to_string(mode) + " is not a wrap mode");
  }
}

EncodedImage readImage(const Document& document, int index) {
  const ImageSource& source = document.images.at(size_t(index));
  const Diagnostics& diagnostics = document.diagnostics;
  EncodedImage result;
  result.name = diagnostics.file() + ": " + pointerTo("images", index);
  if (source.bufferView >= 0) {
    const std::span<const uint8_t> bytes = bytesOf(document, source.bufferView);
    result.bytes.assign(bytes.begin(), bytes.end());
    return result;
  }
  std::string reason;
  if (!readUri(document.folder, source.uri, result.bytes, reason)) {
    diagnostics.refuse(pointerTo("images", index, "uri"), reason);
  }
  if (!isDataUri(source.uri)) result.name = pathOfUri(document.folder, source.uri).string();
  if (result.bytes.empty()) diagnostics.refuse(pointerTo("images", index), "the picture is empty");
  return result;
}

}  // namespace

TextureTable::TextureTable(Document& document, Scene& scene)
    : document_(document),
      scene_(scene),
      textures_(document.model.textures.size(), kMissIndex),
      images_(document.images.size(), kMissIndex) {}

uint32_t TextureTable::useImage(int image) {
  uint32_t& known = images_.at(size_t(image));
  if (known == kMissIndex) {
    known = uint32_t(scene_.images.size());
    scene_.images.push_back(readImage(document_, image));
  }
  return known;
}

uint32_t TextureTable::use(int texture, const std::string& place) {
  uint32_t& known = textures_.at(size_t(texture));
  if (known != kMissIndex) return known;
  const tinygltf::Texture& source = document_.model.textures[size_t(texture)];
  if (source.source < 0) {
    document_.diagnostics.warn(place, "a texture without a picture is left out");
    return kMissIndex;
  }
  Texture result;
  result.image = useImage(source.source);
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = document_.model.samplers.at(size_t(source.sampler));
    const std::string samplerPlace = pointerTo("samplers", source.sampler);
    result.wrapU = wrapOf(sampler.wrapS, samplerPlace + "/wrapS", document_.diagnostics);
    result.wrapV = wrapOf(sampler.wrapT, samplerPlace + "/wrapT", document_.diagnostics);
    result.linear = sampler.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  known = uint32_t(scene_.textures.size());
  scene_.textures.push_back(result);
  return known;
}

}  // namespace fragtrace
