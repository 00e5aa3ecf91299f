// SPDX-License-Identifier: MIT
#include "pack/energy_tables.h"

#include <array>
#include <map>
#include <mutex>
#include <utility>

namespace fragtrace {

namespace {

constexpr int kQuadrature = 24;  // samples along each axis of the unit square

/// Albedo under single scattering: the mean of G2 / G1 over visible normals.
double ggxAlbedo(double cosine, double alpha) {
  if (alpha <= 0.0) return 1.0;
  return meanOverVisibleNormals(cosine, alpha, kQuadrature,
                                [alpha](const glm::dvec3& wo, const glm::dvec3& h) {
                                  const glm::dvec3 wi = 2.0 * glm::dot(wo, h) * h - wo;
                                  const double before = 1.0 + smithLambda(wo, alpha);
                                  return wi.z > 0.0 ? before / (before + smithLambda(wi, alpha)) : 0.0;
                                });
}

GgxEnergyTable makeTable() {
  GgxEnergyTable table{
      energyTableOf([](double cosine, double alpha) { return 1.0 - ggxAlbedo(cosine, alpha); }), {}};
  // 2 * integral of loss(mu) mu dmu, by the same interpolation as in the shader, so that interpolation gains
  // or loses no light.
  for (int j = 0; j < EnergyTable::kNodes; ++j) {
    const double y = double(j) / EnergyTable::kCells;
    constexpr int kSteps = 1024;
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double mu = (k + 0.5) / kSteps;
      sum += 2.0 * mu * table.loss.at(float(mu), float(y * y)) / kSteps;
    }
    table.averageLoss.push_back(float(sum));
  }
  return table;
}

/// The cell in which a cosine or an alpha lies, and how far along it, 0 to 1.
std::pair<size_t, float> placeOf(float value) {
  const float place = std::sqrt(std::clamp(value, 0.0f, 1.0f)) * EnergyTable::kCells;
  const int cell = std::min(int(place), EnergyTable::kCells - 1);
  return {size_t(cell), place - float(cell)};
}

}  // namespace

float EnergyTable::at(float cosine, float alpha) const {
  const auto [i, x] = placeOf(cosine);
  const auto [j, y] = placeOf(alpha);
  const float* low = nodes.data() + j * kNodes + i;
  const float* high = low + kNodes;
  return glm::mix(glm::mix(low[0], low[1], x), glm::mix(high[0], high[1], x), y);
}

float GgxEnergyTable::averageAt(float alpha) const {
  const auto [j, y] = placeOf(alpha);
  return glm::mix(averageLoss[j], averageLoss[j + 1], y);
}

const GgxEnergyTable& ggxEnergyTable() {
  static const GgxEnergyTable table = makeTable();
  return table;
}

namespace {

constexpr int kSamplesASide = 20;  // samples along each side of the unit square

// These are the terms of shaders/fresnel.glsl, in double precision.

double refractedSquared(double cosine, double eta) { return (eta - 1.0) * (eta + 1.0) + cosine * cosine; }

double reflectance(double cosine, double eta) {
  const double squared = refractedSquared(cosine, eta);
  if (squared < 0.0) return 1.0;
  const double refracted = std::sqrt(squared);
  constexpr double kTiny = 1e-30;
  const double parallel = (eta * eta * cosine - refracted) / std::max(eta * eta * cosine + refracted, kTiny);
  const double perpendicular = (cosine - refracted) / std::max(cosine + refracted, kTiny);
  return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

/// The mean over visible normals of the light that a facet reflects and transmits to the right side, times G2
/// / G1. `eta`: index behind over before.
double glassAlbedo(double cosine, double alpha, double eta) {
  if (alpha <= 0.0) return 1.0;
  return meanOverVisibleNormals(
      cosine, alpha, kSamplesASide, [alpha, eta](const glm::dvec3& wo, const glm::dvec3& h) {
        const double before = 1.0 + smithLambda(wo, alpha);
        const double oh = glm::dot(wo, h);
        const double reflected = reflectance(oh, eta);
        const glm::dvec3 mirrored = 2.0 * oh * h - wo;
        double kept = mirrored.z > 0.0 ? reflected * before / (before + smithLambda(mirrored, alpha)) : 0.0;
        const double refracted = std::sqrt(std::max(refractedSquared(oh, eta), 0.0));
        const glm::dvec3 through = glm::normalize((oh - refracted) * h - wo);
        if (through.z < 0.0) kept += (1.0 - reflected) * before / (before + smithLambda(through, alpha));
        return kept;
      });
}

EnergyTable sideOf(double eta) {
  return energyTableOf([eta](double cosine, double alpha) { return glassAlbedo(cosine, alpha, eta); });
}

}  // namespace

const GlassAlbedoTable& glassAlbedoTable(double ior) {
  static std::mutex mutex;
  static std::map<double, GlassAlbedoTable> tables;
  const std::scoped_lock lock(mutex);
  const auto [place, isNew] = tables.try_emplace(ior);
  if (isNew) place->second = {sideOf(ior), sideOf(1.0 / ior)};
  return place->second;
}

namespace {

constexpr int kHeights = 32;  // heights and turns of the quadrature
constexpr int kTurns = 24;

// These are the distribution and the fit of shaders/layers.glsl, in double precision.

double fit(double x, double alpha) {
  const double t = (1.0 - alpha) * (1.0 - alpha);
  const double a = glm::mix(21.5473, 25.3245, t);
  const double b = glm::mix(3.82987, 3.32435, t);
  const double c = glm::mix(0.19823, 0.16801, t);
  const double d = glm::mix(-1.97760, -1.27393, t);
  const double e = glm::mix(-4.32054, -4.85967, t);
  return a / (1.0 + b * std::pow(x, c)) + d * x + e;
}

double lambda(double cosine, double alpha) {
  return cosine < 0.5 ? std::exp(fit(cosine, alpha))
                      : std::exp(2.0 * fit(0.5, alpha) - fit(1.0 - cosine, alpha));
}

/// Heights are squares of equal steps, since the lobe lies near the horizon.
struct Height {
  double cosine, sine, lambda, weight;
};

std::array<Height, kHeights> heightsOf(double alpha) {
  std::array<Height, kHeights> heights{};
  for (int k = 0; k < kHeights; ++k) {
    const double root = (k + 0.5) / kHeights;
    const double z = root * root;
    heights[size_t(k)] = {z, std::sqrt(1.0 - z * z), lambda(z, alpha), 2.0 * root / kHeights};
  }
  return heights;
}

/// Cosine and alpha are kept away from 0, alpha below what shaders use.
double lobeAlbedo(double cosine, double alpha) {
  cosine = std::max(cosine, 1e-4);
  alpha = std::max(alpha, 0.03 * 0.03);
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const double lambdaOut = lambda(cosine, alpha);
  double sum = 0.0;
  for (const Height& in : heightsOf(alpha)) {
    double around = 0.0;
    for (int j = 0; j < kTurns; ++j) {
      // The integrand is even in phi, so half of the circle is enough.
      const double phi = glm::pi<double>() * (j + 0.5) / kTurns;
      const glm::dvec3 h(sine + in.sine * std::cos(phi), in.sine * std::sin(phi), cosine + in.cosine);
      const double sine2 = (h.x * h.x + h.y * h.y) / glm::dot(h, h);
      around += std::pow(sine2, 0.5 / alpha);
    }
    sum += in.weight * around / kTurns / (1.0 + lambdaOut + in.lambda);
  }
  return (2.0 + 1.0 / alpha) * sum / (4.0 * cosine);
}

}  // namespace

const EnergyTable& sheenAlbedoTable() {
  static const EnergyTable table = energyTableOf(lobeAlbedo);
  return table;
}

}  // namespace fragtrace
