// SPDX-License-Identifier: MIT
// Pictures as named float channels, and reading and writing them. Colour is linear Rec.709 unless a name says
// otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "image/format.h"
#include "image/limits.h"
#include "image/region.h"

namespace fragtrace {

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

/// Reads a picture file (.pfm by our own code, the rest through the image library). .exr, .hdr and .pfm give
/// linear floats of Rec. 709 as their headers say (image/files/as_shown.h); 8 and 16 bit files are scaled to
/// 0..1 and left sRGB-encoded, alpha unassociated there. Throws InputError, also when it would take more than
/// `memoryLimit` bytes.
Image readImage(const std::filesystem::path& path, uint64_t memoryLimit = defaultMemoryLimit());

/// The larger picture that a part lies in, where it does: the rest is 0. readImage() gives this.
Image wholeOf(Image part);

/// Reads as readImage() does, but of an .exr that holds only a part of a picture (its data windows) that part
/// alone, with its placement.
Image readStoredImage(const std::filesystem::path& path, uint64_t memoryLimit = defaultMemoryLimit());

/// Does the same as shown on a display: .exr, .hdr and .pfm (by their first bytes) through toDefaultDisplay,
/// the rest as stored. Throws InputError, or RenderError where there is no colour to tone-map.
Image readDisplayImage(const std::filesystem::path& path);

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

/// Writes beside the target and renames, so that the target is the old file or the new one, whole. The
/// picture's values are written as they are (rounded to 8 bits for .png and .jpg, to 16 where asked);
/// channels R, G, B and optionally A, and more for .exr (32-bit float, or 16-bit where asked). Colour is
/// taken as unassociated for .png. Returns how many values were beyond the largest 16-bit float and became
/// that. Throws RenderError naming the path and the reason.
size_t writeImage(const std::filesystem::path& path, const Image& image, const Encoding& encoding = {});

/// Does the same on standard output; the path tells the format, and is what messages call it.
size_t printImage(const std::filesystem::path& path, const Image& image, const Encoding& encoding = {});

/// Must be called before long work. Throws the error that writeImage() would throw if the format's library
/// does not answer, or if there is no room for a picture of that size with `channelCount` incompressible
/// channels.
void checkImageWritable(const std::filesystem::path& path, int width, int height, size_t channelCount,
                        const Encoding& encoding = {}, bool isFile = true);

}  // namespace fragtrace
