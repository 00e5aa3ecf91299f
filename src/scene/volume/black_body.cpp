// SPDX-License-Identifier: MIT
#include "scene/volume/black_body.h"

#include <cmath>

#include "scene/volume/observer.h"

namespace fragtrace {

namespace {

/// Spectral radiance, W / (m^2 sr m).
double planck(double wavelength, double temperature) {
  constexpr double kFirst = 1.191042972e-16;  // 2 h c^2
  constexpr double kSecond = 1.438776877e-2;  // h c / k
  return kFirst / (std::pow(wavelength, 5.0) * std::expm1(kSecond / (wavelength * temperature)));
}

}  // namespace

glm::dvec3 blackBodyRadiance(double temperature) {
  if (!(temperature > 0.0)) return glm::dvec3(0.0);
  constexpr double kLumens = 683.002;  // a watt at 555 nm
  constexpr int kFirst = 380;          // nm
  constexpr int kLast = 780;
  glm::dvec3 xyz(0.0);
  for (int nm = kFirst; nm < kLast; ++nm) {
    const double w = nm + 0.5;
    xyz += observer(w) * planck(w * 1e-9, temperature) * (1e-9 * kLumens);
  }
  return glm::max(srgbOf(xyz), glm::dvec3(0.0));
}

}  // namespace fragtrace
