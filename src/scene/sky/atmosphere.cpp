// SPDX-License-Identifier: MIT
#include "scene/sky/atmosphere.h"

#include <algorithm>
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

double moleculesPhase(double cosine) { return 3.0 / (16.0 * kHalfTurn) * (1.0 + cosine * cosine); }

double aerosolPhase(double cosine) {
  constexpr double g = kAerosolMean;
  const double factor = 3.0 / (8.0 * kHalfTurn) * (1.0 - g * g) / (2.0 + g * g);
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
  const double x = std::clamp(edge / (kSunRadiusDegrees * kHalfTurn / 180.0), -1.0, 1.0);
  return 0.5 + (x * std::sqrt(1.0 - x * x) + std::asin(x)) / kHalfTurn;
}

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

}  // namespace fragtrace
