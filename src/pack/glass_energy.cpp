// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <mutex>

#include "pack/energy_tables.h"
#include "pack/visible_normals.h"

namespace fragtrace {

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

}  // namespace fragtrace
