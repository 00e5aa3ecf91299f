// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>
#include <glm/vec3.hpp>

#include "image/format.h"

namespace fragtrace {

/// A rectangle of a picture, in pixels; its corner is the top left one, from the picture's top left.
struct Region {
  glm::ivec2 corner{0};
  glm::ivec2 size{0};

  bool operator==(const Region&) const = default;
};

/// The place of a picture in a larger one.
struct Placement {
  glm::ivec2 corner{0};  ///< its top left pixel, counted from the larger one's top left
  glm::ivec2 whole{0};   ///< size of the larger one

  bool operator==(const Placement&) const = default;
};

// Limits on what a file may ask for, checked before memory is given to it.

inline constexpr int64_t kMaximumPixels = int64_t(1) << 28;
inline constexpr int64_t kMaximumValues = int64_t(1) << 30;

/// Throws std::runtime_error unless the size is positive and within the limits.
inline void checkImageSize(int64_t width, int64_t height, int64_t channelCount) {
  if (width > 0 && height > 0 && channelCount > 0 && width <= kMaximumPixels / height &&
      channelCount <= kMaximumValues / (width * height))
    return;
  throw std::runtime_error("a size of " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels of " + std::to_string(channelCount) + " channels is not supported");
}

/// Bytes that files may ask for unless the user says otherwise: the least of 8 GiB, half of the machine's
/// memory, and what the process may address (RLIMIT_AS).
uint64_t defaultMemoryLimit();

inline constexpr uint64_t kLeastMemoryBytes = 1'000'000;  // the least that --memory-limit takes
inline constexpr int kLargestTextureSide = 65535;         // the shader's slots hold no more

/// The limits that the user sets for input files.
struct InputLimits {
  uint64_t memoryBytes = defaultMemoryLimit();
  int textureSide = kLargestTextureSide;         ///< wider or higher textures are scaled down to this
  bool allowExternalFiles = false;               ///< URIs may lead out of the scene's folder
  bool drawMissingTextures = true;               ///< a picture that cannot be read is warned of, and marked
  bool strict = false;                           ///< what is only warned of is refused
  std::vector<std::string> ignoredExtensions{};  ///< drawn without, although the scene requires them

  bool operator==(const InputLimits&) const = default;
};

/// Counts what is about to be allocated for one file.
class MemoryBudget {
 public:
  explicit MemoryBudget(uint64_t limit = defaultMemoryLimit()) : limit_(limit) {}

  /// Throws std::runtime_error when all that was taken, with these bytes, is more than the limit.
  void take(uint64_t bytes);

  uint64_t left() const { return limit_ - taken_; }

 private:
  uint64_t limit_;
  uint64_t taken_ = 0;
};

// Pictures as named float channels, and reading and writing them. Colour is linear Rec.709 unless a name says
// otherwise.

/// A standard attribute of OpenEXR that is made of numbers, and how many they are. Matrices are rows of four.
struct NumberAttribute {
  const char* name;
  size_t count;
};
inline constexpr std::array<NumberAttribute, 4> kNumberAttributes{
    {{"worldToCamera", 16}, {"worldToNDC", 16}, {"chromaticities", 8}, {"screenWindowWidth", 1}}};

/// Interleaved float channels; the first row is the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;              ///< "R", "G", "B", "A", "albedo.R", ...
  std::vector<float> values;                      ///< width * height * channels.size()
  std::map<std::string, std::string> attributes;  ///< kept in EXR files only
  std::optional<Placement> placement =
      std::nullopt;  ///< the same: data window in display window; none: a whole
  /// The same: attributes of OpenEXR's own that are numbers, by kNumberAttributes.
  std::map<std::string, std::vector<float>> numbers = {};
  std::vector<std::string> notes = {};  ///< how reading changed the stored values, for messages

  size_t channelCount() const { return channels.size(); }
  float* pixel(int x, int y) { return values.data() + (size_t(y) * width + x) * channels.size(); }
  const float* pixel(int x, int y) const { return values.data() + (size_t(y) * width + x) * channels.size(); }
};

/// RGBA, unassociated alpha, not yet decoded from its transfer curve; the first row is the top. A channel has
/// 8 bits, or 16 where the file has more than 8.
struct TexelImage {
  int width = 0;
  int height = 0;
  /// Holds width * height * 4 values. Missing channels: grey to RGB, alpha 1.
  std::variant<std::span<const uint8_t>, std::span<const uint16_t>> rgba;
  std::shared_ptr<const void> memory;  ///< keeps the values alive
};

struct OcioView;  // image/display/tone_map.h

/// Reads a picture file (.pfm by our own code, the rest through the image library). .exr, .hdr and .pfm give
/// linear floats of Rec. 709 as their headers say (image/files/picture_files.cpp); 8 and 16 bit files are
/// scaled to 0..1 and left sRGB-encoded, alpha unassociated there. Throws InputError, also when it would take
/// more than `memoryLimit` bytes.
Image readImage(const std::filesystem::path& path, uint64_t memoryLimit = defaultMemoryLimit());

/// The larger picture that a part lies in, where it does: the rest is 0. readImage() gives this.
Image wholeOf(Image part);

/// Reads as readImage() does, but of an .exr that holds only a part of a picture (its data windows) that part
/// alone, with its placement.
Image readStoredImage(const std::filesystem::path& path, uint64_t memoryLimit = defaultMemoryLimit());

/// Does the same as shown on a display: .exr, .hdr and .pfm (by their first bytes) through toDefaultDisplay,
/// the rest as stored. A `view` with a name takes the place of the curve. Throws InputError, or RenderError
/// where there is no colour to show.
Image readDisplayImage(const std::filesystem::path& path, const OcioView& view);

/// All channels as linear values, as stored (readStoredImage); an 8 or 16 bit file's are decoded from sRGB,
/// so they are at most 1.
struct LinearImage {
  Image image;
  bool wasEncoded = false;
};

/// Throws as readImage does.
LinearImage readLinearImage(const std::filesystem::path& path, uint64_t memoryLimit);

/// Decodes an encoded picture held in memory (glTF textures). Throws InputError naming `name`.
TexelImage decodeTexels(std::span<const uint8_t> bytes, const std::string& name);

/// True when the extension names a format that is written: .png .jpg .jpeg .exr .hdr .pfm (any case).
bool isWritableImageName(const std::filesystem::path& path);

/// True for .png and .jpg/.jpeg: formats that hold tone-mapped, sRGB-encoded values.
bool isDisplayFormat(const std::filesystem::path& path);

/// Writes next to the target and renames, so that the target is the old file or the new one, whole. The
/// picture's values are written as they are (rounded to 8 bits for .png and .jpg, to 16 where asked);
/// channels R, G, B and optionally A, and more for .exr (32-bit float, or 16-bit where asked). Colour is
/// taken as unassociated for .png. Returns how many values were beyond the largest 16-bit float and became
/// that. `path` only tells the format where there is another `place` for the file. Throws RenderError naming
/// the path and the reason.
size_t writeImage(const std::filesystem::path& path, const Image& image, const Encoding& encoding = {},
                  const std::filesystem::path& place = {});

/// Does the same on standard output; the path tells the format, and is what messages call it.
size_t printImage(const std::filesystem::path& path, const Image& image, const Encoding& encoding = {});

/// Must be called before long work. Throws the error that writeImage() would throw if the format's library
/// does not answer, or if there is no room for a picture of that size with `channelCount` incompressible
/// channels.
void checkImageWritable(const std::filesystem::path& path, int width, int height, size_t channelCount,
                        const Encoding& encoding = {}, bool isFile = true,
                        const std::filesystem::path& place = {});

// Pictures whose shadow is in alpha alone: a shadow catcher without a background. Noise and filters look at
// them as laid over white: linear R, G and B, each + 1 - A.

/// An attribute that such a picture has: its variances are of that luminance.
inline constexpr const char* kOverWhiteAttribute = "fragtrace:over-white";

/// An attribute of a picture whose alpha is drawn by chance within surfaces: they blend, or are shadows.
inline constexpr const char* kNoisyAlphaAttribute = "fragtrace:noisy-alpha";

/// Returns true if the picture has such an alpha.
bool hasNoisyAlpha(const Image& picture);

/// Returns true if the picture is one, and has its alpha.
bool isOverWhite(const Image& picture);

/// The picture with R, G and B as laid over white.
Image laidOverWhite(const Image& picture);

/// R, G, B and A of a picture whose colours, laid over white, are those of `seen`. Where the picture is
/// black, alpha takes the difference; elsewhere the colour does. Where surfaces fill a pixel in part, its
/// colour over alpha stays among those around it in `noisy`, the picture as drawn: alpha and colour are
/// filtered apart, and their difference would be dots on outlines.
Image liftedFromWhite(const Image& picture, const Image& seen, const Image& noisy);

/// Does the same for a picture that is laid over a page of one colour already: returns R, G and B of `seen`,
/// and A. Where the picture shows the page and a shadow on it alone, A is that of `seen`.
Image seenOverPage(const Image& picture, const Image& seen, const glm::vec3& page);

/// The picture with another alpha, that of the first channel of `alpha`, in 0..1. Where surfaces fill a
/// pixel, as its guides say, all its samples have met them and the other alpha is nearly 1,
/// alpha stays 1.
Image withAlpha(Image picture, const Image& alpha);

}  // namespace fragtrace
