// SPDX-License-Identifier: MIT
#include "image/files/as_shown.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "image/channels.h"
#include "image/files/exr_parts.h"

namespace fragtrace {

namespace {

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

}  // namespace

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

}  // namespace fragtrace
