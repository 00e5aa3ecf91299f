// SPDX-License-Identifier: MIT
// Light that the air scatters more than once, as Hillaire (2020) approximates it: the same in all directions.
#pragma once

#include <vector>

#include "scene/sky/atmosphere.h"

namespace fragtrace {

/// Nodes and weights of an integral over 0..1 (Gauss and Legendre).
struct Quadrature {
  std::vector<double> nodes;
  std::vector<double> weights;
};
Quadrature quadratureOf(int count);

/// The number of directions (heights, and half as many turns) and of steps along each.
struct ScatteringSteps {
  int directions = 6;
  int steps = 16;
};

/// Radiance by which the light scattered twice or more often is scattered there in any direction, in units of
/// the sun's irradiance outside the atmosphere, per coefficient of scattering.
Spectrum scatteredOften(const Atmosphere& air, const AirTable& table, double albedo, double radius,
                        double sunCosine, ScatteringSteps steps = {});

/// A table of these.
class ScatteringTable {
 public:
  ScatteringTable(const Atmosphere& air, const AirTable& table, double albedo);
  Spectrum at(double radius, double sunCosine) const;

 private:
  std::vector<Spectrum> values_;
};

}  // namespace fragtrace
