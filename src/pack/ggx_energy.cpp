// SPDX-License-Identifier: MIT
#include "pack/ggx_energy.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace fragtrace {

namespace {

constexpr int kQuadrature = 24;  // samples along each axis of the unit square

double lambda(const glm::dvec3& v, double alpha) {
  const double tangentSquared = (v.x * v.x + v.y * v.y) / std::max(v.z * v.z, 1e-30);
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tangentSquared) - 1.0);
}

/// Albedo under single scattering: the mean of G2 / G1 over visible normals (Dupuy and Benyoub, 2023, for the
/// sampling).
double albedo(double cosine, double alpha) {
  if (alpha <= 0.0) return 1.0;
  const double mu = std::max(cosine, 1e-4);
  const glm::dvec3 outgoing(std::sqrt(1.0 - mu * mu), 0.0, mu);
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * outgoing.x, 0.0, outgoing.z));
  const double lambdaOut = lambda(outgoing, alpha);
  double sum = 0.0;
  for (int a = 0; a < kQuadrature; ++a) {
    // The integrand is even in phi, so half of the circle does.
    const double phi = glm::pi<double>() * (a + 0.5) / kQuadrature;
    // Each column is shifted by another golden part of a step: the value falls to 0 where light would go
    // below the horizon, and seen from above that edge would lie between two rows of a plain grid for all
    // phi.
    const double shift = glm::fract((a + 0.5) * 0.6180339887498949);
    for (int b = 0; b < kQuadrature; ++b) {
      const double z = (1.0 - (b + shift) / kQuadrature) * (1.0 + stretched.z) - stretched.z;
      const double sine = std::sqrt(std::max(0.0, 1.0 - z * z));
      const glm::dvec3 cap = glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), z) + stretched;
      const glm::dvec3 h = glm::normalize(glm::dvec3(alpha * cap.x, alpha * cap.y, std::max(cap.z, 1e-12)));
      const glm::dvec3 incoming = 2.0 * glm::dot(outgoing, h) * h - outgoing;
      if (incoming.z > 0.0) sum += (1.0 + lambdaOut) / (1.0 + lambdaOut + lambda(incoming, alpha));
    }
  }
  return sum / (kQuadrature * kQuadrature);
}

GgxEnergyTable makeTable() {
  constexpr int kNodes = GgxEnergyTable::kNodes;
  GgxEnergyTable table;
  for (int j = 0; j < kNodes; ++j) {
    const double y = double(j) / kGgxEnergyCells;
    for (int i = 0; i < kNodes; ++i) {
      const double x = double(i) / kGgxEnergyCells;
      table.loss.push_back(float(1.0 - albedo(x * x, y * y)));
    }
  }
  // 2 * integral of loss(mu) mu dmu, through the same interpolation the shader uses, so that nothing is
  // gained or lost by it.
  for (int j = 0; j < kNodes; ++j) {
    const double y = double(j) / kGgxEnergyCells;
    constexpr int kSteps = 1024;
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double mu = (k + 0.5) / kSteps;
      sum += 2.0 * mu * ggxLoss(table, float(mu), float(y * y)) / kSteps;
    }
    table.averageLoss.push_back(float(sum));
  }
  return table;
}

}  // namespace

float ggxLoss(const GgxEnergyTable& table, float cosine, float alpha) {
  const float x = std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * kGgxEnergyCells;
  const float y = std::sqrt(std::clamp(alpha, 0.0f, 1.0f)) * kGgxEnergyCells;
  const int i = std::min(int(x), kGgxEnergyCells - 1);
  const int j = std::min(int(y), kGgxEnergyCells - 1);
  const float* row = table.loss.data() + size_t(j) * GgxEnergyTable::kNodes + size_t(i);
  const float low = glm::mix(row[0], row[1], x - float(i));
  const float high = glm::mix(row[GgxEnergyTable::kNodes], row[GgxEnergyTable::kNodes + 1], x - float(i));
  return glm::mix(low, high, y - float(j));
}

float ggxAverageLoss(const GgxEnergyTable& table, float alpha) {
  const float y = std::sqrt(std::clamp(alpha, 0.0f, 1.0f)) * kGgxEnergyCells;
  const int j = std::min(int(y), kGgxEnergyCells - 1);
  return glm::mix(table.averageLoss[size_t(j)], table.averageLoss[size_t(j) + 1], y - float(j));
}

const GgxEnergyTable& ggxEnergyTable() {
  static const GgxEnergyTable table = makeTable();
  return table;
}

}  // namespace fragtrace
