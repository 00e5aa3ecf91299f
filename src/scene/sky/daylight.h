// SPDX-License-Identifier: MIT
// The sun's spectrum, as the colours of pictures.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/sky/atmosphere.h"

namespace fragtrace {

/// A picture's value of 1 is the luminance of a white surface in this much light, in lux.
inline constexpr double kFullDaylight = 1e5;

/// Linear Rec.709 of sunlight of irradiance 1 (outside the atmosphere) at each wavelength. The sum over
/// wavelengths, times the part that arrives, is the radiance of a picture where that part is in 1/sr.
const std::array<glm::dvec3, kWavelengths>& daylightColors();

glm::dvec3 colorOf(const Spectrum& part);

}  // namespace fragtrace
