// SPDX-License-Identifier: MIT
// The place of the sun in the sky.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

namespace fragtrace {

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

}  // namespace fragtrace
