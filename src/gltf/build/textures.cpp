// SPDX-License-Identifier: MIT
#include "gltf/build/textures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "gltf/read/uri.h"
#include "gltf/read/value.h"
#include "image/files/header.h"
#include "image/files/process.h"
#include "image/image.h"

namespace fragtrace {
namespace {

constexpr const char* kBasisu = "KHR_texture_basisu";
constexpr double kTexturesPart = 0.4;  // share of a load that is done when they are read

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

/// The bytes of a picture where it stands, not decoded.
std::vector<uint8_t> imageBytes(Document& document, int index) {
  ImageSource& source = document.images.at(size_t(index));
  if (source.bufferView >= 0) {
    const std::span<const uint8_t> bytes = bytesOf(document, source.bufferView);
    return {bytes.begin(), bytes.end()};
  }
  if (!source.bytes.empty()) return source.bytes;
  std::vector<uint8_t> bytes = document.diagnostics.attempt(pointerTo("images", index, "uri"), [&] {
    return readUri(document.access, source.uri, document.memory);
  });
  if (document.keepsPictures) source.bytes = bytes;
  return bytes;
}

/// Warns of a media type, declared for the picture, that its bytes are not of.
void warnMediaType(std::string_view declared, ImageFormat format, const std::string& place,
                   Diagnostics& diagnostics) {
  const std::string_view found = format == ImageFormat::Png    ? "image/png"
                                 : format == ImageFormat::Jpeg ? "image/jpeg"
                                 : format == ImageFormat::WebP ? "image/webp"
                                 : format == ImageFormat::Ktx2 ? "image/ktx2"
                                                               : "";
  if (found.empty()) {
    diagnostics.warn(place,
                     "is neither PNG nor JPEG nor WebP nor KTX2, as glTF wants it; it is read if it can be");
  } else if (!declared.empty() && declared != found) {
    diagnostics.warn(place, "is declared " + inQuotes(declared) + " and is " + std::string(found) +
                                ", as which it is read");
  }
}

/// Names the file, if it is one, in what is thrown, also where its format cannot be decoded.
ImageHeader headerOf(const std::vector<uint8_t>& bytes, const std::string& file) {
  try {
    const ImageHeader header = readImageHeader(bytes);
    if (header.format == ImageFormat::Ktx2 && !whyNoKtx2().empty())
      throw std::runtime_error("KTX2 cannot be decoded: " + whyNoKtx2());
    return header;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error((file.empty() ? "" : file + ": ") + error.what());
  }
}

EncodedImage readImage(Document& document, int index) {
  const ImageSource& source = document.images.at(size_t(index));
  const std::string place = pointerTo("images", index);
  EncodedImage result;
  const bool isFile = source.bufferView < 0 && !isDataUri(source.uri);
  result.name =
      isFile ? pathOfUri(document.access, source.uri).string() : document.diagnostics.file() + ": " + place;
  result.place = document.diagnostics.file() + ": " + place;
  result.bytes = imageBytes(document, index);
  const ImageHeader header =
      document.diagnostics.attempt(place, [&] { return headerOf(result.bytes, isFile ? source.uri : ""); });
  if (header.format == ImageFormat::Pfm || header.format == ImageFormat::Hdr ||
      header.format == ImageFormat::OpenExr)
    document.diagnostics.refuse(place, "is no picture that a texture may have: PNG, JPEG, WebP, KTX2");
  result.width = header.width;
  result.height = header.height;
  if (std::max(header.width, header.height) > document.textureSide) {
    const double scale = double(document.textureSide) / std::max(header.width, header.height);
    result.width = std::max(1, int(std::lround(header.width * scale)));
    result.height = std::max(1, int(std::lround(header.height * scale)));
    document.diagnostics.warn(place, "pictures wider or higher than " + std::to_string(document.textureSide) +
                                         " pixels are scaled down");
  }
  warnMediaType(
      source.bufferView < 0 && !isFile ? mediaTypeOf(source.uri) : std::string_view(source.mimeType),
      header.format, isFile || source.bufferView >= 0 ? place : place + "/uri", document.diagnostics);
  return result;
}

/// The picture that an extension of a texture names; else another one.
int sourceIn(const tinygltf::Texture& texture, const char* extension, int otherwise) {
  const auto found = texture.extensions.find(extension);
  return found != texture.extensions.end() ? int(numberOf(found->second, "source", otherwise)) : otherwise;
}

/// Returns the index of a texture's picture, or -1. The picture of EXT_texture_webp takes precedence over the
/// fallback. The picture of KHR_texture_basisu is used only without a fallback, since its compression has
/// lost more and not every build decodes it.
int sourceOf(const tinygltf::Texture& texture) {
  const int source = sourceIn(texture, "EXT_texture_webp", texture.source);
  return source >= 0 ? source : sourceIn(texture, kBasisu, -1);
}

/// Returns true where the file does without the texture: it has only a KTX2 picture, and the file does not
/// require that extension.
bool isDispensable(const tinygltf::Model& model, const tinygltf::Texture& texture) {
  const std::vector<std::string>& required = model.extensionsRequired;
  return sourceIn(texture, "EXT_texture_webp", texture.source) < 0 &&
         std::ranges::find(required, kBasisu) == required.end();
}

/// Returns true if a picture is a file that is not there.
bool isMissing(const Document& document, int image) {
  const ImageSource& source = document.images.at(size_t(image));
  std::error_code error;
  return source.bufferView < 0 && source.bytes.empty() && !isDataUri(source.uri) &&
         !std::filesystem::exists(pathOfUri(document.access, source.uri), error);
}

/// The picture to draw: the fallback of a KTX2 picture stays away where its file is missing.
int drawnImage(Document& document, const tinygltf::Texture& texture) {
  const int image = sourceOf(texture);
  const int ktx2 = sourceIn(texture, kBasisu, -1);
  const bool isAlone = image >= 0 && ktx2 >= 0 && isMissing(document, image) && !isMissing(document, ktx2);
  if (!isAlone || !whyNoKtx2().empty()) return image;
  document.diagnostics.warn(
      pointerTo("images", image),
      inQuotes(document.images[size_t(image)].uri) + " is missing; the KTX2 picture beside it is drawn");
  return ktx2;
}

}  // namespace

TextureTable::TextureTable(Document& document, Scene& scene)
    : document_(document),
      scene_(scene),
      textures_(document.model.textures.size(), kMissIndex),
      images_(document.images.size(), kMissIndex),
      lost_(document.images.size(), false) {}

void TextureTable::warnLost(int image, const std::string& reason) {
  lost_[size_t(image)] = true;
  const std::string file = document_.diagnostics.file() + ": ";
  const std::string& uri = document_.images.at(size_t(image)).uri;
  const bool isNamed = uri.empty() || isDataUri(uri) || reason.find(uri) != std::string::npos;
  document_.diagnostics.warn(
      "", (reason.starts_with(file) ? reason.substr(file.size()) : reason) +
              (isNamed ? "" : " (" + uri + ")") +
              "; a base colour is drawn in magenta, other textures are left out (--missing-textures warn)");
}

uint32_t TextureTable::useImage(int image) {
  uint32_t& known = images_.at(size_t(image));
  if (known != kMissIndex || lost_[size_t(image)]) return known;
  if (document_.progress)
    document_.progress("reading texture " + std::to_string(scene_.images.size() + 1) + " of " +
                           std::to_string(images_.size()),
                       kTexturesPart);
  try {
    EncodedImage encoded = readImage(document_, image);
    if (document_.drawMissingTextures)
      decodeTexels(encoded.bytes, nameOf(encoded));  // a fault shows only then
    known = uint32_t(scene_.images.size());
    scene_.images.push_back(std::move(encoded));
  } catch (const InputError& error) {
    // A picture that is there, and too large, is not missing.
    if (std::string_view(error.what()).ends_with("--memory-limit")) throw;
    if (!document_.drawMissingTextures)
      throw InputError(std::string(error.what()) + " (--missing-textures warn draws the scene without it)");
    warnLost(image, error.what());
    return kMissIndex;
  }
  const EncodedImage& read = scene_.images.back();
  takeMemory(document_, pointerTo("images", image), read.bytes.size() + texelBytes(read));
  return known;
}

TextureRef TextureTable::use(int texture, const std::string& place) {
  TextureRef ref;
  uint32_t& known = textures_.at(size_t(texture));
  ref.texture = known;
  if (known != kMissIndex) return ref;
  const tinygltf::Texture& source = document_.model.textures[size_t(texture)];
  const int image = drawnImage(document_, source);
  if (image < 0) {
    document_.diagnostics.warn(place, "a texture without a picture is left out");
    return ref;
  }
  if (isDispensable(document_.model, source) && !whyNoKtx2().empty()) {
    document_.diagnostics.warn(pointerTo("textures", texture, "extensions", kBasisu),
                               "is left out: KTX2 cannot be decoded: " + whyNoKtx2());
    return ref;
  }
  Texture result;
  result.image = useImage(image);
  ref.lost = result.image == kMissIndex;
  if (ref.lost) return ref;
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = document_.model.samplers.at(size_t(source.sampler));
    const std::string samplerPlace = pointerTo("samplers", source.sampler);
    result.wrapU = wrapOf(sampler.wrapS, samplerPlace + "/wrapS", document_.diagnostics);
    result.wrapV = wrapOf(sampler.wrapT, samplerPlace + "/wrapT", document_.diagnostics);
    result.linear = sampler.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  ref.texture = known = uint32_t(scene_.textures.size());
  scene_.textures.push_back(result);
  return ref;
}

}  // namespace fragtrace
