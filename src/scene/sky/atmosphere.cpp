// SPDX-License-Identifier: MIT
#include "scene/sky/atmosphere.h"

#include <cmath>

#include "base/parallel.h"

namespace fragtrace {

namespace {

constexpr double kMoleculesHeight = 8.0;  // densities fall by the factor e over these
constexpr double kAerosolHeight = 2.5;
constexpr double kOzoneMiddle = 25.0;
constexpr double kOzoneHalf = 15.0;
constexpr double kAerosolDepth = 0.021;   // optical, at 550 nm, for each step of turbidity
constexpr double kAerosolAlbedo = 0.925;  // albedo of one scattering
constexpr double kAerosolMean = 0.703;    // mean cosine of its scattering
constexpr int kTableCosines = 256;
constexpr int kTableRadii = 64;
constexpr int kColumnSteps = 100;

/// Cross-section of ozone at 233 K in 1e-26 m^2, means over bins of 10 nm from 360 nm on (Serdyuchenko et
/// al., 2014, as listed by Bruneton, 2017).
constexpr std::array<double, 48> kOzone{
    0.118, 0.02182, 0.02818, 0.06636, 0.1527, 0.2763, 0.552, 0.8451, 1.582, 2.316, 3.669, 4.924,
    7.752, 9.016,   14.80,   16.02,   21.39,  27.55,  30.91, 35.0,   42.66, 46.72, 43.98, 47.01,
    50.19, 43.05,   37.4,    32.15,   26.62,  22.38,  18.52, 14.73,  12.09, 9.423, 7.455, 6.566,
    5.105, 4.15,    4.228,   3.237,   2.451,  2.801,  2.534, 1.624,  1.465, 2.078, 1.383, 0.7105};

/// The mean about a wavelength, with the weights by which light of two of them is mixed.
double ozoneAt(double micrometres) {
  double sum = 0.0;
  double weights = 0.0;
  for (size_t i = 0; i < kOzone.size(); ++i) {
    const double weight = 1.0 - std::abs(0.365 + 0.01 * double(i) - micrometres) / 0.035;
    if (weight <= 0.0) continue;
    sum += weight * kOzone[i];
    weights += weight;
  }
  return sum / weights;
}

double lengthToTop() {
  return std::sqrt(kAirTop * kAirTop - kGroundRadius * kGroundRadius);  // along the horizon
}

/// The cosine of the horizon.
double horizonOf(double radius) {
  const double sine = kGroundRadius / radius;
  return -std::sqrt(std::max(0.0, 1.0 - sine * sine));
}

/// The columns of AirTable, integrated in `steps` steps.
AirColumns integrateColumns(double radius, double cosine, int steps) {
  AirColumns columns{};
  const double whole = distanceToTop(radius, cosine);
  for (int i = 0; i < steps; ++i) {
    // Steps grow with the square, as the air near the start is the densest.
    const double s = (i + 0.5) / steps;
    const AirColumns density = densityAt(alongRay(radius, cosine, whole * s * s).radius - kGroundRadius);
    for (size_t k = 0; k < columns.size(); ++k) columns[k] += density[k] * whole * 2.0 * s / steps;
  }
  return columns;
}

}  // namespace

AirColumns densityAt(double height) {
  return {std::exp(-height / kMoleculesHeight), std::exp(-height / kAerosolHeight),
          std::max(0.0, 1.0 - std::abs(height - kOzoneMiddle) / kOzoneHalf)};
}

Atmosphere atmosphereOf(double turbidity) {
  constexpr double kDobson = 2.687e20;  // molecules per m^2
  constexpr double kOzoneDensity = 300.0 * kDobson / (kOzoneHalf * 1000.0);
  Atmosphere air{};
  for (size_t i = 0; i < kWavelengths; ++i) {
    const double wavelength = wavelengthOf(i);
    air.molecules[i] = 1.24062e-3 * std::pow(wavelength, -4.0);
    const double aerosol =
        kAerosolDepth * (turbidity - 1.0) * std::pow(wavelength / 0.55, -1.3) / kAerosolHeight;
    air.aerosol[i] = kAerosolAlbedo * aerosol;
    air.extinction[size_t(Air::Molecules)][i] = air.molecules[i];
    air.extinction[size_t(Air::Aerosol)][i] = aerosol;
    air.extinction[size_t(Air::Ozone)][i] = ozoneAt(wavelength) * 1e-26 * kOzoneDensity * 1000.0;
  }
  return air;
}

double moleculesPhase(double cosine) { return 3.0 / (16.0 * glm::pi<double>()) * (1.0 + cosine * cosine); }

double aerosolPhase(double cosine) {
  constexpr double g = kAerosolMean;
  const double factor = 3.0 / (8.0 * glm::pi<double>()) * (1.0 - g * g) / (2.0 + g * g);
  return factor * (1.0 + cosine * cosine) / std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
}

double distanceToTop(double radius, double cosine) {
  const double along = radius * cosine;
  return -along + std::sqrt(std::max(0.0, along * along - radius * radius + kAirTop * kAirTop));
}

double distanceToGround(double radius, double cosine) {
  const double along = radius * cosine;
  return std::max(0.0, -along - std::sqrt(std::max(
                                    0.0, along * along - radius * radius + kGroundRadius * kGroundRadius)));
}

bool meetsGround(double radius, double cosine) { return cosine < horizonOf(radius); }

RayPoint alongRay(double radius, double cosine, double distance) {
  const double there =
      std::sqrt(std::max(0.0, distance * distance + 2.0 * radius * cosine * distance + radius * radius));
  return {std::clamp(there, kGroundRadius, kAirTop), (radius * cosine + distance) / there};
}

double sunShare(double radius, double sunCosine) {
  const double edge = std::asin(sunCosine) - std::asin(horizonOf(radius));
  const double x = std::clamp(edge / (kSunRadiusDegrees * glm::pi<double>() / 180.0), -1.0, 1.0);
  return 0.5 + (x * std::sqrt(1.0 - x * x) + std::asin(x)) / glm::pi<double>();
}

Spectrum transmittanceOf(const Atmosphere& air, const AirColumns& columns) {
  Spectrum result;
  for (size_t i = 0; i < kWavelengths; ++i) {
    double depth = 0.0;
    for (size_t k = 0; k < columns.size(); ++k) depth += air.extinction[k][i] * columns[k];
    result[i] = std::exp(-depth);
  }
  return result;
}

// Rows and columns are those of Bruneton and Neyret (2008): fine where the air is dense, and at the horizon.
AirTable::AirTable() : values_(size_t(kTableCosines) * kTableRadii) {
  const double longest = lengthToTop();
  forEachIndex(kTableRadii, [&](size_t y) {
    const double toHorizon = longest * double(y) / (kTableRadii - 1);
    const double radius = std::sqrt(toHorizon * toHorizon + kGroundRadius * kGroundRadius);
    const double nearest = kAirTop - radius;
    const double farthest = toHorizon + longest;
    for (int x = 0; x < kTableCosines; ++x) {
      const double distance = nearest + (farthest - nearest) * x / (kTableCosines - 1);
      const double cosine =
          distance <= 0.0
              ? 1.0
              : (longest * longest - toHorizon * toHorizon - distance * distance) / (2.0 * radius * distance);
      values_[y * kTableCosines + size_t(x)] =
          integrateColumns(radius, std::clamp(cosine, -1.0, 1.0), kColumnSteps);
    }
  });
}

AirColumns AirTable::columnsFrom(double radius, double cosine) const {
  const double longest = lengthToTop();
  const double toHorizon = std::sqrt(std::max(0.0, radius * radius - kGroundRadius * kGroundRadius));
  const double nearest = kAirTop - radius;
  const double farthest = toHorizon + longest;
  const double x = std::clamp((distanceToTop(radius, cosine) - nearest) / (farthest - nearest), 0.0, 1.0) *
                   (kTableCosines - 1);
  const double y = std::min(toHorizon / longest, 1.0) * (kTableRadii - 1);
  return interpolated(values_, kTableCosines, x, y);
}

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
          sums.twice[k] += scattered[k] * sun[k] / (4.0 * glm::pi<double>() * double(turns.size()));
      }
    }
    if (!ground || albedo <= 0.0) return;
    const RayPoint end{kGroundRadius, cosine};
    pass(whole, densityAt(0.0));
    const Spectrum passes = transmittanceOf(air, passed);
    for (const double turn : turns) {
      const double cosineOfSun = sunThere(end, whole, cosineBetween(cosine, sunCosine, turn));
      const Spectrum sun = sunAt(end, cosineOfSun);
      const double share =
          weight * albedo / glm::pi<double>() * std::max(0.0, cosineOfSun) / double(turns.size());
      for (size_t k = 0; k < kWavelengths; ++k) sums.twice[k] += passes[k] * sun[k] * share;
    }
  }
};

}  // namespace

Quadrature quadratureOf(int count) {
  Quadrature result;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(glm::pi<double>() * (i + 0.75) / (count + 0.5));
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
  for (int i = 0; i < count; ++i) turns.push_back(glm::pi<double>() * (i + 0.5) / count);
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
