// SPDX-License-Identifier: MIT
#include "image/files/header.h"

#include <cmath>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "base/text.h"
#include "image/files/pfm.h"
#include "image/image.h"

namespace fragtrace {

namespace {

using Bytes = std::span<const uint8_t>;

[[noreturn]] void refuseTruncated() { throw std::runtime_error("the file is truncated"); }

uint32_t littleEndian(Bytes bytes, size_t at, size_t count) {
  if (bytes.size() < count || at > bytes.size() - count) refuseTruncated();
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) value |= uint32_t(bytes[at + i]) << (8 * i);
  return value;
}

ImageHeader checked(ImageFormat format, int64_t width, int64_t height, int channelCount, int texelBits = 8) {
  checkImageSize(width, height, channelCount);
  return {format, int(width), int(height), channelCount, {}, {}, texelBits};
}

ImageHeader pngHeader(Bytes bytes) {
  // PNG specification, 11.2.2: IHDR is the first chunk, 8 bytes behind the signature.
  constexpr size_t kWidthAt = 16, kBitsAt = 24, kEnd = 25;
  if (bytes.size() < kEnd || !isCompletePng(bytes)) refuseTruncated();
  if (std::string_view(reinterpret_cast<const char*>(bytes.data()) + 12, 4) != "IHDR")
    throw std::runtime_error("the PNG header is wrong");
  const auto bigEndian = [&](size_t at) {
    return int64_t(bytes[at]) << 24 | bytes[at + 1] << 16 | bytes[at + 2] << 8 | bytes[at + 3];
  };
  return checked(ImageFormat::Png, bigEndian(kWidthAt), bigEndian(kWidthAt + 4), kMostTextureChannels,
                 bytes[kBitsAt] == 16 ? 16 : 8);
}

ImageHeader jpegHeader(Bytes bytes) {
  const JpegFrame frame = readJpegFrame(bytes);
  if (!frame.complete) refuseTruncated();
  if (frame.height == 0 || frame.width == 0) throw std::runtime_error("the JPEG header has no size");
  // Each scan goes over all blocks, however few bytes it has: thousands of empty ones would take minutes.
  constexpr int64_t kMostWork = int64_t(1) << 32;
  const int64_t pixels = int64_t(frame.width) * frame.height;
  if (frame.scans > 1 && pixels > kMostWork / frame.scans) {
    throw std::runtime_error(std::to_string(frame.scans) + " scans over " + std::to_string(frame.width) +
                             " x " + std::to_string(frame.height) + " pixels are not supported");
  }
  return checked(ImageFormat::Jpeg, frame.width, frame.height, kMostTextureChannels);
}

ImageHeader webpHeader(Bytes bytes) {
  // RFC 9649, 2.5 to 2.7: the first chunk tells the size, in three ways.
  constexpr size_t kChunk = 12, kData = 20;
  if (bytes.size() < kData) refuseTruncated();
  const std::string_view kind(reinterpret_cast<const char*>(bytes.data()) + kChunk, 4);
  int64_t width = 0;
  int64_t height = 0;
  if (kind == "VP8 ") {
    width = littleEndian(bytes, kData + 6, 2) & 0x3fff;
    height = littleEndian(bytes, kData + 8, 2) & 0x3fff;
  } else if (kind == "VP8L") {
    const uint32_t bits = littleEndian(bytes, kData + 1, 4);
    width = (bits & 0x3fff) + 1;
    height = (bits >> 14 & 0x3fff) + 1;
  } else if (kind == "VP8X") {
    width = int64_t(littleEndian(bytes, kData + 4, 3)) + 1;
    height = int64_t(littleEndian(bytes, kData + 7, 3)) + 1;
  } else {
    throw std::runtime_error("the WebP header is wrong");
  }
  return checked(ImageFormat::WebP, width, height, kMostTextureChannels);
}

/// A box of ISO/IEC 14496-12: its type and its content.
struct IsoBox {
  std::string_view type;
  Bytes content;
};

/// Takes the next box off the bytes; none where they hold no whole one.
std::optional<IsoBox> takeIsoBox(Bytes& bytes) {
  constexpr size_t kHeader = 8;
  if (bytes.size() < kHeader) return std::nullopt;
  const size_t size = size_t(bytes[0]) << 24 | size_t(bytes[1]) << 16 | size_t(bytes[2]) << 8 | bytes[3];
  const size_t whole = size == 0 ? bytes.size() : size;  // 0: up to the end
  if (whole < kHeader || whole > bytes.size()) return std::nullopt;
  const IsoBox box{{reinterpret_cast<const char*>(bytes.data()) + 4, 4},
                   bytes.subspan(kHeader, whole - kHeader)};
  bytes = bytes.subspan(whole);
  return box;
}

/// The content of the first box with that path; empty: there is none. A box `meta` has 4 bytes before its
/// boxes.
Bytes isoBoxAt(Bytes bytes, std::initializer_list<std::string_view> path) {
  for (const std::string_view type : path) {
    std::optional<IsoBox> box = takeIsoBox(bytes);
    while (box && box->type != type) box = takeIsoBox(bytes);
    if (!box) return {};
    bytes = box->content.subspan(type == "meta" ? std::min<size_t>(4, box->content.size()) : 0);
  }
  return bytes;
}

/// Takes the largest extent among the properties of the file's items, which is that of the picture: others
/// are of its alpha, of its tiles or of a thumbnail.
ImageHeader avifHeader(Bytes bytes) {
  Bytes properties = isoBoxAt(bytes, {"meta", "iprp", "ipco"});
  int64_t width = 0, height = 0;
  bool isTurned = false;
  while (const std::optional<IsoBox> box = takeIsoBox(properties)) {
    constexpr size_t kExtent = 12;  // version and flags, width, height
    if (box->type == "irot" && !box->content.empty()) isTurned = box->content[0] % 2 != 0;
    if (box->type != "ispe" || box->content.size() < kExtent) continue;
    const auto number = [&](size_t at) {
      const Bytes& b = box->content;
      return int64_t(b[at]) << 24 | b[at + 1] << 16 | b[at + 2] << 8 | b[at + 3];
    };
    if (number(4) * number(8) <= width * height) continue;
    width = number(4);
    height = number(8);
  }
  if (width == 0) refuseTruncated();
  return isTurned ? checked(ImageFormat::Avif, height, width, kMostTextureChannels)
                  : checked(ImageFormat::Avif, width, height, kMostTextureChannels);
}

std::string_view cutWord(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  const std::string_view word = text.substr(0, text.find(' '));
  text.remove_prefix(word.size());
  return word;
}

/// Multiplies the form's exposures by those of a line such as "EXPOSURE=2.5" or "COLORCORR= 1 1 0.9".
void addExposure(HdrForm& form, std::string_view line) {
  const bool isOne = line.starts_with("EXPOSURE=");
  if (!isOne && !line.starts_with("COLORCORR=")) return;
  std::string_view values = line.substr(line.find('=') + 1);
  double factor = 0.0;
  for (size_t c = 0; c < 3; ++c) {
    if (c == 0 || !isOne) factor = numberOfAll<double>(cutWord(values)).value_or(0.0);
    if (factor > 0.0 && std::isfinite(factor))
      form.exposure[c] *= factor;
    else
      form.hasVainExposure = true;
  }
}

/// Takes the next line off the bytes, without white space at its end.
std::string_view takeLine(std::string_view& text) {
  const size_t end = text.find('\n');
  if (end == text.npos) refuseTruncated();
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line.substr(0, line.find_last_not_of(" \t\r") + 1);
}

/// Reads the lines of text up to the empty one.
HdrForm readHdrLines(std::string_view& text) {
  HdrForm form;
  for (std::string_view line = takeLine(text); !line.empty(); line = takeLine(text)) {
    addExposure(form, line);
    if (!line.starts_with("FORMAT=")) continue;
    std::string_view format = line.substr(line.find('=') + 1);
    if (cutWord(format) != "32-bit_rle_rgbe")
      throw std::runtime_error("its FORMAT is not 32-bit_rle_rgbe, the only one that is read");
    form.namesFormat = true;
  }
  return form;
}

/// Takes an axis of the resolution, such as "-Y 512". Returns its size; `name` becomes "-Y".
int takeAxis(std::string_view& resolution, std::string_view& name) {
  name = cutWord(resolution);
  const auto size = numberOfAll<int>(cutWord(resolution));
  if (!size || name.size() != 2 || (name[0] != '-' && name[0] != '+') || (name[1] != 'X' && name[1] != 'Y'))
    throw std::runtime_error("the HDR header has no resolution such as -Y 512 +X 1024");
  return *size;
}

ImageHeader hdrHeader(Bytes bytes) {
  // By Ward, "Real Pixels", a file has lines of text up to an empty one, the resolution, and the scan lines.
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  HdrForm form = readHdrLines(text);
  form.resolution = takeLine(text);
  std::string_view resolution = form.resolution, lines, along;
  const int lineCount = takeAxis(resolution, lines);
  const int lineLength = takeAxis(resolution, along);
  if (lines[1] == along[1]) throw std::runtime_error("the HDR header has no resolution of two axes");
  form.columns = lines[1] == 'X';
  form.fromRight = lines == "-X" || along == "-X";
  form.fromBottom = lines == "+Y" || along == "+Y";
  form.pixelsAt = bytes.size() - text.size();
  // A run says at most how often a pixel of four bytes is repeated, so that each line has one.
  constexpr int64_t kLeastOfALine = 4;
  ImageHeader header = form.columns ? checked(ImageFormat::Hdr, lineCount, lineLength, 3, 16)
                                    : checked(ImageFormat::Hdr, lineLength, lineCount, 3, 16);
  header.hdr = form;
  if (int64_t(text.size()) < lineCount * kLeastOfALine) refuseTruncated();
  return header;
}

[[noreturn]] void refuse() { throw std::runtime_error("the OpenEXR header is wrong or truncated"); }

Bytes take(Bytes& bytes, size_t count) {
  if (count > bytes.size()) refuse();
  const Bytes taken = bytes.first(count);
  bytes = bytes.subspan(count);
  return taken;
}

int32_t takeInt(Bytes& bytes) {
  const Bytes b = take(bytes, 4);
  return int32_t(uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24);
}

/// Text up to a zero byte, which is taken too.
std::string_view takeName(Bytes& bytes) {
  constexpr size_t kLongestName = 255;
  const auto* begin = reinterpret_cast<const char*>(bytes.data());
  const void* end = bytes.empty() ? nullptr : std::memchr(begin, 0, std::min(bytes.size(), kLongestName + 1));
  if (end == nullptr) refuse();
  const std::string_view name(begin, size_t(static_cast<const char*>(end) - begin));
  take(bytes, name.size() + 1);
  return name;
}

struct Window {
  int64_t left, top, right, bottom;
  int64_t width() const { return right - left + 1; }
  int64_t height() const { return bottom - top + 1; }
  bool operator==(const Window&) const = default;
};

Window windowOf(Bytes value) {
  const int64_t left = takeInt(value), top = takeInt(value), right = takeInt(value), bottom = takeInt(value);
  const Window window{left, top, right, bottom};
  checkImageSize(window.width(), window.height(), 1);
  return window;
}

/// Name, type, linearity and three bytes, sampling in x and y; then a zero byte.
int channelsOf(Bytes value) {
  constexpr int kMostChannels = 1024;
  constexpr int kSamplingsAt = 8;
  int count = 0;
  while (!takeName(value).empty()) {
    take(value, kSamplingsAt);
    const int32_t samplingX = takeInt(value);
    const int32_t samplingY = takeInt(value);
    if (samplingX < 1 || samplingY < 1 || ++count > kMostChannels) refuse();
  }
  if (count == 0) refuse();
  return count;
}

/// Scan lines per block, by compression (OpenEXR, "File Layout").
int64_t linesOf(uint8_t compression) {
  constexpr int64_t kLines[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  if (compression >= std::size(kLines)) throw std::runtime_error("its OpenEXR compression is not known");
  return kLines[compression];
}

struct Tiles {
  int64_t width, height;
};

Tiles tilesOf(Bytes value) {
  const auto width = uint32_t(takeInt(value));
  const auto height = uint32_t(takeInt(value));
  if (width == 0 || height == 0) refuse();
  return {width, height};
}

struct Attributes {
  std::optional<Window> data, display;
  std::optional<Tiles> tiles;
  int channelCount = 0;
  std::optional<uint8_t> compression;
};

Attributes takeAttributes(Bytes& bytes) {
  Attributes result;
  for (std::string_view name = takeName(bytes); !name.empty(); name = takeName(bytes)) {
    takeName(bytes);  // the type
    const int32_t size = takeInt(bytes);
    if (size < 0) refuse();
    Bytes value = take(bytes, size_t(size));
    if (name == "dataWindow") result.data = windowOf(value);
    if (name == "displayWindow") result.display = windowOf(value);
    if (name == "tiles") result.tiles = tilesOf(value);
    if (name == "channels") result.channelCount = channelsOf(value);
    if (name == "compression") result.compression = take(value, 1)[0];
  }
  return result;
}

/// Returns the number of blocks of a part; `isTiled`: the file says that its only part has tiles.
int64_t blockCountOf(const Attributes& part, bool isTiled, bool isMultiPart) {
  const auto blocks = [](int64_t size, int64_t block) { return (size + block - 1) / block; };
  if (isTiled && !part.tiles) refuse();
  return isTiled || (isMultiPart && part.tiles)
             ? blocks(part.data->width(), part.tiles->width) * blocks(part.data->height(), part.tiles->height)
             : blocks(part.data->height(), linesOf(*part.compression));
}

void extend(Window& window, const Window& other) {
  window = {std::min(window.left, other.left), std::min(window.top, other.top),
            std::max(window.right, other.right), std::max(window.bottom, other.bottom)};
}

/// readImageHeader() of an OpenEXR file, whose libraries in the distribution believe its header before they
/// read on: those of all parts. Refuses a file without an attribute that is needed or with a wrong one, one
/// whose data windows are outside of the display window, one that is shorter than its tables of blocks, and
/// deep pictures.
ImageHeader readExrHeader(Bytes bytes) {
  constexpr uint32_t kTiled = 0x200, kDeep = 0x800, kMultiPart = 0x1000;
  take(bytes, 4);  // the signature
  const auto version = uint32_t(takeInt(bytes));
  if ((version & 0xff) != 2) throw std::runtime_error("its OpenEXR version is not supported");
  if ((version & kDeep) != 0) throw std::runtime_error("deep OpenEXR pictures are not supported");
  const bool isMultiPart = (version & kMultiPart) != 0;
  std::optional<Window> data, display;
  int64_t blocks = 0;
  int channelCount = 0;
  do {
    const Attributes part = takeAttributes(bytes);
    if (!part.data || !part.display || !part.compression || part.channelCount == 0) refuse();
    if (display && !(*part.display == *display)) throw std::runtime_error("its parts differ in their sizes");
    display = part.display;
    extend(data ? *data : data.emplace(*part.data), *part.data);
    blocks += blockCountOf(part, (version & kTiled) != 0, isMultiPart);
    channelCount += part.channelCount;
    checkImageSize(data->width(), data->height(), channelCount);
  } while (isMultiPart && !bytes.empty() && bytes[0] != 0);

  // Each block has an entry of 8 bytes in a table, and is itself at least a header of 8.
  constexpr int64_t kLeastOfABlock = 16;
  if (blocks > int64_t(bytes.size()) / kLeastOfABlock) throw std::runtime_error("the file is truncated");
  if (data->left > display->right || data->right < display->left || data->top > display->bottom ||
      data->bottom < display->top)
    throw std::runtime_error("its data window is outside of its display window");
  checkImageSize(display->width(), display->height(), channelCount);
  ImageHeader header{ImageFormat::OpenExr, int(display->width()), int(display->height()), channelCount};
  if (data->left < display->left || data->top < display->top || data->right > display->right ||
      data->bottom > display->bottom)
    header.overscan = {int(data->width()), int(data->height())};
  return header;
}

/// KTX 2.0 specification, 3.1, and the first entry of the level index (3.9.7). All numbers are little-endian.
struct Fields {
  std::array<uint8_t, 12> identifier;
  uint32_t format, typeSize, width, height, depth, layers, faces, levels, scheme;
  uint32_t formatOffset, formatLength, metadataOffset, metadataLength;
  uint64_t globalOffset, globalLength;
  uint64_t levelOffset, levelLength, levelUncompressed;
};
static_assert(sizeof(Fields) == 104);

// Schemes of supercompression, and colour models of the Khronos data format.
constexpr uint32_t kNone = 0, kBasisLz = 1, kZstandard = 2;
constexpr uint32_t kEtc1s = 163, kUastc = 166;

[[noreturn]] void refuse(const std::string& reason) { throw std::runtime_error(reason); }

Bytes sliceOf(Bytes bytes, uint64_t offset, uint64_t length) {
  if (offset > bytes.size() || length > bytes.size() - offset) refuse("the file is truncated");
  return bytes.subspan(offset, length);
}

template <typename Value>
Value valueAt(Bytes bytes, uint64_t offset) {
  Value value;
  std::memcpy(&value, sliceOf(bytes, offset, sizeof value).data(), sizeof value);
  return value;
}

void checkShape(const Fields& header) {
  constexpr uint32_t kLargestSide = 16384;  // the decoder's limit
  if (header.faces != 1) refuse("it is a cube map, and textures of glTF have two dimensions");
  if (header.layers != 0)
    refuse("it is an array or a film of " + std::to_string(header.layers) + " layers, and no picture");
  if (header.depth != 0 || header.height == 0 || header.width == 0)
    refuse("it has " + std::string(header.depth != 0 ? "three dimensions" : "one dimension") + ", not two");
  if (std::max(header.width, header.height) > kLargestSide)
    refuse("a size of " + std::to_string(header.width) + " x " + std::to_string(header.height) +
           " pixels is not supported");
}

/// Level 0 of UASTC has a block of 16 bytes for each 4 x 4 texels.
void checkSizes(const Fields& header, uint32_t model) {
  const uint64_t blocks = uint64_t(header.width + 3) / 4 * ((header.height + 3) / 4);
  const uint64_t bytes = header.levelUncompressed;
  if (model == kUastc && (bytes != 16 * blocks || (header.scheme == kNone && bytes != header.levelLength)))
    refuse("its level 0 has " + std::to_string(bytes) + " bytes for " + std::to_string(blocks) + " blocks");
  constexpr uint64_t kGlobalHeader = 20;
  if (model == kEtc1s && header.globalLength < kGlobalHeader) refuse("it has no codebooks");
}

/// The data format descriptor (Khronos data format specification, 5).
void checkFormat(const Fields& header, Bytes format) {
  constexpr uint64_t kModelAt = 12, kFlagsAt = 15, kFirstSampleEnd = 44;
  constexpr uint8_t kMultipliedByAlpha = 1;
  if (format.size() < kFirstSampleEnd) refuse("the KTX2 header is wrong");
  const uint32_t model = format[kModelAt];
  const bool isRead =
      header.format == 0 && ((model == kEtc1s && header.scheme == kBasisLz) ||
                             (model == kUastc && (header.scheme == kNone || header.scheme == kZstandard)));
  if (!isRead)
    refuse("it is neither ETC1S nor UASTC, which textures of glTF have (vkFormat " +
           std::to_string(header.format) + ", colour model " + std::to_string(model) + ", supercompression " +
           std::to_string(header.scheme) + ")");
  if ((format[kFlagsAt] & kMultipliedByAlpha) != 0)
    refuse("its colours are multiplied by alpha, which textures of glTF must not be");
  checkSizes(header, model);
}

/// Key and value, with a zero behind each text, and zeros up to a multiple of four.
void checkMetadata(Bytes metadata) {
  uint64_t at = 0;
  while (at < metadata.size()) {
    const Bytes entry = sliceOf(metadata, at + 4, valueAt<uint32_t>(metadata, at));
    const std::string_view text(reinterpret_cast<const char*>(entry.data()), entry.size());
    const std::string_view key = text.substr(0, text.find('\0'));
    std::string_view value = text.substr(std::min(key.size() + 1, text.size()));
    value = value.substr(0, value.find('\0'));
    const bool isMirrored = key == "KTXorientation" && value != "rd";
    const bool isSwizzled = key == "KTXswizzle" && value != "rgba";
    if (isMirrored || isSwizzled)
      refuse("its " + std::string(key) + " is not " + (isMirrored ? "rd" : "rgba") +
             ", as it must be in glTF");
    at += (4 + entry.size() + 3) / 4 * 4;
  }
}

/// readImageHeader() of a KTX2 file, of which it reads header, format and metadata: what KHR_texture_basisu
/// allows. Refuses a truncated file, one that is no picture of two dimensions, one that is neither ETC1S nor
/// UASTC, one that is turned or swizzled, and colours that are multiplied by alpha.
ImageHeader readKtx2Header(Bytes bytes) {
  const auto header = valueAt<Fields>(bytes, 0);
  checkShape(header);
  checkFormat(header, sliceOf(bytes, header.formatOffset, header.formatLength));
  checkMetadata(sliceOf(bytes, header.metadataOffset, header.metadataLength));
  sliceOf(bytes, header.globalOffset, header.globalLength);
  if (sliceOf(bytes, header.levelOffset, header.levelLength).empty()) refuse("its level 0 is empty");
  return {ImageFormat::Ktx2, int(header.width), int(header.height), kMostTextureChannels, {}, {}, 8};
}

}  // namespace

bool isCompletePng(Bytes bytes) {
  // PNG specification, chapter 5: a signature, then chunks of length, type, data and checksum.
  constexpr size_t kSignatureSize = 8, kTypeAt = 4, kTypeSize = 4, kOverhead = 12;
  bytes = bytes.subspan(std::min(kSignatureSize, bytes.size()));
  while (bytes.size() >= kOverhead) {
    const size_t length = size_t(bytes[0]) << 24 | size_t(bytes[1]) << 16 | size_t(bytes[2]) << 8 | bytes[3];
    if (length > bytes.size() - kOverhead) return false;
    if (std::string_view(reinterpret_cast<const char*>(bytes.data()) + kTypeAt, kTypeSize) == "IEND")
      return true;
    bytes = bytes.subspan(length + kOverhead);
  }
  return false;
}

JpegFrame readJpegFrame(Bytes bytes) {
  // Markers of ITU-T T.81, table B.1.
  constexpr uint8_t kStuffedZero = 0x00, kTemporary = 0x01, kFirstFrame = 0xc0, kHuffmanTable = 0xc4,
                    kExtension = 0xc8, kArithmeticTable = 0xcc, kLastFrame = 0xcf, kFirstRestart = 0xd0,
                    kStartOfImage = 0xd8, kEndOfImage = 0xd9, kStartOfScan = 0xda, kFill = 0xff;
  JpegFrame frame;
  size_t at = 0;
  while (at + 1 < bytes.size()) {
    // Between segments, and in a scan's entropy-coded data, everything but 0xff and a marker is skipped.
    const uint8_t marker = bytes[at + 1];
    if (bytes[at] != 0xff || marker == kFill) {
      ++at;
      continue;
    }
    at += 2;
    if (marker == kEndOfImage) {
      frame.complete = frame.scans > 0;
      return frame;
    }
    if (marker == kStuffedZero || marker == kTemporary ||
        (marker >= kFirstRestart && marker <= kStartOfImage))
      continue;

    if (marker == kStartOfScan) ++frame.scans;
    if (at + 1 >= bytes.size()) return frame;
    const bool isFrame = marker >= kFirstFrame && marker <= kLastFrame && marker != kHuffmanTable &&
                         marker != kExtension && marker != kArithmeticTable;
    // B.2.2: length, precision, lines, samples per line.
    constexpr size_t kFrameSize = 7;
    if (isFrame && bytes.size() - at >= kFrameSize) {
      frame.height = bytes[at + 3] << 8 | bytes[at + 4];
      frame.width = bytes[at + 5] << 8 | bytes[at + 6];
    }
    at += size_t(bytes[at]) << 8 | bytes[at + 1];
  }
  return frame;
}

ImageHeader readImageHeader(Bytes bytes) {
  if (bytes.empty()) throw std::runtime_error("it is empty");
  const auto format = formatOfBytes(bytes);
  if (!format)
    throw std::runtime_error("it is no PNG, JPEG, WebP, AVIF, KTX2, OpenEXR, Radiance HDR or PFM picture");
  switch (*format) {
    case ImageFormat::Png:
      return pngHeader(bytes);
    case ImageFormat::Jpeg:
      return jpegHeader(bytes);
    case ImageFormat::WebP:
      return webpHeader(bytes);
    case ImageFormat::Hdr:
      return hdrHeader(bytes);
    case ImageFormat::Avif:
      return avifHeader(bytes);
    case ImageFormat::OpenExr:
      return readExrHeader(bytes);
    case ImageFormat::Ktx2:
      return readKtx2Header(bytes);
    case ImageFormat::Pfm: {
      const PfmHeader pfm = readPfmHeader(bytes);
      return {ImageFormat::Pfm, pfm.width, pfm.height, pfm.channelCount};
    }
  }
  refuseTruncated();
}

}  // namespace fragtrace
