// SPDX-License-Identifier: MIT
#include "scene/sky/sun_place.h"

#include <chrono>
#include <cmath>
#include <regex>

namespace fragtrace {

namespace {

double sine(double degrees) { return std::sin(glm::radians(degrees)); }
double cosine(double degrees) { return std::cos(glm::radians(degrees)); }

double wholeTurns(double degrees) { return degrees - 360.0 * std::floor(degrees / 360.0); }

/// The sun's declination in degrees, and by how many minutes a sundial is ahead of a clock.
struct Season {
  double declination;
  double equationOfTime;
};

/// Meeus, Astronomical Algorithms (1998), chapters 25 and 28, as NOAA's solar calculator uses them.
Season seasonAt(double centuries) {
  const double t = centuries;
  const double longitude = wholeTurns(280.46646 + t * (36000.76983 + 0.0003032 * t));
  const double anomaly = wholeTurns(357.52911 + t * (35999.05029 - 0.0001537 * t));
  const double eccentricity = 0.016708634 - t * (0.000042037 + 0.0000001267 * t);
  const double center = sine(anomaly) * (1.914602 - t * (0.004817 + 0.000014 * t)) +
                        sine(2.0 * anomaly) * (0.019993 - 0.000101 * t) + sine(3.0 * anomaly) * 0.000289;
  const double node = 125.04 - 1934.136 * t;
  const double apparent = longitude + center - 0.00569 - 0.00478 * sine(node);
  const double seconds = 21.448 - t * (46.815 + t * (0.00059 - 0.001813 * t));
  const double obliquity = 23.0 + (26.0 + seconds / 60.0) / 60.0 + 0.00256 * cosine(node);
  const double half = std::tan(glm::radians(0.5 * obliquity));
  const double y = half * half;
  const double time = y * sine(2.0 * longitude) - 2.0 * eccentricity * sine(anomaly) +
                      4.0 * eccentricity * y * sine(anomaly) * cosine(2.0 * longitude) -
                      0.5 * y * y * sine(4.0 * longitude) -
                      1.25 * eccentricity * eccentricity * sine(2.0 * anomaly);
  return {glm::degrees(std::asin(sine(obliquity) * sine(apparent))), 4.0 * glm::degrees(time)};
}

/// Degrees by which air lifts a star at that elevation (NOAA).
double refractionAt(double elevation) {
  if (elevation > 85.0) return 0.0;
  const double tangent = std::tan(glm::radians(elevation));
  double seconds = -20.772 / tangent;
  if (elevation > 5.0)
    seconds = 58.1 / tangent - 0.07 / std::pow(tangent, 3.0) + 0.000086 / std::pow(tangent, 5.0);
  else if (elevation > -0.575)
    seconds = 1735.0 + elevation * (-518.2 + elevation * (103.4 + elevation * (-12.79 + elevation * 0.711)));
  return seconds / 3600.0;
}

}  // namespace

std::optional<double> daysOf(const std::string& time) {
  static const std::regex form(
      R"((\d{4})-(\d\d)-(\d\d)[Tt ](\d\d):(\d\d)(?::(\d\d(?:\.\d+)?))?(?:[Zz]|([+-])(\d\d):?(\d\d)?))");
  std::smatch part;
  if (!std::regex_match(time, part, form)) return std::nullopt;
  const auto number = [&](size_t i) { return part[i].matched ? std::stod(part[i].str()) : 0.0; };
  const std::chrono::year_month_day date{std::chrono::year(int(number(1))),
                                         std::chrono::month(unsigned(number(2))),
                                         std::chrono::day(unsigned(number(3)))};
  if (!date.ok() || number(4) > 23.0 || number(5) > 59.0 || number(6) >= 61.0 || number(8) > 23.0 ||
      number(9) > 59.0)
    return std::nullopt;
  using namespace std::chrono_literals;
  const auto day = (std::chrono::sys_days(date) - std::chrono::sys_days(2000y / 1 / 1)).count();
  const double offset = (number(8) + number(9) / 60.0) * (part[7].str() == "-" ? -1.0 : 1.0);
  return double(day) - 0.5 + (number(4) + number(5) / 60.0 + number(6) / 3600.0 - offset) / 24.0;
}

SunPlace sunPlaceAt(double days, const glm::dvec2& latitudeLongitude) {
  const Season season = seasonAt(days / 36525.0);
  const double latitude = latitudeLongitude.x;
  const double minutes = 1440.0 * (days + 0.5 - std::floor(days + 0.5));
  const double hourAngle = (minutes + season.equationOfTime + 4.0 * latitudeLongitude.y) / 4.0 - 180.0;
  const double height = sine(latitude) * sine(season.declination) +
                        cosine(latitude) * cosine(season.declination) * cosine(hourAngle);
  const double elevation = glm::degrees(std::asin(glm::clamp(height, -1.0, 1.0)));
  // The azimuth is measured from south, westwards.
  const double east = sine(hourAngle) * cosine(season.declination);
  const double south = cosine(hourAngle) * sine(latitude) * cosine(season.declination) -
                       sine(season.declination) * cosine(latitude);
  return {elevation + refractionAt(elevation), wholeTurns(glm::degrees(std::atan2(east, south)) + 180.0)};
}

}  // namespace fragtrace
