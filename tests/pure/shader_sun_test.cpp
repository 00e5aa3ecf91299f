// SPDX-License-Identifier: MIT
// shaders/sky/sun.glsl before a map, as src/pack packs both: what is seen, and how directions are drawn.
#include <gtest/gtest.h>

#include <cmath>

#include "glsl_lights.h"
#include "pack/pack_environment.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::uvec2;
using glm::vec3;
using glsl_variant::With;

constexpr int kWidth = 32;
constexpr int kHeight = 16;
constexpr double kTurn = 0.7;

Image unevenMap() {
  Image image{kWidth, kHeight, {"R", "G", "B"}, {}, {}};
  Draw draw(211);
  for (int i = 0; i < kWidth * kHeight * 3; ++i) image.values.push_back(float(draw.between(0.2, 1.8)));
  return image;
}

SunDisc sunAt(double elevation) {
  const double e = glm::radians(elevation);
  SunDisc sun;
  sun.direction = {0.0, std::sin(e), -std::cos(e)};
  sun.irradiance = {3.0, 2.5, 2.0};
  const double radius = layout::kSunRadius;
  sun.radiance = sun.irradiance * (1.0 + 0.5 * kLimbPowers) / (M_PI * radius * radius);
  return sun;
}

/// The sky as the shader reads it, until the end of the scope.
class Sky {
 public:
  explicit Sky(const SunDisc& sun, EnvironmentDraws draws = EnvironmentDraws::Light)
      : packed_(packEnvironment(unevenMap(), draws, powerOf(sun))),
        texels_(glsl_variant::environment, withSun(sun)),
        inversion_(glsl_variant::environmentInversion, packed_.inversion),
        frame_(glsl_variant::frame, frameOf()),
        sun_(glsl_variant::kSun, true) {}

 private:
  std::span<const uint32_t> withSun(const SunDisc& sun) {
    appendSuns({Surroundings::Map, {}, {}, sun}, packed_.drawnPower, packed_.texels);
    return packed_.texels;
  }
  static layout::Frame frameOf() {
    layout::Frame frame{};
    frame.environmentScale = 0.5f;
    frame.environmentSize = {kWidth, kHeight};
    frame.environmentRotation = {std::cos(kTurn), std::sin(kTurn)};
    return frame;
  }

  PackedEnvironment packed_;
  With<std::span<const uint32_t>> texels_;
  With<std::span<const uint32_t>> inversion_;
  With<layout::Frame> frame_;
  With<bool> sun_;
};

dvec3 turned(const dvec3& d) {
  const double c = std::cos(kTurn);
  const double s = std::sin(kTurn);
  return {d.x * c + d.z * s, d.y, -d.x * s + d.z * c};
}

/// A direction so far from the middle of the disc, in its radii.
dvec3 besideSun(const SunDisc& sun, double radii, double turn) {
  const dvec3 middle = turned(sun.direction);
  const dvec3 across = glm::normalize(glm::cross(middle, dvec3(0.3, 0.1, 0.9)));
  const dvec3 off = across * std::cos(turn) + glm::cross(middle, across) * std::sin(turn);
  return glm::normalize(middle + off * (radii * double(layout::kSunRadius)));
}

dvec3 seen(const dvec3& direction) { return dvec3(glsl_double::environmentAlong(direction)); }

dvec3 mapAlone(const dvec3& direction) {
  const With<bool> none(glsl_variant::kSun, false);
  return seen(direction);
}

TEST(ShaderSun, IsADiscThatIsDarkerAtItsLimb) {
  const SunDisc sun = sunAt(40.0);
  const Sky here(sun);
  for (const double radii : {0.0, 0.5, 0.9}) {
    const dvec3 d = besideSun(sun, radii, 1.0);
    const dvec3 light = seen(d) - mapAlone(d);
    for (int c = 0; c < 3; ++c) {
      const double limb = std::pow(std::sqrt(1.0 - radii * radii), kLimbPowers[c]);
      EXPECT_NEAR(light[c], 0.5 * sun.radiance[c] * limb, 1e-3 * light[c]) << radii;
    }
  }
  const dvec3 beside = besideSun(sun, 1.001, 2.0);
  EXPECT_EQ(seen(beside), mapAlone(beside));
  const SunDisc low = sunAt(0.1);
  const Sky dusk(low);
  const dvec3 below =
      glm::normalize(turned(low.direction) - dvec3(0.0, 0.5 * double(layout::kSunRadius), 0.0));
  EXPECT_LT(below.y, 0.0);
  EXPECT_EQ(seen(below), mapAlone(below));
}

TEST(ShaderSun, DensityIsOneInAll) {
  const SunDisc sun = sunAt(40.0);
  const Sky here(sun);
  const auto pdf = [](const dvec3& d) {
    return double(glsl_double::environmentPdf(glsl_double::environmentAlong(d), d));
  };
  constexpr int kRings = 400;
  const double radius = layout::kSunRadius;
  double onDisc = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double r = (i + 0.5) / kRings;
    const dvec3 d = besideSun(sun, r, 2.4 * i);
    onDisc += pdf(d) * 2.0 * M_PI * r * radius * radius / kRings;
  }
  const double chance = glsl_double::sunOfSky().chance;
  EXPECT_GT(chance, 0.1);
  EXPECT_NEAR(onDisc, chance, 1e-3);
  const dvec3 beside = besideSun(sun, 1.5, 0.0);
  {
    const Sky bright(sun, EnvironmentDraws::LightAndPaths);
    EXPECT_GT(glsl_double::sunOfSky().chance,
              3.0 * chance);  // the map counts where it is brighter than the mean
  }
  const double withSun = pdf(beside);
  const With<bool> none(glsl_variant::kSun, false);
  EXPECT_NEAR(withSun, (1.0 - chance) * pdf(beside), 1e-6 * withSun);
}

TEST(ShaderSun, SampledIrradianceIsThatOfSunAndMap) {
  const SunDisc sun = sunAt(40.0);
  const Sky here(sun);
  const dvec3 exact =
      0.5 * (dvec3(upwardIrradiance(unevenMap())) + sun.irradiance * std::sin(glm::radians(40.0)));
  constexpr uint32_t kSamples = 1 << 16;
  dvec3 sum(0.0);
  double inSun = 0.0;
  for (uint32_t k = 0; k < kSamples; ++k) {
    const auto sampler = glsl_float::makeSampler(glsl_float::mixBits(7u), k);
    const auto s = glsl_float::skyLight(1.0f, glsl_float::drawPairBits(sampler, 0u));
    sum += dvec3(s.irradiance) * std::max(0.0, double(s.direction.y)) / double(kSamples);
    const double away = glm::distance(dvec3(s.direction), turned(sun.direction));
    inSun += away < double(layout::kSunRadius) ? 1.0 / kSamples : 0.0;
  }
  EXPECT_NEAR(inSun, glsl_double::sunOfSky().chance, 1e-3);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], exact[c], 0.005 * exact[c]);
}

TEST(ShaderSun, BitsBeyondItsChanceDrawTheWholeMap) {
  const Sky here(sunAt(40.0));
  const double border = double(glsl_float::sunOfSky().chance) * 4294967040.0;
  for (const double share : {0.001, 0.25, 0.5, 0.75, 0.98, 0.999}) {
    for (const uint32_t row : {0x20000000u, 0xd0000000u}) {
      const auto first = uint32_t(border + share * (4294967040.0 - border));
      const auto place = glsl_float::sampleEnvironment(uvec2(uint32_t(share * 4294967040.0), row));
      const dvec3 expected(glsl_float::environmentDirection(place / glm::vec2(kWidth, kHeight)));
      EXPECT_LT(glm::distance(dvec3(glsl_float::sampleSky(uvec2(first, row))), expected), 1e-3) << share;
    }
  }
}

TEST(ShaderSun, DirectionsToItFollowItsLight) {
  const SunDisc sun = sunAt(40.0);
  const Sky here(sun);
  constexpr int kSamples = 1 << 14;
  const auto disc = glsl_double::sunOfSky();
  double mean = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    const dvec3 d = glsl_double::sampleSun(disc, (k + 0.5) / kSamples, std::fmod(0.618 * k, 1.0));
    const double radii = glm::distance(d, turned(sun.direction)) / double(layout::kSunRadius);
    ASSERT_LE(radii, 1.0);
    mean += radii * radii / kSamples;
  }
  // The density is (1 - r^2)^(p / 2).
  EXPECT_NEAR(mean, 2.0 / (4.0 + kLimbPowers.g), 1e-3);
}

TEST(ShaderSun, OneThatHasSetIsNeitherSeenNorDrawn) {
  SunDisc sun = sunAt(-3.0);
  sun.irradiance = sun.radiance = dvec3(0.0);
  const Sky here(sun);
  EXPECT_EQ(glsl_double::sunOfSky().chance, 0.0);
  Draw draw(17);
  for (int k = 0; k < 1000; ++k) {
    const uint32_t first = draw.engine();
    const auto s = glsl_float::skyLight(1.0f, uvec2(first, draw.engine()));
    EXPECT_TRUE(std::isfinite(s.pdf) && std::isfinite(s.irradiance.x));
  }
}

}  // namespace
}  // namespace fragtrace
