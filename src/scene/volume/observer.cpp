// SPDX-License-Identifier: MIT
#include "scene/volume/observer.h"

#include <cmath>

namespace fragtrace {

namespace {

/// One lobe of the fit; wavelengths in nanometres.
double lobe(double wavelength, double middle, double below, double above) {
  const double t = (wavelength - middle) * (wavelength < middle ? below : above);
  return std::exp(-0.5 * t * t);
}

/// Spectral radiance, W / (m^2 sr m).
double planck(double wavelength, double temperature) {
  constexpr double kFirst = 1.191042972e-16;  // 2 h c^2
  constexpr double kSecond = 1.438776877e-2;  // h c / k
  return kFirst / (std::pow(wavelength, 5.0) * std::expm1(kSecond / (wavelength * temperature)));
}

}  // namespace

glm::dvec3 observer(double w) {
  return {0.362 * lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * lobe(w, 599.8, 0.0264, 0.0323) -
              0.065 * lobe(w, 501.1, 0.0490, 0.0382),
          0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322),
          1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725)};
}

glm::dvec3 srgbOf(const glm::dvec3& xyz) {
  const glm::dmat3 toSrgb(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314,
                          0.0415560, 1.0572252);
  return toSrgb * xyz;
}

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
