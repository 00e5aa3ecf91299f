// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <glm/glm.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "image/channels.h"
#include "image/display/tone_map.h"
#include "image/files/header.h"
#include "image/files/pfm.h"
#include "image/files/process.h"
#include "image/files/video_format.h"
#include "image/files/whole_file.h"
#include "image/format.h"
#include "image/image.h"

namespace fragtrace {

namespace {

// Applies to the values of a picture what its header says about them.

/// Puts each pixel of scan lines where the header says.
Image asTurned(Image stored, const ImageHeader& header) {
  const HdrForm& form = header.hdr;
  if (!form.columns && !form.fromRight && !form.fromBottom) return stored;
  Image image = stored;
  std::swap(image.values, stored.values);
  image.values.resize(stored.values.size());
  image.width = header.width;
  image.height = header.height;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int fromX = form.fromRight ? image.width - 1 - x : x;
      const int fromY = form.fromBottom ? image.height - 1 - y : y;
      const size_t from = form.columns ? size_t(fromX) * size_t(image.height) + size_t(fromY)
                                       : size_t(fromY) * size_t(image.width) + size_t(fromX);
      std::copy_n(&stored.values[from * image.channelCount()], image.channelCount(), image.pixel(x, y));
    }
  }
  return image;
}

void takeExposureBack(Image& image, const std::array<double, 3>& exposure) {
  if (exposure == HdrForm().exposure) return;
  for (size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = float(image.values[i] / exposure[i % image.channelCount() % 3]);
  const bool isGrey = exposure[0] == exposure[1] && exposure[1] == exposure[2];
  image.notes.push_back(isGrey ? formatted("is divided by its EXPOSURE, %.6g", exposure[0])
                               : formatted("is divided by its EXPOSURE and COLORCORR, %.6g, %.6g, %.6g",
                                           exposure[0], exposure[1], exposure[2]));
}

// Chromaticities: x and y of red, green, blue and white.

constexpr std::array<float, 8> kRec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};

glm::dvec3 chromaticity(std::span<const float> values, size_t i) {
  const double x = values[2 * i], y = values[2 * i + 1];
  return {x, y, 1.0 - x - y};
}

/// Returns the matrix from RGB to XYZ in which white has Y = 1.
glm::dmat3 toXyz(std::span<const float> values) {
  const glm::dmat3 primaries(chromaticity(values, 0), chromaticity(values, 1), chromaticity(values, 2));
  const glm::dvec3 amounts = glm::inverse(primaries) * (chromaticity(values, 3) / double(values[7]));
  return {primaries[0] * amounts.x, primaries[1] * amounts.y, primaries[2] * amounts.z};
}

/// Adapts XYZ colours from one white to another, as Bradford's model of the eye does (Lam 1985).
glm::dmat3 adaptation(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dmat3 cones(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296);
  const glm::dvec3 ratio = (cones * to) / (cones * from);
  return glm::inverse(cones) * glm::dmat3(ratio.x, 0, 0, 0, ratio.y, 0, 0, 0, ratio.z) * cones;
}

/// Returns the matrix to Rec. 709; none where the chromaticities span no colours.
std::optional<glm::dmat3> toRec709(std::span<const float> values) {
  const glm::dvec3 ones(1.0);
  const glm::dmat3 from = toXyz(values), to = toXyz(kRec709);
  const glm::dmat3 matrix = glm::inverse(to) * adaptation(from * ones, to * ones) * from;
  for (int c = 0; c < 3; ++c) {
    if (glm::any(glm::isnan(matrix[c])) || glm::any(glm::isinf(matrix[c]))) return std::nullopt;
  }
  return matrix;
}

/// Returns true if the channels R, G and B of a layer of that name are no colours.
bool isNoColor(std::string_view layer) {
  const std::string_view name = layer.substr(layer.rfind('.') + 1);
  constexpr std::array kNames{"N", "Ns", "P", "normal", "Normal", "position", "Position", "Vector", "UV"};
  return name.starts_with("Crypto") || name.starts_with("crypto") || name.ends_with("Normal") ||
         std::ranges::find(kNames, name) != kNames.end();
}

/// Multiplies the colours of all layers by the matrix.
void multiplyColors(Image& image, const glm::dmat3& matrix) {
  for (size_t red = 0; red < image.channelCount(); ++red) {
    const std::string& name = image.channels[red];
    if (name != "R" && !name.ends_with(".R")) continue;
    const std::string layer = name.substr(0, name.size() - 1);
    const auto green = findChannel(image, layer + "G"), blue = findChannel(image, layer + "B");
    if (!green || !blue || isNoColor(std::string_view(layer).substr(0, layer.size() - !layer.empty())))
      continue;
    for (size_t first = 0; first < image.values.size(); first += image.channelCount()) {
      float* pixel = &image.values[first];
      const glm::dvec3 color = matrix * glm::dvec3(pixel[red], pixel[*green], pixel[*blue]);
      if (!std::isfinite(color.r + color.g + color.b)) continue;
      pixel[red] = float(color.r);
      pixel[*green] = float(color.g);
      pixel[*blue] = float(color.b);
    }
  }
}

void convertToRec709(Image& image) {
  const auto found = image.numbers.find("chromaticities");
  if (found == image.numbers.end()) return;
  std::vector<float>& values = found->second;
  constexpr float kSame = 1e-3f;  // half a unit of the last digit that standards state
  const auto isNear = [](float a, float b) { return std::abs(a - b) <= kSame; };
  if (std::ranges::equal(values, kRec709, isNear)) return;
  const auto matrix = toRec709(values);
  if (matrix) multiplyColors(image, *matrix);
  image.notes.emplace_back(matrix ? "has other primaries than Rec. 709, to which its colours are converted"
                                  : "has chromaticities that span no colours, and is taken for Rec. 709");
  values.assign(kRec709.begin(), kRec709.end());
}

/// The channels of a part, as a range of those of the file.
struct ExrPart {
  std::string name;
  std::vector<std::string> channels;
  size_t first = 0;
};

std::vector<ExrPart> exrPartsOf(const Image& image) {
  std::vector<ExrPart> parts;
  for (size_t i = 0; i < image.channelCount(); ++i) {
    const size_t end = image.channels[i].find('\n');
    const std::string name = image.channels[i].substr(0, end);
    if (parts.empty() || parts.back().name != name) parts.push_back({name, {}, i});
    parts.back().channels.push_back(image.channels[i].substr(end + 1));
  }
  return parts;
}

/// Returns true for the names that renderers and compositing programs give the picture itself.
bool isBeauty(std::string_view part) {
  constexpr std::array<std::string_view, 8> kNames{"rgba",   "rgb",    "RGBA", "RGB",
                                                   "beauty", "Beauty", "C",    "Combined"};
  return std::ranges::find(kNames, part.substr(part.rfind('.') + 1)) != kNames.end();
}

/// 0 for the part that is most likely the picture.
int rankOfPart(const ExrPart& part) {
  for (const char* name : {"R", "G", "B"}) {
    if (std::ranges::find(part.channels, name) == part.channels.end()) return 2;
  }
  return isBeauty(part.name) ? 0 : 1;
}

/// Names the channels of an .exr of several parts, which the worker calls by both names with a line end
/// between: PART\nCHANNEL. The part of the colours comes first, and its channels keep their names: the first
/// that is called as a beauty pass is, else the first that has R, G and B, else the first. Of the others, a
/// channel without a layer gets the name of its part in front, such as "depth.Z", and so does one whose name
/// is taken.
Image namedParts(Image stored) {
  const auto isOfPart = [](const std::string& name) { return name.find('\n') != std::string::npos; };
  if (!std::ranges::all_of(stored.channels, isOfPart)) return stored;
  std::vector<ExrPart> parts = exrPartsOf(stored);
  const auto color = std::ranges::min_element(parts, {}, rankOfPart);
  std::rotate(parts.begin(), color, color + 1);

  std::set<std::string> taken;
  std::vector<size_t> from;
  stored.channels.clear();
  for (const ExrPart& part : parts) {
    for (size_t i = 0; i < part.channels.size(); ++i) {
      std::string name = part.channels[i];
      const bool isPlain = &part != &parts.front() && name.find('.') == std::string::npos;
      if (isPlain || taken.contains(name)) name.insert(0, part.name + ".");
      while (!taken.insert(name).second) name += "'";
      stored.channels.push_back(name);
      from.push_back(part.first + i);
    }
  }
  const std::vector<float> values = std::move(stored.values);
  stored.values.clear();
  stored.values.reserve(values.size());
  for (size_t pixel = 0; pixel < values.size(); pixel += from.size()) {
    for (const size_t i : from) stored.values.push_back(values[pixel + i]);
  }
  return stored;
}

/// Makes of stored values the radiance of the picture, in linear Rec. 709, with the first row on top: turns
/// the scan lines of an .hdr and takes its exposure back, and converts colours of an .exr with other
/// primaries. Each conversion that changes colours or cuts pixels is one of the picture's notes.
Image asShown(Image stored, const ImageHeader& header) {
  Image image = namedParts(asTurned(std::move(stored), header));
  takeExposureBack(image, header.hdr.exposure);
  if (header.hdr.hasVainExposure)
    image.notes.emplace_back("has an EXPOSURE or COLORCORR that is no number above 0, and is ignored");
  if (header.format == ImageFormat::Hdr && !header.hdr.namesFormat)
    image.notes.emplace_back("has no FORMAT in its header, and is read as 32-bit_rle_rgbe");
  convertToRec709(image);
  if (header.overscan != glm::ivec2(0))
    image.notes.push_back(
        formatted("has %d x %d pixels, some of them outside of its display window of %d x %d, which are cut",
                  header.overscan.x, header.overscan.y, header.width, header.height));
  return image;
}

}  // namespace

// readImage, readDisplayImage, readLinearImage and decodeTexels: the format is chosen by the first bytes, the
// file's name only stands in messages.

namespace {

/// Runs a decoder, and says in its errors which picture it was.
template <typename Decode>
auto decodeNamed(const std::string& name, Decode decode) {
  try {
    return decode();
  } catch (const std::bad_alloc&) {
    throw InputError("cannot read the picture " + name + ": it does not fit into memory");
  } catch (const std::exception& error) {
    throw InputError("cannot read the picture " + name + ": " + error.what());
  }
}

Image decodeStored(std::span<const uint8_t> bytes, const std::filesystem::path& path, uint64_t memoryLimit) {
  return decodeNamed(path.string(), [&] {
    const ImageHeader header = readImageHeader(bytes);
    if (header.format == ImageFormat::Ktx2 || header.format == ImageFormat::Avif)
      throw std::runtime_error("a KTX2 or AVIF picture is read as a texture only");
    MemoryBudget(memoryLimit).take(bytes.size() + decodedValues(header) * sizeof(float));
    return asShown(header.format == ImageFormat::Pfm ? decodePfm(bytes) : decodeByProcess(bytes, header),
                   header);
  });
}

Image decodeImage(std::span<const uint8_t> bytes, const std::filesystem::path& path, uint64_t memoryLimit) {
  return wholeOf(decodeStored(bytes, path, memoryLimit));
}

bool isLinear(std::span<const uint8_t> bytes) {
  const auto format = formatOfBytes(bytes);
  return format == ImageFormat::OpenExr || format == ImageFormat::Hdr || format == ImageFormat::Pfm;
}

}  // namespace

Image wholeOf(Image part) {
  if (!part.placement) return part;
  const auto [corner, size] = *part.placement;
  Image whole{size.x,
              size.y,
              part.channels,
              {},
              std::move(part.attributes),
              std::nullopt,
              std::move(part.numbers),
              std::move(part.notes)};
  whole.values.resize(size_t(size.x) * size_t(size.y) * whole.channelCount());
  const size_t row = size_t(part.width) * part.channelCount();
  for (int y = 0; y < part.height; ++y)
    std::copy_n(part.pixel(0, y), row, whole.pixel(corner.x, corner.y + y));
  return whole;
}

Image readStoredImage(const std::filesystem::path& path, uint64_t memoryLimit) {
  return decodeStored(readWholeFile(path, memoryLimit), path, memoryLimit);
}

Image readImage(const std::filesystem::path& path, uint64_t memoryLimit) {
  return decodeImage(readWholeFile(path, memoryLimit), path, memoryLimit);
}

Image readDisplayImage(const std::filesystem::path& path, const OcioView& view) {
  const uint64_t memoryLimit = defaultMemoryLimit();
  const std::vector<uint8_t> bytes = readWholeFile(path, memoryLimit);
  Image image = decodeImage(bytes, path, memoryLimit);
  if (!isLinear(bytes)) return image;
  return view.isAsked() ? asRead(shownByView(exposedColors(image, 0), view), image) : toDefaultDisplay(image);
}

LinearImage readLinearImage(const std::filesystem::path& path, uint64_t memoryLimit) {
  const std::vector<uint8_t> bytes = readWholeFile(path, memoryLimit);
  LinearImage read{decodeStored(bytes, path, memoryLimit), !isLinear(bytes)};
  if (read.wasEncoded) {
    for (float& value : read.image.values) value = float(decodeSrgb(double(value)));
  }
  return read;
}

TexelImage decodeTexels(std::span<const uint8_t> bytes, const std::string& name) {
  return decodeNamed(name, [&] {
    const ImageHeader header = readImageHeader(bytes);
    if (header.format == ImageFormat::Pfm) throw std::runtime_error("a texture cannot be a .pfm picture");
    return decodeTexelsByProcess(bytes, header);
  });
}

// writeImage: encodes in memory, then replaces the file in one step.

namespace {

constexpr float kLargestHalf = 65504.0f;

/// Rounded to the nearest of the levels up to `highest`; what lies outside 0..1 is clamped, and NaN becomes
/// 0.
uint16_t quantize(float value, float highest) {
  if (!(value > 0)) return 0;  // NaN compares false
  return uint16_t(std::lround(std::min(value, 1.0f) * highest));
}

/// The indices of R, G, B and, if wanted and there, A.
std::vector<size_t> outputChannels(const Image& image, bool withAlpha) {
  const auto color = findColorChannels(image);
  if (!color) throw std::runtime_error("the picture has no colour channels");
  std::vector<size_t> channels(color->begin(), color->end());
  const auto alpha = findChannel(image, "A");
  if (withAlpha && alpha) channels.push_back(*alpha);
  return channels;
}

/// The values of these channels, little-endian; opaque alpha follows them if wanted.
std::vector<uint8_t> levelsOf(const Image& image, const std::vector<size_t>& channels, int bits,
                              bool addsAlpha) {
  const float highest = bits == 16 ? 65535.0f : 255.0f;
  const size_t count = image.values.size() / image.channelCount() * (channels.size() + (addsAlpha ? 1 : 0));
  std::vector<uint8_t> bytes;
  bytes.reserve(count * size_t(bits / 8));
  const auto add = [&](float value) {
    const uint16_t level = quantize(value, highest);
    bytes.push_back(uint8_t(level));
    if (bits == 16) bytes.push_back(uint8_t(level >> 8));
  };
  for (size_t first = 0; first < image.values.size(); first += image.channelCount()) {
    for (const size_t channel : channels) add(image.values[first + channel]);
    if (addsAlpha) add(1.0f);
  }
  return bytes;
}

std::vector<uint8_t> encodeBytes(const Image& image, ImageFormat format, int bits) {
  const std::vector<size_t> channels = outputChannels(image, format == ImageFormat::Png);
  return encodeBytesByProcess(image.width, image.height, int(channels.size()), bits,
                              levelsOf(image, channels, bits, false), format);
}

/// The nearest colour that three 8-bit mantissas with one exponent hold (Ward, "Real Pixels", Graphics Gems
/// II, 1991). The image library truncates, which would darken a picture by a third of a percent. No negative
/// value and no NaN can be held: both become 0.
void roundToRgbe(std::span<float, 3> color) {
  constexpr float kBrightest = 1e38f;
  for (float& value : color) value = value > 0 ? std::min(value, kBrightest) : 0.0f;
  int exponent = 0;
  const float peak = *std::ranges::max_element(color);
  if (std::frexp(peak, &exponent) * 256 >= 255.5f) ++exponent;
  for (float& value : color) value = std::ldexp(std::round(std::ldexp(value, 8 - exponent)), exponent - 8);
}

std::vector<uint8_t> encodeHdr(const Image& image) {
  Image color{image.width, image.height, {"R", "G", "B"}, {}, {}};
  color.values.reserve(size_t(image.width) * size_t(image.height) * 3);
  const std::vector<size_t> channels = outputChannels(image, false);
  for (size_t first = 0; first < image.values.size(); first += image.channelCount())
    for (const size_t channel : channels) color.values.push_back(image.values[first + channel]);
  for (size_t first = 0; first < color.values.size(); first += 3)
    roundToRgbe(std::span<float, 3>(color.values.data() + first, 3));
  return encodeFloatsByProcess(color, ImageFormat::Hdr);
}

/// Clamps values that 16-bit floats cannot hold, in the channels that are stored so, and counts them.
size_t clampToHalf(Image& image) {
  std::vector<size_t> halves;
  for (size_t c = 0; c < image.channelCount(); ++c) {
    if (isStoredAsHalf(image.channels[c])) halves.push_back(c);
  }
  size_t clamped = 0;
  for (size_t first = 0; first < image.values.size(); first += image.channelCount()) {
    for (const size_t c : halves) {
      float& value = image.values[first + c];
      if (!(std::abs(value) > kLargestHalf)) continue;  // NaN stays
      value = std::copysign(kLargestHalf, value);
      ++clamped;
    }
  }
  return clamped;
}

struct Encoded {
  std::vector<uint8_t> bytes;
  size_t clamped = 0;  ///< values
};

Encoded encodeExr(const Image& image, bool half) {
  if (!half) return {encodeFloatsByProcess(image, ImageFormat::OpenExr), 0};
  Image stored = image;
  const size_t clamped = clampToHalf(stored);
  return {encodeFloatsByProcess(stored, ImageFormat::OpenExr, true), clamped};
}

Encoded encode(const Image& image, const std::filesystem::path& path, const Encoding& encoding) {
  if (image.width <= 0 || image.height <= 0 || image.channels.empty() ||
      image.values.size() != size_t(image.width) * size_t(image.height) * image.channelCount())
    throw std::runtime_error("the picture is empty, or its values do not fill it");

  if (const auto form = pixelFormOf(path)) return {pixelsOf(image, *form), 0};
  const auto format = formatOfName(path);
  if (!format) throw std::runtime_error("the name must end in .png, .jpg, .exr, .hdr or .pfm");
  if (format == ImageFormat::Pfm) return {encodePfm(image), 0};
  if (format == ImageFormat::Hdr) return {encodeHdr(image), 0};
  if (format == ImageFormat::OpenExr) return encodeExr(image, encoding.half);
  return {encodeBytes(image, *format, format == ImageFormat::Png ? encoding.pngBits : 8), 0};
}

/// `place` is the file's name in messages, if it is not the path.
Encoded encodeNamed(const Image& image, const std::filesystem::path& path, const Encoding& encoding,
                    const std::filesystem::path& place = {}) {
  try {
    return encode(image, path, encoding);
  } catch (const std::exception& error) {
    throw RenderError("cannot write " + (place.empty() ? path : place).string() + ": " + error.what());
  }
}

/// The bytes of a pixel that cannot be compressed.
uint64_t bytesOfPixel(std::optional<ImageFormat> format, size_t channelCount, const Encoding& encoding) {
  if (format == ImageFormat::OpenExr) return (encoding.half ? 2 : 4) * channelCount;
  if (format == ImageFormat::Png && encoding.pngBits == 16) return 8;
  if (format == ImageFormat::Pfm) return 12;
  return 4;  // .png with alpha, .hdr; .jpg has 3
}

}  // namespace

std::vector<uint8_t> pixelsOf(const Image& image, const PixelForm& form) {
  const std::vector<size_t> channels = outputChannels(image, form.alpha);
  return levelsOf(image, channels, form.bits, form.alpha && channels.size() == 3);
}

size_t writeImage(const std::filesystem::path& path, const Image& image, const Encoding& encoding,
                  const std::filesystem::path& place) {
  const Encoded encoded = encodeNamed(image, path, encoding, place);
  replaceFile(place.empty() ? path : place, encoded.bytes);
  return encoded.clamped;
}

size_t printImage(const std::filesystem::path& path, const Image& image, const Encoding& encoding) {
  const Encoded encoded = encodeNamed(image, path, encoding);
  writeToStandardOutput(encoded.bytes);
  return encoded.clamped;
}

void checkImageWritable(const std::filesystem::path& path, int width, int height, size_t channelCount,
                        const Encoding& encoding, bool isFile, const std::filesystem::path& place) {
  constexpr int kMostJpegSide = 65500;  // libjpeg's JPEG_MAX_DIMENSION
  if (formatOfName(path) == ImageFormat::Jpeg && std::max(width, height) > kMostJpegSide)
    throw RenderError("cannot write " + path.string() + ": a .jpg has at most " +
                      std::to_string(kMostJpegSide) + " pixels a side");
  encodeNamed({1, 1, {"R", "G", "B"}, {0.0f, 0.0f, 0.0f}, {}}, path, encoding, place);
  const uint64_t pixels = uint64_t(width) * uint64_t(height);
  if (isFile)
    checkRoom(place.empty() ? path : place,
              pixels * bytesOfPixel(formatOfName(path), channelCount, encoding));
}

}  // namespace fragtrace
