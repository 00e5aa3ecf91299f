// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>

#include "pack/energy_tables.h"
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
  GgxEnergyTable table{energyTableOf([](double cosine, double alpha) { return 1.0 - albedo(cosine, alpha); }),
                       {}};
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

}  // namespace fragtrace
