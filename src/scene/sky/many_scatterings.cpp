// SPDX-License-Identifier: MIT
#include "scene/sky/many_scatterings.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace fragtrace {

namespace {

constexpr int kHeights = 24;
constexpr int kSuns = 65;       // cosines of the sun's angle; the middle one is 0
constexpr double kNight = 0.3;  // a sun with a cosine below -0.3 lights no air

/// The places of the table are dense at the ground, and where the sun is at the horizon.
double heightOf(int row) {
  const double s = double(row) / (kHeights - 1);
  return (kAirTop - kGroundRadius) * s * s;
}

double sunCosineOf(int column) {
  const double s = 2.0 * column / (kSuns - 1) - 1.0;
  return s * std::abs(s) * (s < 0.0 ? kNight : 1.0);
}

/// The cosine between two directions by their cosines to the zenith and the turn between them.
double cosineBetween(double a, double b, double turn) {
  return a * b + std::sqrt(std::max(0.0, (1.0 - a * a) * (1.0 - b * b))) * std::cos(turn);
}

struct ScatteredSums {
  Spectrum twice{};  // radiance that was scattered once before
  Spectrum
      again{};  // the radiance that light of radiance 1 from all directions has after one more scattering
};

/// Adds what a point of the way scatters, or the ground at its end, with a weight.
struct RayWalk {
  const Atmosphere& air;
  const AirTable& table;
  double albedo;
  double radius;
  double sunCosine;
  int steps;

  Spectrum sunAt(const RayPoint& point, double cosineOfSun) const {
    Spectrum light = transmittanceOf(air, table.columnsFrom(point.radius, cosineOfSun));
    const double share = sunShare(point.radius, cosineOfSun);
    for (double& value : light) value *= share;
    return light;
  }

  /// The cosine of the sun at a point of the ray, by that between ray and sun.
  double sunThere(const RayPoint& point, double distance, double between) const {
    return std::clamp((radius * sunCosine + distance * between) / point.radius, -1.0, 1.0);
  }

  void addRay(double cosine, const std::vector<double>& turns, double weight, const Quadrature& along,
              ScatteredSums& sums) const {
    const bool ground = meetsGround(radius, cosine);
    const double whole = ground ? distanceToGround(radius, cosine) : distanceToTop(radius, cosine);
    AirColumns passed{};
    double before = 0.0;
    AirColumns densityBefore = densityAt(radius - kGroundRadius);
    const auto pass = [&](double distance, const AirColumns& density) {
      const double middle = 0.5 * (before + distance);
      const AirColumns between = densityAt(alongRay(radius, cosine, middle).radius - kGroundRadius);
      // Simpson's rule, as densities bend.
      for (size_t k = 0; k < passed.size(); ++k)
        passed[k] += (distance - before) / 6.0 * (densityBefore[k] + 4.0 * between[k] + density[k]);
      before = distance;
      densityBefore = density;
    };
    for (size_t i = 0; i < along.nodes.size(); ++i) {
      const double s = along.nodes[i];
      const double distance = whole * s * s;
      const RayPoint point = alongRay(radius, cosine, distance);
      const AirColumns density = densityAt(point.radius - kGroundRadius);
      pass(distance, density);
      const Spectrum passes = transmittanceOf(air, passed);
      const double length = along.weights[i] * 2.0 * s * whole * weight;
      Spectrum scattered;
      for (size_t k = 0; k < kWavelengths; ++k) {
        scattered[k] = passes[k] * length *
                       (air.molecules[k] * density[size_t(Air::Molecules)] +
                        air.aerosol[k] * density[size_t(Air::Aerosol)]);
        sums.again[k] += scattered[k];
      }
      for (const double turn : turns) {
        const Spectrum sun = sunAt(point, sunThere(point, distance, cosineBetween(cosine, sunCosine, turn)));
        for (size_t k = 0; k < kWavelengths; ++k)
          sums.twice[k] += scattered[k] * sun[k] / (4.0 * kHalfTurn * double(turns.size()));
      }
    }
    if (!ground || albedo <= 0.0) return;
    const RayPoint end{kGroundRadius, cosine};
    pass(whole, densityAt(0.0));
    const Spectrum passes = transmittanceOf(air, passed);
    for (const double turn : turns) {
      const double cosineOfSun = sunThere(end, whole, cosineBetween(cosine, sunCosine, turn));
      const Spectrum sun = sunAt(end, cosineOfSun);
      const double share = weight * albedo / kHalfTurn * std::max(0.0, cosineOfSun) / double(turns.size());
      for (size_t k = 0; k < kWavelengths; ++k) sums.twice[k] += passes[k] * sun[k] * share;
    }
  }
};

}  // namespace

Quadrature quadratureOf(int count) {
  Quadrature result;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(kHalfTurn * (i + 0.75) / (count + 0.5));
    double slope = 1.0;
    for (int turn = 0; turn < 50; ++turn) {
      double low = 1.0;
      double high = x;
      for (int k = 2; k <= count; ++k) {
        const double next = ((2.0 * k - 1.0) * x * high - (k - 1.0) * low) / k;
        low = high;
        high = next;
      }
      slope = count * (x * high - low) / (x * x - 1.0);
      const double step = high / slope;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    result.nodes.push_back(0.5 - 0.5 * x);
    result.weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return result;
}

Spectrum scatteredOften(const Atmosphere& air, const AirTable& table, double albedo, double radius,
                        double sunCosine, ScatteringSteps steps) {
  const RayWalk walk{air, table, albedo, radius, sunCosine, steps.steps};
  const Quadrature along = quadratureOf(steps.steps);
  const Quadrature heights = quadratureOf(steps.directions);
  const int count = steps.directions / 2;
  std::vector<double> turns;
  turns.reserve(size_t(count));
  for (int i = 0; i < count; ++i) turns.push_back(kHalfTurn * (i + 0.5) / count);
  // The means over all directions, above the horizon and below.
  const double horizon = -std::sqrt(std::max(0.0, 1.0 - kGroundRadius * kGroundRadius / (radius * radius)));
  ScatteredSums sums;
  for (size_t i = 0; i < heights.nodes.size(); ++i) {
    // Rays are dense at the horizon.
    const double s = heights.nodes[i];
    const double weight = heights.weights[i] * 2.0 * s * 0.5;
    walk.addRay(horizon + (1.0 - horizon) * s * s, turns, weight * (1.0 - horizon), along, sums);
    walk.addRay(horizon - (1.0 + horizon) * s * s, turns, weight * (1.0 + horizon), along, sums);
  }
  Spectrum result;
  for (size_t k = 0; k < kWavelengths; ++k) result[k] = sums.twice[k] / (1.0 - sums.again[k]);
  return result;
}

ScatteringTable::ScatteringTable(const Atmosphere& air, const AirTable& table, double albedo)
    : values_(size_t(kHeights) * kSuns) {
  forEachIndex(values_.size(), [&](size_t i) {
    const double radius = kGroundRadius + heightOf(int(i) / kSuns);
    values_[i] = scatteredOften(air, table, albedo, radius, sunCosineOf(int(i) % kSuns));
  });
}

Spectrum ScatteringTable::at(double radius, double sunCosine) const {
  const double height = std::max(0.0, radius - kGroundRadius) / (kAirTop - kGroundRadius);
  const double y = std::min(std::sqrt(height), 1.0) * (kHeights - 1);
  const double root = std::sqrt(std::min(std::abs(sunCosine) / (sunCosine < 0.0 ? kNight : 1.0), 1.0));
  const double x = 0.5 * (1.0 + (sunCosine < 0.0 ? -root : root)) * (kSuns - 1);
  return interpolated(values_, kSuns, x, y);
}

}  // namespace fragtrace
