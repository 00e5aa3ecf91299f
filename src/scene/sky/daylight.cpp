// SPDX-License-Identifier: MIT
#include "scene/sky/daylight.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/volume/observer.h"

namespace fragtrace {

namespace {

constexpr double kBin = 10.0;  // nm

/// Irradiance outside the atmosphere in W/m^2/nm, means over bins of 10 nm from 360 nm on (ASTM G-173, column
/// ETR, as listed by Bruneton, 2017).
constexpr std::array<double, 48> kSun{1.11776, 1.14259, 1.01249, 1.14716, 1.72765, 1.73054, 1.6887,  1.61253,
                                      1.91198, 2.03474, 2.02042, 2.02212, 1.93377, 1.95809, 1.91686, 1.8298,
                                      1.8685,  1.8931,  1.85149, 1.8504,  1.8341,  1.8345,  1.8147,  1.78158,
                                      1.7533,  1.6965,  1.68194, 1.64654, 1.6048,  1.52143, 1.55622, 1.5113,
                                      1.474,   1.4482,  1.41018, 1.36775, 1.34188, 1.31429, 1.28303, 1.26758,
                                      1.2367,  1.2082,  1.18737, 1.14683, 1.12362, 1.1058,  1.07124, 1.04992};

std::array<glm::dvec3, kWavelengths> makeColors() {
  constexpr double kEfficacy = 683.0;  // lm/W
  constexpr double kScale = kEfficacy * kBin * glm::pi<double>() / kFullDaylight;
  std::array<glm::dvec3, kWavelengths> colors{};
  for (size_t i = 0; i < kSun.size(); ++i) {
    const double wavelength = 365.0 + kBin * double(i);
    const glm::dvec3 color = srgbOf(observer(wavelength)) * (kSun[i] * kScale);
    // Values between two wavelengths are interpolated.
    const double place =
        std::clamp((wavelength / 1000.0 - wavelengthOf(0)) / (wavelengthOf(1) - wavelengthOf(0)), 0.0,
                   double(kWavelengths - 1));
    const size_t first = std::min(size_t(place), kWavelengths - 2);
    colors[first] += color * (1.0 - (place - double(first)));
    colors[first + 1] += color * (place - double(first));
  }
  return colors;
}

}  // namespace

const std::array<glm::dvec3, kWavelengths>& daylightColors() {
  static const std::array<glm::dvec3, kWavelengths> colors = makeColors();
  return colors;
}

glm::dvec3 colorOf(const Spectrum& part) {
  glm::dvec3 sum(0.0);
  for (size_t i = 0; i < kWavelengths; ++i) sum += daylightColors()[i] * part[i];
  return sum;
}

}  // namespace fragtrace
