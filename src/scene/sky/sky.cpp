// SPDX-License-Identifier: MIT
#include "scene/sky/sky.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <regex>

#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "scene/volume/read_grid.h"

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

constexpr double kBin = 10.0;  // nm

/// Irradiance outside the atmosphere in W/m^2/nm, means over bins of 10 nm from 360 nm on (ASTM G-173, column
/// ETR, as listed by Bruneton, 2017).
constexpr std::array<double, 48> kSun{1.11776, 1.14259, 1.01249, 1.14716, 1.72765, 1.73054, 1.6887,  1.61253,
                                      1.91198, 2.03474, 2.02042, 2.02212, 1.93377, 1.95809, 1.91686, 1.8298,
                                      1.8685,  1.8931,  1.85149, 1.8504,  1.8341,  1.8345,  1.8147,  1.78158,
                                      1.7533,  1.6965,  1.68194, 1.64654, 1.6048,  1.52143, 1.55622, 1.5113,
                                      1.474,   1.4482,  1.41018, 1.36775, 1.34188, 1.31429, 1.28303, 1.26758,
                                      1.2367,  1.2082,  1.18737, 1.14683, 1.12362, 1.1058,  1.07124, 1.04992};

std::array<glm::dvec3, kWavelengths> makeColors() {
  constexpr double kEfficacy = 683.0;  // lm/W
  constexpr double kScale = kEfficacy * kBin * glm::pi<double>() / kFullDaylight;
  std::array<glm::dvec3, kWavelengths> colors{};
  for (size_t i = 0; i < kSun.size(); ++i) {
    const double wavelength = 365.0 + kBin * double(i);
    const glm::dvec3 color = srgbOf(observer(wavelength)) * (kSun[i] * kScale);
    // Values between two wavelengths are interpolated.
    const double place =
        std::clamp((wavelength / 1000.0 - wavelengthOf(0)) / (wavelengthOf(1) - wavelengthOf(0)), 0.0,
                   double(kWavelengths - 1));
    const size_t first = std::min(size_t(place), kWavelengths - 2);
    colors[first] += color * (1.0 - (place - double(first)));
    colors[first + 1] += color * (place - double(first));
  }
  return colors;
}

/// Linear Rec.709 of sunlight of irradiance 1 (outside the atmosphere) at each wavelength. The sum over
/// wavelengths, times the part that arrives, is the radiance of a picture where that part is in 1/sr.
const std::array<glm::dvec3, kWavelengths>& daylightColors() {
  static const std::array<glm::dvec3, kWavelengths> colors = makeColors();
  return colors;
}

constexpr int kSkyWidth = 256;
constexpr int kSkyHeight = 512;  // finer, as the light changes fast above the horizon
constexpr int kRaySteps = 32;    // along a ray

/// A step along a ray that starts on the ground.
struct RayStep {
  double distance;
  double radius;
  // The part of the sun's light there that comes to the eye, except for the phase function.
  Spectrum molecules;
  Spectrum aerosol;
};

std::vector<RayStep> stepsAlong(const SkyAir& sky, double cosine) {
  static const Quadrature along = quadratureOf(kRaySteps);
  const double whole = distanceToTop(kGroundRadius, cosine);
  const AirColumns all = sky.table.columnsFrom(kGroundRadius, cosine);
  std::vector<RayStep> steps;
  for (size_t i = 0; i < along.nodes.size(); ++i) {
    const double s = along.nodes[i];
    RayStep step{};
    step.distance = whole * s * s;
    const RayPoint point = alongRay(kGroundRadius, cosine, step.distance);
    step.radius = point.radius;
    const AirColumns beyond = sky.table.columnsFrom(point.radius, point.cosine);
    AirColumns passed;
    for (size_t k = 0; k < passed.size(); ++k) passed[k] = std::max(0.0, all[k] - beyond[k]);
    const Spectrum passes = transmittanceOf(sky.air, passed);
    const AirColumns density = densityAt(point.radius - kGroundRadius);
    const double length = along.weights[i] * 2.0 * s * whole;
    for (size_t k = 0; k < kWavelengths; ++k) {
      step.molecules[k] = passes[k] * length * sky.air.molecules[k] * density[size_t(Air::Molecules)];
      step.aerosol[k] = passes[k] * length * sky.air.aerosol[k] * density[size_t(Air::Aerosol)];
    }
    steps.push_back(step);
  }
  return steps;
}

Spectrum radianceAlong(const SkyAir& sky, const std::vector<RayStep>& steps, double cosine, double sunCosine,
                       double turn) {
  const double sines = std::sqrt(std::max(0.0, (1.0 - cosine * cosine) * (1.0 - sunCosine * sunCosine)));
  const double between = std::clamp(cosine * sunCosine + sines * std::cos(turn), -1.0, 1.0);
  const double ofMolecules = moleculesPhase(between);
  const double ofAerosol = aerosolPhase(between);
  Spectrum sum{};
  for (const RayStep& step : steps) {
    const double cosineOfSun =
        std::clamp((kGroundRadius * sunCosine + step.distance * between) / step.radius, -1.0, 1.0);
    const Spectrum often = sky.often.at(step.radius, cosineOfSun);
    const double share = sunShare(step.radius, cosineOfSun);
    Spectrum sun{};
    if (share > 0.0) sun = transmittanceOf(sky.air, sky.table.columnsFrom(step.radius, cosineOfSun));
    for (size_t k = 0; k < kWavelengths; ++k)
      sum[k] += step.molecules[k] * (share * sun[k] * ofMolecules + often[k]) +
                step.aerosol[k] * (share * sun[k] * ofAerosol + often[k]);
  }
  return sum;
}

/// The part of the disc above the horizon: how much of its light that is, and what the air lets pass of it.
SunDisc discAt(const SkyAir& sky, double elevation) {
  constexpr int kParts = 32;
  const double radius = glm::radians(kSunRadiusDegrees);
  SunDisc sun;
  const double angle = glm::radians(elevation);
  sun.direction = {0.0, std::sin(angle), -std::cos(angle)};
  Spectrum passes{};
  double visible = 0.0;
  double all = 0.0;
  for (int y = 0; y < kParts; ++y) {
    const double up = 2.0 * (y + 0.5) / kParts - 1.0;
    double strip = 0.0;
    for (int x = 0; x < kParts; ++x) {
      const double across = 2.0 * (x + 0.5) / kParts - 1.0;
      strip += std::pow(std::max(0.0, 1.0 - up * up - across * across), 0.5 * kLimbPowers.g);
    }
    all += strip;
    const double cosine = std::sin(angle + up * radius);
    if (cosine < 0.0) continue;
    visible += strip;
    const Spectrum there = transmittanceOf(sky.air, sky.table.columnsFrom(kGroundRadius, cosine));
    for (size_t k = 0; k < kWavelengths; ++k) passes[k] += strip * there[k];
  }
  if (visible <= 0.0) return sun;
  const glm::dvec3 light = glm::max(colorOf(passes) / visible, 0.0);
  sun.irradiance = light * (visible / all);
  // The mean of the limb's power over the disc is 2 / (2 + power).
  sun.radiance = light * (1.0 + 0.5 * kLimbPowers) / (glm::pi<double>() * radius * radius);
  return sun;
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

glm::dvec3 colorOf(const Spectrum& part) {
  glm::dvec3 sum(0.0);
  for (size_t i = 0; i < kWavelengths; ++i) sum += daylightColors()[i] * part[i];
  return sum;
}

SkyAir::SkyAir(double turbidity, double groundAlbedo)
    : air(atmosphereOf(turbidity)), often(air, table, groundAlbedo), albedo(groundAlbedo) {}

Spectrum skyRadiance(const SkyAir& sky, double cosine, double sunCosine, double turn) {
  return radianceAlong(sky, stepsAlong(sky, cosine), cosine, sunCosine, turn);
}

SkyMap makeSky(const SkyAir& sky, double sunElevation) {
  SkyMap map;
  map.sun = discAt(sky, sunElevation);
  const double sunCosine = std::sin(glm::radians(sunElevation));
  map.image = {
      kSkyWidth, kSkyHeight, {"R", "G", "B"}, std::vector<float>(size_t(kSkyWidth) * kSkyHeight * 3), {}};
  std::vector<glm::dvec3> sums(kSkyHeight / 2, glm::dvec3(0.0));
  forEachIndex(kSkyHeight / 2, [&](size_t y) {
    const double polar = glm::pi<double>() * (double(y) + 0.5) / kSkyHeight;
    const std::vector<RayStep> steps = stepsAlong(sky, std::cos(polar));
    // Both sides of the sun are alike.
    for (int i = 0; i < kSkyWidth / 2; ++i) {
      const double turn = 2.0 * glm::pi<double>() * (i + 0.5) / kSkyWidth;
      const Spectrum part = radianceAlong(sky, steps, std::cos(polar), sunCosine, turn);
      const glm::dvec3 color = glm::max(colorOf(part), 0.0);
      sums[y] += 2.0 * color;
      for (const int x : {kSkyWidth / 4 + i, kSkyWidth / 4 - 1 - i}) {
        float* p = map.image.pixel((x + kSkyWidth) % kSkyWidth, int(y));
        for (int c = 0; c < 3; ++c) p[c] = float(color[c]);
      }
    }
    sums[y] *= std::cos(polar) * std::sin(polar) * (glm::pi<double>() / kSkyHeight) *
               (2.0 * glm::pi<double>() / kSkyWidth);
  });
  // The ground next to the eye takes all this light, and that of the sun.
  glm::dvec3 falls = map.sun.irradiance * std::max(0.0, sunCosine);
  for (const glm::dvec3& sum : sums) falls += sum;
  const glm::vec3 ground(falls * sky.albedo / glm::pi<double>());
  for (int y = kSkyHeight / 2; y < kSkyHeight; ++y) {
    for (int x = 0; x < kSkyWidth; ++x) std::copy_n(&ground.x, 3, map.image.pixel(x, y));
  }
  return map;
}

Image withDisc(Image map, const SunDisc& sun) {
  const double u = std::atan2(sun.direction.z, sun.direction.x) / (2.0 * glm::pi<double>()) + 0.5;
  const double v = std::acos(std::clamp(sun.direction.y, -1.0, 1.0)) / glm::pi<double>();
  const double x = u * map.width - 0.5;
  const double y = v * map.height - 0.5;
  for (const int right : {0, 1}) {
    for (const int down : {0, 1}) {
      const int column = (int(std::floor(x)) + right + map.width) % map.width;
      const int row = std::clamp(int(std::floor(y)) + down, 0, map.height - 1);
      const double fx = x - std::floor(x);
      const double fy = y - std::floor(y);
      const double share = (right == 1 ? fx : 1.0 - fx) * (down == 1 ? fy : 1.0 - fy);
      const double solidAngle = 2.0 * glm::pi<double>() / map.width * glm::pi<double>() / map.height *
                                std::sin(glm::pi<double>() * (row + 0.5) / map.height);
      for (int c = 0; c < 3; ++c) map.pixel(column, row)[c] += float(sun.irradiance[c] * share / solidAngle);
    }
  }
  return map;
}

SkyMap makeSky(double turbidity, double groundAlbedo, double sunElevation) {
  struct Kept {
    double turbidity;
    SkyAir sky;
  };
  static std::mutex mutex;
  static std::shared_ptr<const Kept> kept;
  std::shared_ptr<const Kept> own;
  {
    const std::lock_guard lock(mutex);
    own = kept;
  }
  if (!own || own->turbidity != turbidity || own->sky.albedo != groundAlbedo) {
    own = std::make_shared<const Kept>(Kept{turbidity, SkyAir(turbidity, groundAlbedo)});
    const std::lock_guard lock(mutex);
    kept = own;
  }
  return makeSky(own->sky, sunElevation);
}

}  // namespace fragtrace
