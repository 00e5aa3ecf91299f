// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <glm/glm.hpp>

#include "image/image.h"
#include "scene/sky/atmosphere.h"

namespace fragtrace {

// The place of the sun in the sky.

struct SunPlace {
  double elevation = 45.0;  ///< degrees above the horizon
  double azimuth = 225.0;   ///< degrees from north (-Z), clockwise seen from above: 90 is east (+X)

  bool operator==(const SunPlace&) const = default;
};

/// Days since noon of 1 January 2000 (universal time) by a date and time with offset as ISO 8601 writes them:
/// 2026-06-21T14:30:00+02:00; seconds may be left out, and Z is +00:00. None where the text is no such time.
std::optional<double> daysOf(const std::string& time);

/// The sun's place at that time as an observer at sea level sees it, the bending of light included. Latitude
/// and longitude are in degrees, north and east positive. Good to 0.02 degrees from 1950 to 2050.
SunPlace sunPlaceAt(double days, const glm::dvec2& latitudeLongitude);

// The sun's spectrum, as the colours of pictures.

/// A picture's value of 1 is the luminance of a white surface in this much light, in lux.
inline constexpr double kFullDaylight = 1e5;

glm::dvec3 colorOf(const Spectrum& part);

// The clear sky and the sun as somebody on the ground sees them (docs/design/sky.md).

/// The sun's disc, which is no part of the map.
struct SunDisc {
  glm::dvec3 direction{0.0, 1.0, 0.0};  ///< direction of the disc's middle, in the map's space
  glm::dvec3 irradiance{0.0};           ///< irradiance of a surface that faces the sun
  glm::dvec3 radiance{0.0};             ///< radiance of the disc's middle
};

/// Powers of the cosine at the sun's surface by which its radiance falls to the limb, for red, green and blue
/// light (Hestroffer and Magnan, 1998: 0.292 / wavelength - 0.023, at 610, 550 and 465 nm).
inline constexpr glm::dvec3 kLimbPowers{0.456, 0.508, 0.605};

/// An equirectangular map with R, G, B to whose texels the light of the disc is added.
Image withDisc(Image map, const SunDisc& sun);

struct SkyMap {
  Image image;  ///< equirectangular with R, G, B; the sun stands above -Z, and the lower half is the ground
  SunDisc sun;
};

/// The air of a sky, wherever the sun stands.
struct SkyAir {
  Atmosphere air;
  AirTable table;
  ScatteringTable often;
  double albedo;

  SkyAir(double turbidity, double groundAlbedo);
};

/// Light from one direction above the horizon, in units of the sun's irradiance (1/sr), by the cosine of the
/// direction and the cosine of the sun's angle to the zenith, and the turn between the two in radians.
Spectrum skyRadiance(const SkyAir& sky, double cosine, double sunCosine, double turn);

/// The sun's elevation is in degrees. Uses all processors.
SkyMap makeSky(const SkyAir& sky, double sunElevation);

/// The same; the air of the last call is kept.
SkyMap makeSky(double turbidity, double groundAlbedo, double sunElevation);

}  // namespace fragtrace
