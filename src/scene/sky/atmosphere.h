// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <glm/gtc/constants.hpp>

namespace fragtrace {

// The air of the Earth: what it scatters and absorbs at each height (docs/design/sky.md). Lengths are
// kilometres, angles are given by their cosine to the zenith.

/// A value for each of the wavelengths.
inline constexpr size_t kWavelengths = 10;
using Spectrum = std::array<double, kWavelengths>;

/// Wavelength of a value, in micrometres.
constexpr double wavelengthOf(size_t index) { return 0.395 + 0.035 * double(index); }

inline constexpr double kGroundRadius = 6360.0;
inline constexpr double kAirTop = 6460.0;            ///< radius above which there is no air
inline constexpr double kSunRadiusDegrees = 0.2665;  ///< radius of the disc

/// Parts of the air: molecules, aerosol and ozone.
enum class Air : size_t { Molecules, Aerosol, Ozone, Count };
/// A number for each part of the air.
using AirColumns = std::array<double, size_t(Air::Count)>;

/// Density at a height above the ground: of molecules and aerosol as a part of that at the ground, of ozone
/// as a part of the greatest.
AirColumns densityAt(double height);

/// Coefficients at density 1, in 1/km.
struct Atmosphere {
  std::array<Spectrum, size_t(Air::Count)> extinction;
  Spectrum molecules;  ///< scattering
  Spectrum aerosol;    ///< scattering
};

/// The air with such a turbidity: how much more light haze and molecules take than molecules alone; 1: clear.
Atmosphere atmosphereOf(double turbidity);

/// Phase functions (1/sr) by the cosine of the angle between the light before and after.
double moleculesPhase(double cosine);
double aerosolPhase(double cosine);

/// Interpolates a table of rows of `width` entries linearly; x counts entries, y rows, both from 0.
template <typename Values>
Values interpolated(const std::vector<Values>& table, size_t width, double x, double y) {
  const size_t x0 = std::min(size_t(x), width - 2);
  const size_t y0 = std::min(size_t(y), table.size() / width - 2);
  const double fx = x - double(x0);
  const double fy = y - double(y0);
  const Values* low = &table[y0 * width + x0];
  const Values* high = low + width;
  Values result;
  for (size_t k = 0; k < result.size(); ++k)
    result[k] = (1.0 - fy) * ((1.0 - fx) * low[0][k] + fx * low[1][k]) +
                fy * ((1.0 - fx) * high[0][k] + fx * high[1][k]);
  return result;
}

/// Columns of air (density times km) along rays that leave the atmosphere without meeting the ground.
class AirTable {
 public:
  AirTable();
  AirColumns columnsFrom(double radius, double cosine) const;

 private:
  std::vector<AirColumns> values_;
};

/// The part of the light that columns let pass.
Spectrum transmittanceOf(const Atmosphere& air, const AirColumns& columns);

/// The part of the sun's disc that a point sees above the horizon, by the cosine of the sun's angle.
double sunShare(double radius, double sunCosine);

/// Distance along a ray to the top of the atmosphere, and to the ground, which the ray meets.
double distanceToTop(double radius, double cosine);
double distanceToGround(double radius, double cosine);
bool meetsGround(double radius, double cosine);

/// A point of a ray at a distance: its radius, and the cosine of the ray to the zenith there.
struct RayPoint {
  double radius;
  double cosine;
};
RayPoint alongRay(double radius, double cosine, double distance);

// Light that the air scatters more than once, as Hillaire (2020) approximates it: the same in all directions.

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
