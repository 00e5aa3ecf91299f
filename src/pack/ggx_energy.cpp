// SPDX-License-Identifier: MIT
#include "pack/ggx_energy.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "pack/visible_normals.h"

namespace fragtrace {

namespace {

constexpr int kQuadrature = 24;  // samples along each axis of the unit square

/// Albedo under single scattering: the mean of G2 / G1 over visible normals.
double albedo(double cosine, double alpha) {
  if (alpha <= 0.0) return 1.0;
  return meanOverVisibleNormals(cosine, alpha, kQuadrature,
                                [alpha](const glm::dvec3& wo, const glm::dvec3& h) {
                                  const glm::dvec3 wi = 2.0 * glm::dot(wo, h) * h - wo;
                                  const double before = 1.0 + smithLambda(wo, alpha);
                                  return wi.z > 0.0 ? before / (before + smithLambda(wi, alpha)) : 0.0;
                                });
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
  // 2 * integral of loss(mu) mu dmu, by the same interpolation as in the shader, so that interpolation gains
  // or loses no light.
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
