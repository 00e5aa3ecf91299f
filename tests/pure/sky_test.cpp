// SPDX-License-Identifier: MIT
// The sky against an integration of the same model by small even steps, against Mitsuba's, and the sun's
// place against published ones.
#include "scene/sky/sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/vectors.h"

namespace fragtrace {
namespace {

using glm::dvec3;

/// Straight lines and even steps, without tables.
class BruteForce {
 public:
  BruteForce(double turbidity, double albedo) : air_(atmosphereOf(turbidity)), albedo_(albedo) {}

  /// Light from a direction, seen from the ground.
  Spectrum radiance(const dvec3& direction, const dvec3& sun) const {
    constexpr int kSteps = 3000;
    constexpr int kNodes = 24;  // nodes for light that is scattered often, which changes slowly
    const dvec3 eye(0.0, kGroundRadius, 0.0);
    const double whole = distanceToTop(kGroundRadius, direction.y);
    std::vector<Spectrum> often;
    for (int i = 0; i <= kNodes; ++i) {
      const double s = double(i) / kNodes;
      often.push_back(scatteredOften(eye + direction * (whole * s * s), sun));
    }
    const double between = glm::dot(direction, sun);
    AirColumns passed{};
    Spectrum sum{};
    for (int i = 0; i < kSteps; ++i) {
      const double s = (i + 0.5) / kSteps;
      const double length = whole * 2.0 * s / kSteps;
      const dvec3 point = eye + direction * (whole * s * s);
      const AirColumns density = densityAt(glm::length(point) - kGroundRadius);
      for (size_t k = 0; k < passed.size(); ++k) passed[k] += 0.5 * length * density[k];
      const Spectrum passes = transmittanceOf(air_, passed);
      const Spectrum light = i % 4 == 0 || i < 400 ? last_ = sunAt(point, sun, 300) : last_;
      const size_t node = std::min(size_t(s * kNodes), size_t(kNodes - 1));
      const double part = s * kNodes - double(node);
      for (size_t k = 0; k < kWavelengths; ++k) {
        const double molecules = air_.molecules[k] * density[0];
        const double aerosol = air_.aerosol[k] * density[1];
        const double many = often[node][k] * (1.0 - part) + often[node + 1][k] * part;
        sum[k] += passes[k] * length *
                  (light[k] * (molecules * moleculesPhase(between) + aerosol * aerosolPhase(between)) +
                   (molecules + aerosol) * many);
      }
      for (size_t k = 0; k < passed.size(); ++k) passed[k] += 0.5 * length * density[k];
    }
    return sum;
  }

 private:
  /// The sun's light that arrives at a point.
  Spectrum sunAt(const dvec3& point, const dvec3& sun, int steps) const {
    const double radius = glm::length(point);
    const double cosine = glm::dot(point, sun) / radius;
    const double share = sunShare(radius, cosine);
    Spectrum light{};
    if (share <= 0.0) return light;
    const double whole = distanceToTop(radius, cosine);
    AirColumns columns{};
    for (int i = 0; i < steps; ++i) {
      const AirColumns density =
          densityAt(glm::length(point + sun * (whole * (i + 0.5) / steps)) - kGroundRadius);
      for (size_t k = 0; k < columns.size(); ++k) columns[k] += density[k] * whole / steps;
    }
    light = transmittanceOf(air_, columns);
    for (double& value : light) value *= share;
    return light;
  }

  /// Hillaire (2020), equations 5 to 10.
  Spectrum scatteredOften(const dvec3& point, const dvec3& sun) const {
    constexpr int kHeights = 24;
    constexpr int kTurns = 8;
    constexpr int kSteps = 40;
    const double radius = glm::length(point);
    const dvec3 up = point / radius;
    const dvec3 across = glm::normalize(sun - up * glm::dot(sun, up) + dvec3(0.0, 0.0, 1e-9));
    const dvec3 aside = glm::cross(up, across);
    Spectrum twice{};
    Spectrum again{};
    for (int i = 0; i < kHeights * kTurns; ++i) {
      const int height = i / kTurns;
      const double cosine = 2.0 * (height + 0.5) / kHeights - 1.0;
      const double turn = M_PI * (i % kTurns + 0.5) / kTurns;
      const double sine = std::sqrt(1.0 - cosine * cosine);
      const dvec3 direction =
          up * cosine + across * (sine * std::cos(turn)) + aside * (sine * std::sin(turn));
      const bool ground = meetsGround(radius, cosine);
      const double whole = ground ? distanceToGround(radius, cosine) : distanceToTop(radius, cosine);
      AirColumns passed{};
      for (int step = 0; step < kSteps; ++step) {
        const double s = (step + 0.5) / kSteps;
        const double length = whole * 2.0 * s / kSteps;
        const dvec3 there = point + direction * (whole * s * s);
        const AirColumns density = densityAt(glm::length(there) - kGroundRadius);
        for (size_t k = 0; k < passed.size(); ++k) passed[k] += 0.5 * length * density[k];
        const Spectrum passes = transmittanceOf(air_, passed);
        const Spectrum light = sunAt(there, sun, 30);
        for (size_t k = 0; k < kWavelengths; ++k) {
          const double scattered = passes[k] * length *
                                   (air_.molecules[k] * density[0] + air_.aerosol[k] * density[1]) /
                                   (kHeights * kTurns);
          again[k] += scattered;
          twice[k] += scattered * light[k] / (4.0 * M_PI);
        }
        for (size_t k = 0; k < passed.size(); ++k) passed[k] += 0.5 * length * density[k];
      }
      if (!ground) continue;
      const dvec3 end = point + direction * whole;
      const Spectrum passes = transmittanceOf(air_, passed);
      const Spectrum light = sunAt(end, sun, 30);
      const double falls = std::max(0.0, glm::dot(glm::normalize(end), sun));
      for (size_t k = 0; k < kWavelengths; ++k)
        twice[k] += passes[k] * light[k] * albedo_ / M_PI * falls / (kHeights * kTurns);
    }
    for (size_t k = 0; k < kWavelengths; ++k) twice[k] /= 1.0 - again[k];
    return twice;
  }

  Atmosphere air_;
  double albedo_;
  mutable Spectrum last_{};  // the sun's light, which changes slowly far away
};

dvec3 towards(double elevation, double azimuth) {
  const double e = glm::radians(elevation);
  const double a = glm::radians(azimuth);
  return {std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a)};
}

/// The map as the shader reads it, between the middles of texels.
dvec3 lookUp(const Image& map, const dvec3& direction) {
  const double x = (std::atan2(direction.z, direction.x) / (2.0 * M_PI) + 0.5) * map.width - 0.5;
  const double y = std::acos(direction.y) / M_PI * map.height - 0.5;
  dvec3 sum(0.0);
  for (int i = 0; i < 4; ++i) {
    const int column = int(std::floor(x)) + i % 2;
    const int row = std::clamp(int(std::floor(y)) + i / 2, 0, map.height - 1);
    const float* p = map.pixel((column + map.width) % map.width, row);
    const double share = (1.0 - std::abs(x - column)) * std::max(0.0, 1.0 - std::abs(y - row));
    sum += share * dvec3(p[0], p[1], p[2]);
  }
  return sum;
}

TEST(Sky, IsWithinOnePercentOfSmallSteps) {
  struct Place {
    double sun;
    double elevation;
    double azimuth;
  };
  // The first is hardest at noon, the second at dusk.
  const std::vector<Place> clear{{50.0, 85.0, 10.0}, {20.0, 24.0, 3.0}, {-4.0, 12.0, 20.0}};
  const std::vector<Place> hazy{{50.0, 6.0, 300.0}, {5.0, 1.0, 8.0}, {0.0, 20.0, 180.0}, {-4.0, 12.0, 20.0}};
  for (const double turbidity : {2.0, 6.0}) {
    const SkyAir sky(turbidity, 0.3);
    const BruteForce exact(turbidity, 0.3);
    for (const Place& place : turbidity == 2.0 ? clear : hazy) {
      const SkyMap map = makeSky(sky, place.sun);
      const dvec3 direction = towards(place.elevation, place.azimuth);
      const dvec3 seen = lookUp(map.image, direction);
      const dvec3 expected = colorOf(exact.radiance(direction, towards(place.sun, 0.0)));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[c], expected[c], 0.01 * expected[c])
            << "turbidity " << turbidity << ", sun " << place.sun << ", elevation " << place.elevation
            << ", channel " << c;
    }
  }
}

const SkyAir& clearAir() {
  static const SkyAir sky(3.0, 0.2);
  return sky;
}

/// Radiance of the zenith in units of a picture.
double zenith(const SkyAir& sky, double sunElevation) {
  return luminance(colorOf(skyRadiance(sky, 1.0, std::sin(glm::radians(sunElevation)), 0.0)));
}

/// Values that /tmp/mi2/bin/python3 computed with Mitsuba 3.9.1, variant llvm_ad_spectral: emitters
/// sunsky(turbidity=T, albedo=0.2) with sun_scale=0 or sky_scale=0, `eval` at 390, 400 ... 720 nm, weighted
/// by the CIE's y (docs/design/sky.md).
struct OfMitsuba {
  double turbidity;
  double sun;         // elevation, degrees
  double aside;       // luminance at an elevation of 2 degrees, 90 degrees off the sun, by the zenith's
  double behind;      // the same opposite to the sun
  double irradiance;  // irradiance of level ground by the sky, over the zenith's luminance
  double sunlight;    // irradiance of a surface that faces the sun
};
constexpr OfMitsuba kOfMitsuba[] = {
    {3.0, 60.0, 3.149, 3.450, 4.579, 22.85}, {3.0, 40.0, 4.265, 5.688, 6.332, 32.24},
    {3.0, 20.0, 5.041, 8.006, 7.634, 40.67}, {3.0, 10.0, 5.033, 8.522, 7.997, 39.09},
    {6.0, 60.0, 1.577, 1.558, 3.988, 11.27}, {6.0, 40.0, 2.675, 3.126, 6.845, 19.70},
    {6.0, 20.0, 3.106, 4.229, 8.340, 25.02}, {6.0, 10.0, 2.921, 4.368, 8.564, 20.62}};

TEST(Sky, HasTheRatiosOfMitsuba) {
  constexpr double kAlbedo = 0.2;
  // The air lets pass more of the sun's spectrum (ASTM G-173) than Mitsuba's disc has: it sums to this part.
  constexpr double kSunOfMitsuba = 0.78;
  for (const double turbidity : {3.0, 6.0}) {
    const SkyAir sky(turbidity, kAlbedo);
    for (const OfMitsuba& there : kOfMitsuba) {
      if (there.turbidity != turbidity) continue;
      SCOPED_TRACE(testing::Message() << "turbidity " << turbidity << ", sun " << there.sun);
      const double height = std::sin(glm::radians(there.sun));
      const double overhead = zenith(sky, there.sun);
      const auto low = [&](double azimuth) {
        return luminance(colorOf(skyRadiance(sky, std::sin(glm::radians(2.0)), height, azimuth))) / overhead;
      };
      EXPECT_NEAR(low(0.5 * M_PI), there.aside, 0.2 * there.aside);
      EXPECT_NEAR(low(M_PI), there.behind, 0.2 * there.behind);
      const SkyMap map = makeSky(sky, there.sun);
      const float* p = map.image.pixel(0, map.image.height - 1);
      const double ground = luminance(dvec3(p[0], p[1], p[2])) / overhead;
      const double direct = luminance(map.sun.irradiance) * height / overhead;
      EXPECT_NEAR(ground * M_PI / kAlbedo - direct, there.irradiance, 0.2 * there.irradiance);
      const double sunlit = kAlbedo / M_PI * (there.irradiance + there.sunlight / kSunOfMitsuba * height);
      if (turbidity == 3.0) {
        EXPECT_NEAR(ground, sunlit, 0.25 * sunlit);
      }
    }
  }
}

TEST(Sky, IsLikeOnBothSidesOfTheSunAndDarkAtNight) {
  const SkyAir& sky = clearAir();
  for (const double sun : {90.0, 30.0, 0.1, -0.2, -10.0, -90.0}) {
    const SkyMap map = makeSky(sky, sun);
    for (const float value : map.image.values) ASSERT_TRUE(std::isfinite(value) && value >= 0.0f);
    const int width = map.image.width;
    const float* left = map.image.pixel(width / 4 - 8, 100);
    EXPECT_EQ(left[1], map.image.pixel(width / 4 + 7, 100)[1]);
    EXPECT_EQ(map.sun.irradiance == dvec3(0.0), sun < -0.2665);
    if (sun < -18.0) {
      EXPECT_LT(map.image.pixel(0, 0)[1], 1e-6f);
    }
  }
}

TEST(Sky, ADiscHasTheIrradianceOfItsRadiance) {
  const SunDisc sun = makeSky(clearAir(), 40.0).sun;
  constexpr int kRings = 4000;
  const double radius = glm::radians(kSunRadiusDegrees);
  dvec3 sum(0.0);
  for (int i = 0; i < kRings; ++i) {
    const double r = (i + 0.5) / kRings;
    for (int c = 0; c < 3; ++c)
      sum[c] += sun.radiance[c] * std::pow(std::sqrt(1.0 - r * r), kLimbPowers[c]) * 2.0 * M_PI * r * radius *
                radius / kRings;
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], sun.irradiance[c], 1e-4 * sum[c]);
  // A map with the light of the disc has it all.
  Image map{64, 32, {"R", "G", "B"}, std::vector<float>(size_t(64) * 32 * 3, 0.0f), {}};
  map = withDisc(std::move(map), sun);
  double light = 0.0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x)
      light += double(map.pixel(x, y)[1]) * std::sin(M_PI * (y + 0.5) / 32.0) * M_PI / 32.0 * M_PI / 32.0;
  }
  EXPECT_NEAR(light, sun.irradiance.g, 1e-5 * light);
  EXPECT_GT(lookUp(map, sun.direction).g, 0.0);
}

TEST(SunPlace, IsThePublishedOne) {
  // Reda and Andreas, Solar Position Algorithm (2004), table A5.1.
  const SunPlace colorado = sunPlaceAt(*daysOf("2003-10-17T12:30:30-07:00"), {39.742476, -105.1786});
  EXPECT_NEAR(colorado.elevation, 90.0 - 50.11162, 0.01);
  EXPECT_NEAR(colorado.azimuth, 194.34024, 0.01);
  // Meeus, Astronomical Algorithms, example 25.a: a declination of -7.78507 degrees; air adds 0.111 at the
  // pole.
  const double days = *daysOf("1992-10-13T00:00Z");
  EXPECT_NEAR(sunPlaceAt(days, {-90.0, 0.0}).elevation, 7.78507 + 0.111, 0.01);
  // Example 28.a: the equation of time is 13 m 42.6 s.
  EXPECT_NEAR(sunPlaceAt(days, {45.0, (720.0 - 13.71) / 4.0}).azimuth, 180.0, 0.01);
  EXPECT_NEAR(std::remainder(sunPlaceAt(days, {-45.0, (720.0 - 13.71) / 4.0}).azimuth, 360.0), 0.0, 0.01);
}

TEST(SunPlace, ReadsTimesWithTheirOffset) {
  EXPECT_DOUBLE_EQ(*daysOf("2000-01-01T12:00Z"), 0.0);
  EXPECT_DOUBLE_EQ(*daysOf("2000-01-01T14:30:00+02:30"), 0.0);
  EXPECT_DOUBLE_EQ(*daysOf("2000-01-01T07:00:00.0-0500"), 0.0);
  EXPECT_DOUBLE_EQ(*daysOf("2024-02-29T00:00:00+00"), 8824.5);
  for (const char* text : {"", "2026-06-21", "2026-06-21T12:00", "2026-02-29T12:00Z", "2026-06-21T24:00Z",
                           "2026-13-01T12:00Z", "2026-06-21T12:00+2", "12:00Z", "2026-06-21T12:60Z"})
    EXPECT_FALSE(daysOf(text)) << text;
}

}  // namespace
}  // namespace fragtrace
