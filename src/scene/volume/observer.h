// SPDX-License-Identifier: MIT
// Colours of spectra.
#pragma once

#include <glm/glm.hpp>

namespace fragtrace {

/// Colour matching functions of the CIE's 1931 observer, as X, Y, Z at a wavelength in nanometres: the fit of
/// Wyman, Sloan and Shirley (Simple Analytic Approximations to the CIE XYZ Color Matching Functions, JCGT
/// 2(2), 2013).
glm::dvec3 observer(double nanometres);

/// Linear sRGB of X, Y, Z; colours outside of sRGB have negative parts.
glm::dvec3 srgbOf(const glm::dvec3& xyz);

/// Radiance of a black body (Planck) as linear sRGB whose luminance is in cd/m^2; colours outside of sRGB are
/// clamped. By the fit of the CIE's 1931 observer of Wyman, Sloan and Shirley (Simple Analytic Approximations
/// to the CIE XYZ Color Matching Functions, JCGT 2(2), 2013). 0 for a temperature (kelvin) that is not above
/// 0.
glm::dvec3 blackBodyRadiance(double temperature);

}  // namespace fragtrace
