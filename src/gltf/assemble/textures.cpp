// SPDX-License-Identifier: MIT
#include "gltf/assemble/textures.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "gltf/read/container.h"
#include "image/files/header.h"
#include "image/files/process.h"
#include "image/format.h"
#include "image/image.h"

namespace fragtrace {

namespace {

using nlohmann::json;

constexpr const char* kBasisu = "KHR_texture_basisu";
constexpr const char* kAvif = "EXT_texture_avif";
constexpr double kTexturesPart = 0.4;  // share of a load that is done when they are read

Wrap wrapOf(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::ClampToEdge;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::MirroredRepeat : Wrap::Repeat;
}

/// The bytes of a picture where it stands, not decoded.
std::vector<uint8_t> imageBytes(Document& document, int index) {
  ImageSource& source = document.bytes->images.at(size_t(index));
  if (source.bufferView >= 0) {
    const std::span<const uint8_t> bytes = bytesOf(document, source.bufferView);
    return {bytes.begin(), bytes.end()};
  }
  if (!source.bytes.empty()) return source.bytes;
  const std::string place = pointerTo("images", index);
  if (source.uri.empty()) document.diagnostics.lose(place, "has neither a URI nor a buffer view");
  std::vector<uint8_t> bytes = document.diagnostics.attemptObject(
      place + "/uri", [&] { return readUri(document.access, source.uri, document.memory); });
  if (const std::string odd = oddityOf(document.access, source.uri); !odd.empty())
    document.diagnostics.warn(place + "/uri", odd);
  if (document.keepsPictures) source.bytes = bytes;
  return bytes;
}

/// Names the file, if it is one, in what is thrown, also where its format cannot be decoded.
ImageHeader headerOf(const std::vector<uint8_t>& bytes, const std::string& file) {
  try {
    ImageHeader header = readImageHeader(bytes);
    if (header.format == ImageFormat::Ktx2 && !whyNoKtx2().empty())
      throw std::runtime_error("KTX2 cannot be decoded: " + whyNoKtx2());
    return header;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error((file.empty() ? "" : file + ": ") + error.what());
  }
}

EncodedImage readImage(Document& document, int index) {
  const ImageSource& source = document.bytes->images.at(size_t(index));
  const std::string place = pointerTo("images", index);
  EncodedImage result;
  const bool isFile = source.bufferView < 0 && !isDataUri(source.uri);
  result.name =
      isFile ? pathOfUri(document.access, source.uri).string() : document.diagnostics.file() + ": " + place;
  result.place = document.diagnostics.file() + ": " + place;
  result.bytes = imageBytes(document, index);
  const ImageHeader header = document.diagnostics.attemptObject(
      place, [&] { return headerOf(result.bytes, isFile ? source.uri : ""); });
  if (header.format == ImageFormat::Pfm || header.format == ImageFormat::Hdr ||
      header.format == ImageFormat::OpenExr)
    document.diagnostics.lose(place, "is no picture that a texture may have: PNG, JPEG, WebP, KTX2, AVIF");
  result.width = header.width;
  result.height = header.height;
  result.texelBits = header.texelBits;
  if (std::max(header.width, header.height) > document.textureSide) {
    const double scale = double(document.textureSide) / std::max(header.width, header.height);
    result.width = std::max(1, int(std::lround(header.width * scale)));
    result.height = std::max(1, int(std::lround(header.height * scale)));
    document.diagnostics.warn(place, "pictures wider or higher than " + std::to_string(document.textureSide) +
                                         " pixels are scaled down");
  }
  return result;
}

/// The picture that an extension of a texture names; else another one.
int sourceIn(const json& texture, const char* extension, int otherwise) {
  return int(numberOf(extensionOf(texture, extension), "source", otherwise));
}

int webpOf(const json& texture) { return sourceIn(texture, "EXT_texture_webp", texture.value("source", -1)); }

/// Returns the index of a texture's picture, or -1. The picture of EXT_texture_webp takes precedence over the
/// fallback. Those of EXT_texture_avif and KHR_texture_basisu are used only without a fallback, since not
/// every system decodes them, and the compression of the second has lost more.
int imageOf(const json& texture) {
  const int source = webpOf(texture);
  return source >= 0 ? source : sourceIn(texture, kAvif, sourceIn(texture, kBasisu, -1));
}

/// Returns true where the file does without the texture: it has only a KTX2 picture, and the file does not
/// require that extension.
bool isDispensable(const tinygltf::Model& model, const json& texture) {
  const std::vector<std::string>& required = model.extensionsRequired;
  return webpOf(texture) < 0 && sourceIn(texture, kAvif, -1) < 0 &&
         std::ranges::find(required, kBasisu) == required.end();
}

/// Returns true if a picture is a file that is not there.
bool isMissing(const Document& document, int image) {
  const ImageSource& source = document.bytes->images.at(size_t(image));
  return source.bufferView < 0 && source.bytes.empty() && isMissing(document.access, source.uri);
}

/// A reason without the name of the file, with which it begins, or else after a space.
std::string withoutName(const Document& document, const std::string& uri, const std::string& reason) {
  if (!uri.empty() && !isDataUri(uri)) {
    for (const std::string& name : {pathOfUri(document.access, uri).string(), inQuotes(uri), uri}) {
      if (reason.starts_with(name)) return reason.substr(name.size());
    }
  }
  return " " + reason;
}

/// The picture to draw: the fallback of a KTX2 picture stays away where its file is missing.
int drawnImage(Document& document, const json& texture) {
  const int image = imageOf(texture);
  const int ktx2 = sourceIn(texture, kBasisu, -1);
  const bool isAlone = image >= 0 && ktx2 >= 0 && isMissing(document, image) && !isMissing(document, ktx2);
  if (!isAlone || !whyNoKtx2().empty()) return image;
  document.diagnostics.warn(pointerTo("images", image),
                            inQuotes(document.bytes->images[size_t(image)].uri) +
                                " is missing; the KTX2 picture beside it is drawn");
  return ktx2;
}

}  // namespace

TextureTable::TextureTable(Document& document, Scene& scene)
    : document_(document),
      scene_(scene),
      textures_(document.model.textures.size(), kMissIndex),
      images_(document.bytes->images.size(), kMissIndex),
      lost_(document.bytes->images.size()) {}

TextureRef TextureTable::lose(int image, const std::string& place, const std::string& reason) {
  TextureRef ref;
  ref.lost = true;
  const std::string uri = image >= 0 ? document_.bytes->images.at(size_t(image)).uri : "";
  if (isDrawn_ && !document_.drawMissingTextures) {
    std::vector<std::string> uris;
    for (const ImageSource& source : document_.bytes->images) uris.push_back(source.uri);
    document_.diagnostics.refuse(place, reason + alsoMissing(document_.access, uris, uri) +
                                            " (--missing-textures magenta draws the scene without it)");
  }
  if (document_.diagnostics.isLost(place)) return ref;  // which has been told
  const std::string kind = withoutName(document_, uri, reason);
  auto group = std::ranges::find_if(
      reasons_, [&](const LostPictures& one) { return one.reason == kind && one.isDrawn == isDrawn_; });
  if (group == reasons_.end()) group = reasons_.insert(group, {place, kind, isDrawn_, {}});
  const std::string name = uri.empty() || isDataUri(uri) ? place : uri;
  if (std::ranges::find(group->names, name) == group->names.end()) group->names.push_back(name);
  return ref;
}

void TextureTable::warnOfLost() {
  for (const LostPictures& lost : reasons_) {
    const bool isNamed = lost.names.size() > 1 || lost.names[0] != lost.place;
    document_.diagnostics.warn(
        lost.place, (isNamed ? listed(lost.names) + lost.reason : lost.reason.substr(1)) +
                        (lost.isDrawn ? "; a base colour is drawn in magenta, other textures are left out"
                                      : "; no drawn material has it"));
  }
}

uint32_t TextureTable::useImage(int image) {
  uint32_t& known = images_.at(size_t(image));
  if (known != kMissIndex) return known;
  if (const auto& loss = lost_[size_t(image)]) {
    lose(image, loss->place, loss->reason);
    return known;
  }
  if (document_.progress)
    document_.progress("reading texture " + std::to_string(scene_.images.size() + 1) + " of " +
                           std::to_string(images_.size()),
                       kTexturesPart);
  try {
    EncodedImage encoded = readImage(document_, image);
    known = uint32_t(scene_.images.size());
    scene_.images.push_back(std::move(encoded));
  } catch (const Loss& loss) {
    lost_[size_t(image)] = loss;
    lose(image, loss.place, loss.reason);
    return kMissIndex;
  } catch (const InputError& error) {
    if (isDrawn_) throw;  // memory or another folder is at stake
    lose(image, pointerTo("images", image), "is not read");
    return kMissIndex;
  }
  const EncodedImage& read = scene_.images.back();
  takeMemory(document_, pointerTo("images", image), read.bytes.size() + texelBytes(read));
  return known;
}

TextureRef TextureTable::use(int texture) {
  TextureRef ref;
  uint32_t& known = textures_.at(size_t(texture));
  ref.texture = known;
  if (known != kMissIndex) return ref;
  const json& source = jsonOf(document_, "textures", texture);
  const int image = drawnImage(document_, source);
  if (image < 0) {
    return lose(-1, pointerTo("textures", texture), "has no picture");
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
  if (const int index = document_.model.textures.at(size_t(texture)).sampler; index >= 0) {
    const tinygltf::Sampler& sampler = document_.model.samplers.at(size_t(index));
    result.wrapU = wrapOf(sampler.wrapS);
    result.wrapV = wrapOf(sampler.wrapT);
    result.linear = sampler.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  ref.texture = known = uint32_t(scene_.textures.size());
  scene_.textures.push_back(result);
  return ref;
}

bool mayHaveAlpha(std::span<const uint8_t> encoded) {
  constexpr size_t kColorType = 25;  // in the header, which comes first (PNG specification, 11.2.1)
  constexpr uint8_t kAlphaChannel = 4;
  const std::optional<ImageFormat> format = formatOfBytes(encoded);
  if (format == ImageFormat::Jpeg) return false;
  if (format != ImageFormat::Png || encoded.size() <= kColorType) return true;
  // A colour, or the colours of a palette, may be transparent by a chunk that stands before the pixels.
  const std::string_view bytes(reinterpret_cast<const char*>(encoded.data()), encoded.size());
  const size_t pixels = bytes.find("IDAT");
  return (encoded[kColorType] & kAlphaChannel) != 0 || pixels == std::string_view::npos ||
         bytes.substr(0, pixels).find("tRNS") != std::string_view::npos;
}

void settleLeastAlpha(Scene& scene) {
  const auto isOpaque = [](const Material& m) { return m.alphaMode == AlphaMode::Opaque; };
  if (std::ranges::all_of(scene.materials, isOpaque)) return;
  for (Material& m : scene.materials) {
    if (isOpaque(m) || !m.baseColorTexture.present()) continue;
    const EncodedImage& image = scene.images[scene.textures[m.baseColorTexture.texture].image];
    if (mayHaveAlpha(image.bytes)) m.leastAlpha = 0.0f;
  }
  if (scene.vertices.color.empty()) return;
  const auto meet = [&](uint32_t material, uint32_t vertex) {
    float& least = scene.materials[material].leastAlpha;
    least = std::min(least, scene.vertices.color[vertex].a);
  };
  for (const Triangle& t : scene.triangles)
    for (int corner = 0; corner < 3; ++corner) meet(t.material, t.vertex[corner]);
  for (const Strokes& strokes : scene.strokes)
    for (const glm::uvec2& ends : strokes.ends)
      for (int end = 0; end < 2; ++end) meet(strokes.material, ends[end]);
}

}  // namespace fragtrace
