// SPDX-License-Identifier: MIT
// The materials that the tests of shaders/bsdf.glsl walk, formulas written down a second time, and integrals
// over the sphere.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "glsl.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;
using glsl_variant::With;

using Bsdf = glsl_double::Bsdf;

/// Makes a BSDF from metallic, transmission, roughness and index, as makeBsdf of shaders/shade.glsl does.
inline Bsdf makeBsdf(double metallic, double transmission, double roughness, double ior, bool solid,
                     bool front) {
  Bsdf b;
  b.baseColor = dvec3(0.9, 0.6, 0.3);
  b.dielectricF0 = dvec3(std::pow((ior - 1.0) / (ior + 1.0), 2.0));
  b.dielectricF90 = 1.0;
  b.metal = metallic;
  b.glass = (1.0 - metallic) * transmission;
  b.opaque = 1.0 - b.metal - b.glass;
  b.alpha = roughness * roughness;
  b.mirrorLike = b.alpha < glsl_double::kMirrorAlpha;
  b.solid = solid;
  b.eta = front ? ior : 1.0 / ior;
  b.stretch = 1.0;
  b.glassLost = 0.0;
  b.sharesGlass = false;
  b.film = b.diffuseThrough = b.coat = 0.0;
  b.filmIndex = 1.3;
  b.filmThickness = 0.0;
  b.throughColor = dvec3(1.0);
  b.sheenColor = dvec3(0.0);
  b.sheenAlpha = 0.25;
  b.coatAlpha = 0.0;
  b.coatNormal = dvec3(0.0, 0.0, 1.0);
  b.faceNormal = b.vertexNormal = b.coatNormal;
  return glsl_double::compensate(b);
}

inline glsl_float::Bsdf toFloat(const Bsdf& b) {
  glsl_float::Bsdf f;
  f.baseColor = vec3(b.baseColor);
  f.dielectricF0 = vec3(b.dielectricF0);
  f.dielectricF90 = float(b.dielectricF90);
  f.metal = float(b.metal);
  f.opaque = float(b.opaque);
  f.glass = float(b.glass);
  f.alpha = float(b.alpha);
  f.mirrorLike = b.mirrorLike;
  f.sharesGlass = b.sharesGlass;
  f.solid = b.solid;
  f.eta = float(b.eta);
  f.between = vec3(b.between);
  f.stretch = float(b.stretch);
  f.glassLost = float(b.glassLost);
  f.film = float(b.film);
  f.filmIndex = float(b.filmIndex);
  f.filmThickness = float(b.filmThickness);
  f.diffuseThrough = float(b.diffuseThrough);
  f.throughColor = vec3(b.throughColor);
  f.sheenColor = vec3(b.sheenColor);
  f.sheenAlpha = float(b.sheenAlpha);
  f.coat = float(b.coat);
  f.coatAlpha = float(b.coatAlpha);
  f.coatNormal = vec3(b.coatNormal);
  return f;
}

struct Case {
  std::string name;
  Bsdf bsdf;
};

inline Bsdf lambert() {
  Bsdf b = makeBsdf(0, 0, 0.5, 1.5, false, true);
  b.dielectricF0 = dvec3(0.0);
  b.dielectricF90 = 0.0;
  return glsl_double::compensate(b);
}

inline std::vector<Case> opaqueCases() {
  Bsdf tinted = makeBsdf(0.0, 0.0, 0.4, 1.5, false, true);
  tinted.dielectricF0 = dvec3(0.4, 0.1, 0.0);
  tinted.dielectricF90 = 0.6;
  tinted = glsl_double::compensate(tinted);
  return {{"diffuse", lambert()},
          {"smooth metal", makeBsdf(1, 0, 0.3, 1.5, false, true)},
          {"rough metal", makeBsdf(1, 0, 0.8, 1.5, false, true)},
          {"plastic", makeBsdf(0, 0, 0.4, 1.5, false, true)},
          {"plastic half metal", makeBsdf(0.5, 0, 0.6, 1.8, false, true)},
          {"tinted plastic", tinted}};
}

inline std::vector<Case> glassCases() {
  return {{"rough glass from outside", makeBsdf(0, 1, 0.4, 1.5, true, true)},
          {"rough glass from inside", makeBsdf(0, 1, 0.4, 1.5, true, false)},
          {"very rough glass from outside", makeBsdf(0, 1, 0.8, 2.0, true, true)},
          {"very rough glass from inside", makeBsdf(0, 1, 0.8, 2.0, true, false)},
          {"thin glass from the front", makeBsdf(0, 1, 0.5, 1.5, false, true)},
          {"thin glass from the back", makeBsdf(0, 1, 0.5, 1.5, false, false)},
          {"half glass, half plastic", makeBsdf(0, 0.5, 0.5, 1.5, true, true)},
          {"glass, plastic and metal", makeBsdf(0.3, 0.5, 0.6, 1.5, false, true)}};
}

inline std::vector<Case> allCases() {
  std::vector<Case> cases = opaqueCases();
  for (const Case& c : glassCases()) cases.push_back(c);
  return cases;
}

inline dvec3 atElevation(double z) { return {std::sqrt(1.0 - z * z) * 0.6, std::sqrt(1.0 - z * z) * 0.8, z}; }

inline const std::vector<double> kElevations = {1.0, 0.7, 0.2};

inline size_t binOf(double x, size_t bins) {
  return std::min(size_t(std::max(0.0, x) * double(bins)), bins - 1);
}

inline constexpr size_t kBands = 36;  // over the whole sphere, of equal angle
inline constexpr size_t kTurns = 24;

/// Integrals of f, a number or a vector, over the bins of the sphere.
template <typename Function>
inline auto integrateBins(Function f) {
  constexpr int kInner = 12;
  constexpr double kStepTheta = M_PI / (kBands * kInner);
  constexpr double kStepPhi = 2.0 * M_PI / (kTurns * kInner);
  std::vector<decltype(f(dvec3()))> bins(kBands * kTurns);
  for (size_t band = 0; band < kBands * kInner; ++band) {
    // Gauss's rule of two points per step: midpoints would be 0.2 % off in narrow lobes about the pole.
    const double side = band % 2 == 0 ? 1.0 - std::sqrt(1.0 / 3.0) : std::sqrt(1.0 / 3.0);
    const double theta = kStepTheta * (double(band) + side);
    const double r = std::sin(theta);
    for (size_t turn = 0; turn < kTurns * kInner; ++turn) {
      const double phi = kStepPhi * (double(turn) + 0.5) - M_PI;
      const dvec3 direction(r * std::cos(phi), r * std::sin(phi), std::cos(theta));
      bins[band / kInner * kTurns + turn / kInner] += r * kStepTheta * kStepPhi * f(direction);
    }
  }
  return bins;
}

inline size_t binOfDirection(const dvec3& d) {
  return binOf(std::acos(std::clamp(d.z, -1.0, 1.0)) / M_PI, kBands) * kTurns +
         binOf(std::atan2(d.y, d.x) / (2.0 * M_PI) + 0.5, kTurns);
}

template <typename Value>
inline Value total(const std::vector<Value>& values) {
  Value sum(0.0);
  for (const Value& v : values) sum += v;
  return sum;
}

// ---- values, by formulas written down a second time ----

/// glTF 2.0, appendix B.3.2: D, and V with the height-correlated Smith term.
inline double specularBrdf(const dvec3& o, const dvec3& i, double alpha) {
  const dvec3 h = glm::normalize(o + i);
  const double a2 = alpha * alpha;
  const double f = h.z * h.z * (a2 - 1.0) + 1.0;
  const double d = a2 / (M_PI * f * f);
  const double v =
      0.5 / (i.z * std::sqrt(o.z * o.z * (1.0 - a2) + a2) + o.z * std::sqrt(i.z * i.z * (1.0 - a2) + a2));
  return d * v;
}

inline dvec3 schlick(const dvec3& f0, double f90, double cosine) {
  return f0 + (dvec3(f90) - f0) * std::pow(1.0 - cosine, 5.0);
}

inline double fresnelExact(double cosine, double eta) {
  const double refracted2 = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
  if (refracted2 <= 0.0) return 1.0;
  const double refracted = std::sqrt(refracted2);
  const double s = (cosine - eta * refracted) / (cosine + eta * refracted);
  const double p = (refracted - eta * cosine) / (refracted + eta * cosine);
  return 0.5 * (s * s + p * p);
}

inline double smithLambda(const dvec3& v, double alpha) {
  const double tangent2 = (1.0 - v.z * v.z) / (v.z * v.z);
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tangent2) - 1.0);
}

/// The mean weight over a lattice of samples: what the surface sends back of white light from all around.
/// Radiance through a solid's boundary is scaled by 1 / eta^2, which is no energy, so it is scaled back.
inline dvec3 albedoByDrawing(const Bsdf& b, const dvec3& wo) {
  // The first number picks the lobe, too, so it takes finer steps.
  constexpr int kColumns = 1024;
  constexpr int kRows = 32;
  dvec3 sum(0.0);
  for (int x = 0; x < kColumns; ++x) {
    for (int y = 0; y < kRows; ++y) {
      const double choice = std::fmod((x * kRows + y) * 0.6180339887498949, 1.0);
      const auto s = glsl_double::sampleBsdf(b, wo, choice, (x + 0.5) / kColumns, (y + 0.5) / kRows);
      sum += s.weight * (s.transmitted && b.solid ? b.eta * b.eta : 1.0);
    }
  }
  return sum / double(kColumns * kRows);
}

inline dvec3 albedoByIntegration(const Bsdf& b, const dvec3& wo) {
  return total(integrateBins([&](const dvec3& i) {
    const double scale = i.z < 0.0 && b.solid ? b.eta * b.eta : 1.0;
    return glsl_double::evaluateBsdf(b, wo, i).value * scale;
  }));
}

}  // namespace
}  // namespace fragtrace
