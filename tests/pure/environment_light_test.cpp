// SPDX-License-Identifier: MIT
// The light of the environment in the stages before global illumination:
// shaders/lights/environment_light.glsl over rows of src/pack/pack_environment.cpp.
#include "pack/pack_environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "glsl_lights.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec2;
using glm::dvec3;
using glsl_double::environmentIrradiance;
using glsl_double::environmentLobe;
using glsl_double::environmentReflected;
using glsl_double::phongAlbedo;
using glsl_variant::With;

constexpr double kPi = M_PI;
constexpr double kMirrorExponent = 1998.0;  // exponent of the smoothest surface

using Radiance = std::function<dvec3(const dvec3&)>;

/// A map of a radiance at the middles of its texels.
Image mapOf(const Radiance& radiance, int height) {
  Image image{2 * height, height, {"R", "G", "B"}, {}, {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double around = ((x + 0.5) / image.width - 0.5) * 2.0 * kPi;
      const double down = (y + 0.5) / image.height * kPi;
      const dvec3 value =
          radiance({std::sin(down) * std::cos(around), std::cos(down), std::sin(down) * std::sin(around)});
      for (int c = 0; c < 3; ++c) image.values.push_back(float(value[c]));
    }
  }
  return image;
}

Image evenMap(int width, int height) {
  return {width, height, {"R", "G", "B"}, std::vector<float>(size_t(width) * size_t(height) * 3, 1.0f), {}};
}

/// The map as the shader of a stage before gi reads it, until the end of the scope.
class LitBy {
 public:
  explicit LitBy(const Image& image, double rotation = 0.0, float intensity = 1.0f)
      : words_(wordsOf(image)),
        rows_(glsl_variant::environment, words_),
        frame_(glsl_variant::frame, frameOf(image, rotation, intensity)) {}

 private:
  static Words wordsOf(const Image& image) {
    Words words = packEnvironment(image, EnvironmentDraws::Nothing).texels;
    appendEnvironmentLight(image, words);
    return words;
  }
  static layout::Frame frameOf(const Image& image, double rotation, float intensity) {
    layout::Frame frame{};
    frame.environmentScale = intensity;
    frame.environmentSize = {image.width, image.height};
    frame.environmentRotation = {std::cos(rotation), std::sin(rotation)};
    return frame;
  }

  Words words_;
  With<std::span<const uint32_t>> rows_;
  With<layout::Frame> frame_;
};

dvec3 linear(const dvec3& d) { return {1.0 + d.z, 1.0 + 0.5 * d.x, 1.0 - d.y}; }

/// Radiance 1e4 within half a degree of a direction, on a dim ground.
Radiance sunAlong(const dvec3& sun) {
  return [sun](const dvec3& d) { return dvec3(glm::dot(d, sun) > std::cos(0.5 * kPi / 180.0) ? 1e4 : 0.0); };
}

std::vector<dvec3> someDirections(int count) {
  Draw draw(19);
  std::vector<dvec3> directions{{0, 1, 0}, {0, -1, 0}, {-1, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  while (int(directions.size()) < count) {
    const dvec3 d = draw.directionAbove();
    directions.push_back(draw.between(0.0, 1.0) < 0.5 ? d : -d);
  }
  return directions;
}

void expectNear(const dvec3& a, const dvec3& b, double tolerance) {
  EXPECT_LE(glm::length(a - b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << ", not " << b.x << ' ' << b.y << ' ' << b.z;
}

/// Light of a radiance that a surface with the normal +z reflects, summed over directions.
dvec3 reflectedBySums(const Radiance& radiance, const dvec3& diffuse, const dvec3& f0, double exponent,
                      const dvec3& wo) {
  constexpr int kSteps = 700;
  dvec3 sum(0.0);
  for (int i = 0; i < kSteps; ++i) {
    const double z = (i + 0.5) / kSteps;
    for (int j = 0; j < 2 * kSteps; ++j) {
      const double around = (j + 0.5) * kPi / kSteps;
      const double sine = std::sqrt(1.0 - z * z);
      const dvec3 d(sine * std::cos(around), sine * std::sin(around), z);
      sum += radiance(d) * glsl_double::phongValue(diffuse, f0, exponent, dvec3(0, 0, 1), wo, d);
    }
  }
  return sum * (kPi / kSteps / kSteps);
}

TEST(EnvironmentLight, EvenLightGivesALambertSurfaceItsColour) {
  const dvec3 albedo(0.8, 0.5, 0.1);
  for (const Image& image : {evenMap(1, 1), evenMap(64, 32), evenMap(5, 3), evenMap(600, 300)}) {
    const LitBy lit(image);
    for (const dvec3& n : someDirections(20)) {
      expectNear(environmentIrradiance(n), dvec3(kPi), 1e-6);
      expectNear(environmentReflected(albedo, dvec3(0), 30.0, n, n), albedo, 1e-6);
      for (const double exponent : {0.0, 3.0, 100.0, kMirrorExponent})
        expectNear(environmentLobe(n, exponent), dvec3(1.0), 1e-6);
    }
  }
}

TEST(EnvironmentLight, LinearLightHasTheIrradianceOfItsClosedForm) {
  const LitBy lit(mapOf(linear, 256));
  for (const dvec3& n : someDirections(50))
    expectNear(environmentIrradiance(n), kPi * (1.0 + 2.0 / 3.0 * (linear(n) - 1.0)), 1e-3);
}

TEST(EnvironmentLight, EachHarmonicIsDampedByItsBand) {
  const Radiance quadratic = [](const dvec3& d) {
    return dvec3(1.0 + d.x * d.y + d.y * d.z, 1.0 + d.z * d.x + d.x * d.x - d.z * d.z,
                 4.0 + 3.0 * d.y * d.y - 1.0);
  };
  const LitBy lit(mapOf(quadratic, 256));
  const dvec3 mean(1.0, 1.0, 4.0);
  for (const dvec3& n : someDirections(50))
    expectNear(environmentIrradiance(n), kPi * mean + 0.25 * kPi * (quadratic(n) - mean), 2e-3);
}

TEST(EnvironmentLight, TurnsWithTheMapAndFollowsItsIntensity) {
  const double turn = 2.0 * kPi / 9.0;
  const LitBy lit(mapOf(linear, 128), turn, 3.0f);
  for (const dvec3& n : someDirections(20)) {
    // Counter-clockwise seen from +y.
    const dvec3 before(n.x * std::cos(turn) - n.z * std::sin(turn), n.y,
                       n.x * std::sin(turn) + n.z * std::cos(turn));
    expectNear(environmentIrradiance(n), 3.0 * kPi * (1.0 + 2.0 / 3.0 * (linear(before) - 1.0)), 0.01);
    expectNear(environmentLobe(n, kMirrorExponent), 3.0 * linear(before), 0.01);
  }
}

TEST(EnvironmentLight, WidestLobeIsACosineAndTheNarrowestNearlyAMirror) {
  const LitBy lit(mapOf(linear, 256));
  for (const dvec3& d : someDirections(50)) {
    expectNear(environmentLobe(d, 0.0), 1.0 + 2.0 / 3.0 * (linear(d) - 1.0), 5e-3);
    expectNear(environmentLobe(d, kMirrorExponent), linear(d), 5e-3);
  }
}

TEST(EnvironmentLight, LevelsLieAtTheirExponents) {
  // The mean cosine of cos(a / 2)^n cos a by numerical integration.
  const LitBy lit(mapOf(linear, 256));
  for (int level = 0; level < int(layout::kLobeLevels) - 1; ++level) {
    const double exponent = exponentOfLevel(level);
    double all = 0.0;
    double along = 0.0;
    for (int i = 0; i < 100000; ++i) {
      const double cosine = (i + 0.5) / 100000;
      const double weight = std::pow(0.5 + 0.5 * cosine, 0.5 * exponent) * cosine;
      all += weight;
      along += weight * cosine;
    }
    for (const dvec3& d : someDirections(20))
      expectNear(environmentLobe(d, exponent), 1.0 + along / all * (linear(d) - 1.0), 5e-3);
  }
}

TEST(EnvironmentLight, SunHasNoNegativeIrradiance) {
  const dvec3 sun = glm::normalize(dvec3(0.3, 0.8, -0.5));
  const Image image = mapOf(sunAlong(sun), 512);
  const LitBy lit(image);
  double power = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      power += double(image.pixel(x, y)[0]) * std::sin((y + 0.5) / image.height * kPi) * 2.0 * kPi * kPi /
               image.width / image.height;
  }
  // Nine harmonics of a cosine give 17 / 16 at its middle; texels that make others keep the power within 1 %.
  EXPECT_NEAR(environmentIrradiance(sun).x, 17.0 / 16.0 * power, 0.01 * power);
  for (const dvec3& n : someDirections(2000)) {
    EXPECT_GE(environmentIrradiance(n).x, 0.0);
    EXPECT_NEAR(environmentIrradiance(n).x, power * std::max(0.0, glm::dot(n, sun)), 0.11 * power);
  }
}

TEST(EnvironmentLight, LobesOfASunAreRoundAtThePolesAndTheSeam) {
  for (const dvec3& sun : {dvec3(0, 1, 0), glm::normalize(dvec3(0.02, 1, 0.01)), dvec3(-1, 0, 0),
                           glm::normalize(dvec3(1, 1, 1))}) {
    const LitBy lit(mapOf(sunAlong(sun), 512));
    const dvec3 across = glm::normalize(glm::cross(sun, dvec3(0.3, -0.1, 0.7)));
    const dvec3 other = glm::cross(sun, across);
    for (const double exponent : {0.0, 30.0, 510.0, kMirrorExponent}) {
      const double peak = environmentLobe(sun, exponent).x;
      for (const double angle : {0.5, 1.0, 2.0, 3.0}) {
        double low = peak;
        double high = 0.0;
        const double away = angle / std::sqrt(exponent + 2.0);
        for (int i = 0; i < 72; ++i) {
          const double around = i * kPi / 36.0;
          const dvec3 d =
              std::cos(away) * sun + std::sin(away) * (std::cos(around) * across + std::sin(around) * other);
          const double value = environmentLobe(d, exponent).x;
          low = std::min(low, value);
          high = std::max(high, value);
        }
        EXPECT_LE(high - low, 0.1 * peak) << exponent << ' ' << angle << ' ' << sun.x << ' ' << sun.y;
      }
    }
  }
}

TEST(EnvironmentLight, AlbedoOfHighlightsIsThatOfSums) {
  const Radiance white = [](const dvec3&) { return dvec3(1.0); };
  for (const double exponent : {0.0, 1.0, 6.0, 20.0, 126.0}) {
    for (const double degrees : {0.0, 30.0, 60.0, 80.0, 88.0}) {
      const dvec3 wo(std::sin(degrees * kPi / 180.0), 0.0, std::cos(degrees * kPi / 180.0));
      const double expected = reflectedBySums(white, dvec3(0), dvec3(1), exponent, wo).x;
      EXPECT_NEAR(phongAlbedo(exponent, wo.z), expected, degrees == 0.0 ? 1e-3 : 0.008)
          << exponent << ' ' << degrees;
    }
  }
  EXPECT_NEAR(phongAlbedo(kMirrorExponent, 0.5), 0.25, 0.002);  // for mirrors it is the squared cosine
}

TEST(EnvironmentLight, ReflectsNearlyWhatSumsReflect) {
  const dvec3 diffuse(0.5, 0.2, 0.0);
  const dvec3 f0(0.04, 0.5, 1.0);
  const LitBy lit(mapOf(linear, 256));
  for (const double exponent : {0.0, 2.0, 14.0, 126.0}) {
    for (const double degrees : {0.0, 40.0, 70.0}) {
      const dvec3 wo(std::sin(degrees * kPi / 180.0), 0.0, std::cos(degrees * kPi / 180.0));
      const dvec3 expected = reflectedBySums(linear, diffuse, f0, exponent, wo);
      expectNear(environmentReflected(diffuse, f0, exponent, dvec3(0, 0, 1), wo), expected, 0.02);
    }
  }
}

}  // namespace
}  // namespace fragtrace
