// SPDX-License-Identifier: MIT
#include "pack/glass_energy.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <map>
#include <mutex>

#include "pack/ggx_energy.h"

namespace fragtrace {

namespace {

constexpr int kSamplesASide = 20;  // of the unit square

// The terms of shaders/ggx.glsl and shaders/fresnel.glsl, in double precision.

double smithLambda(const glm::dvec3& v, double alpha) {
  const double tangentSquared = (v.x * v.x + v.y * v.y) / std::max(v.z * v.z, 1e-30);
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tangentSquared) - 1.0);
}

double refractedSquared(double cosine, double eta) { return (eta - 1.0) * (eta + 1.0) + cosine * cosine; }

double reflectance(double cosine, double eta) {
  const double squared = refractedSquared(cosine, eta);
  if (squared < 0.0) return 1.0;
  const double refracted = std::sqrt(squared);
  constexpr double kTiny = 1e-30;
  const double parallel =
      (eta * eta * cosine - refracted) / std::max(eta * eta * cosine + refracted, kTiny);
  const double perpendicular = (cosine - refracted) / std::max(cosine + refracted, kTiny);
  return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

/// Mean over visible normals of what each facet reflects and transmits to the right side, times G2 / G1
/// (Dupuy and Benyoub, 2023, for the sampling). `eta`: index behind over before.
double glassAlbedo(double cosine, double alpha, double eta) {
  if (alpha <= 0.0) return 1.0;
  const double mu = std::max(cosine, 1e-4);
  const glm::dvec3 outgoing(std::sqrt(1.0 - mu * mu), 0.0, mu);
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * outgoing.x, 0.0, outgoing.z));
  const double lambdaOut = smithLambda(outgoing, alpha);
  const auto kept = [&](const glm::dvec3& incoming) {
    return (1.0 + lambdaOut) / (1.0 + lambdaOut + smithLambda(incoming, alpha));
  };
  double sum = 0.0;
  for (int a = 0; a < kSamplesASide; ++a) {
    // The integrand is even in phi, so half of the circle does.
    const double phi = glm::pi<double>() * (a + 0.5) / kSamplesASide;
    const double shift = glm::fract((a + 0.5) * 0.6180339887498949);  // as in ggx_energy.cpp
    for (int b = 0; b < kSamplesASide; ++b) {
      const double z = (1.0 - (b + shift) / kSamplesASide) * (1.0 + stretched.z) - stretched.z;
      const double sine = std::sqrt(std::max(0.0, 1.0 - z * z));
      const glm::dvec3 cap = glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), z) + stretched;
      const glm::dvec3 h = glm::normalize(glm::dvec3(alpha * cap.x, alpha * cap.y, std::max(cap.z, 1e-12)));
      const double oh = glm::dot(outgoing, h);
      const double reflected = reflectance(oh, eta);
      const glm::dvec3 mirrored = 2.0 * oh * h - outgoing;
      if (mirrored.z > 0.0) sum += reflected * kept(mirrored);
      if (reflected >= 1.0) continue;
      const double refracted = std::sqrt(std::max(refractedSquared(oh, eta), 0.0));
      const glm::dvec3 through = glm::normalize((oh - refracted) * h - outgoing);
      if (through.z < 0.0) sum += (1.0 - reflected) * kept(through);
    }
  }
  return sum / (kSamplesASide * kSamplesASide);
}

std::vector<float> makeSide(double eta) {
  std::vector<float> nodes;
  nodes.reserve(size_t(GgxEnergyTable::kNodes) * GgxEnergyTable::kNodes);
  for (int j = 0; j < GgxEnergyTable::kNodes; ++j) {
    const double y = double(j) / kGgxEnergyCells;
    for (int i = 0; i < GgxEnergyTable::kNodes; ++i) {
      const double x = double(i) / kGgxEnergyCells;
      nodes.push_back(float(glassAlbedo(x * x, y * y, eta)));
    }
  }
  return nodes;
}

}  // namespace

const GlassAlbedoTable& glassAlbedoTable(double ior) {
  static std::mutex mutex;
  static std::map<double, GlassAlbedoTable> tables;
  const std::scoped_lock lock(mutex);
  const auto [place, isNew] = tables.try_emplace(ior);
  if (isNew) place->second = {makeSide(ior), makeSide(1.0 / ior)};
  return place->second;
}

}  // namespace fragtrace
