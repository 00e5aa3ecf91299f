// SPDX-License-Identifier: MIT
// shaders/caustics: light paths towards every caster have the pdf that is reported for them, and no rounding
// error weighs them.
#include <gtest/gtest.h>

#include "glsl_lights.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec2;
using glm::dvec3;
using glsl_variant::With;

constexpr int kSamples = 1 << 19;

/// Small and large ones, two of which overlap as seen from the origin; the last one lies behind the plane z =
/// 0, the one before it reaches through.
const std::vector<glm::vec4> kCasters{{1.0f, 0.5f, 2.0f, 0.6f},
                                      {0.5f, 1.5f, 3.0f, 1.1f},
                                      {-4.0f, 1.0f, 0.3f, 0.8f},
                                      {0.5f, -2.0f, -3.0f, 0.7f}};

double spreadOf(const glm::vec4& ball) {
  const double part = ball.w / glm::length(dvec3(ball));
  return 1.0 - std::sqrt(1.0 - part * part);
}

/// Returns the pdf of a direction from the origin by its definition: the number of cones that hold it, over
/// the sum of all solid angles.
double pdfTowards(const dvec3& direction, size_t count) {
  double sum = 0.0;
  double holding = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const double spread = spreadOf(kCasters[i]);
    sum += spread;
    holding += glm::dot(direction, glm::normalize(dvec3(kCasters[i]))) >= 1.0 - spread ? 1.0 : 0.0;
  }
  return holding / (2.0 * M_PI * sum);
}

/// Returns the pdf of a place across parallel rays.
double pdfAcross(const dvec3& place, const dvec3& along) {
  double sum = 0.0;
  double holding = 0.0;
  for (const glm::vec4& ball : kCasters) {
    const dvec3 apart = place - dvec3(ball);
    const double radius = ball.w;
    sum += radius * radius;
    holding += glm::length(apart - glm::dot(apart, along) * along) <= radius ? 1.0 : 0.0;
  }
  return holding / (M_PI * sum);
}

/// Cells of a square from (0, 0) to (1, 1): how many of `draw`'s places are in each, against the integral of
/// a density. Returns the chance of what is seen.
template <typename Draws, typename Density>
double chanceOf(const Draws& draws, const Density& pdf, double area) {
  constexpr int kCells = 24;
  constexpr int kParts = 48;
  std::vector<double> counted(kCells * kCells);
  std::vector<double> expected(counted.size());
  for (int k = 0; k < kSamples; ++k) {
    const dvec2 place = draws();
    const auto x = size_t(glm::clamp(place.x, 0.0, 1.0 - 1e-9) * kCells);
    ++counted[size_t(glm::clamp(place.y, 0.0, 1.0 - 1e-9) * kCells) * kCells + x];
  }
  constexpr double kSide = kCells * kParts;
  for (int y = 0; y < kCells * kParts; ++y) {
    for (int x = 0; x < kCells * kParts; ++x)
      expected[size_t(y / kParts) * kCells + size_t(x / kParts)] +=
          kSamples * pdf(dvec2(x + 0.5, y + 0.5) / kSide) * area / (kSide * kSide);
  }
  return chiSquareChance(expected, counted);
}

TEST(ShaderLightPaths, AreAimedAtCastersAsDenselyAsTheyTell) {
  const With casters(glsl_variant::casters, kCasters);
  const With count(glsl_variant::casterCount, int(kCasters.size()));
  for (const bool oneSided : {false, true}) {
    Draw draw(oneSided ? 971 : 977);
    const dvec3 normal(0.0, 0.0, oneSided ? 1.0 : 0.0);
    const size_t seen = oneSided ? kCasters.size() - 1 : kCasters.size();
    int wrong = 0;
    const auto draws = [&] {
      const float choice = draw.unit();
      const dvec2 uv(draw.unit(), draw.unit());
      const auto a = glsl_double::aimFrom(dvec3(0.0), normal, choice, uv);
      // At a cone's very edge rounding tells which side.
      wrong += std::abs(a.pdf / pdfTowards(a.direction, seen) - 1.0) > 1e-6 ? 1 : 0;
      return dvec2(std::atan2(a.direction.y, a.direction.x) / (2.0 * M_PI) + 0.5, 0.5 * a.direction.z + 0.5);
    };
    const auto pdf = [&](const dvec2& place) {
      const double z = 2.0 * place.y - 1.0;
      const double phi = 2.0 * M_PI * (place.x - 0.5);
      const double r = std::sqrt(1.0 - z * z);
      return pdfTowards({r * std::cos(phi), r * std::sin(phi), z}, seen);
    };
    EXPECT_GT(chanceOf(draws, pdf, 4.0 * M_PI), kSignificance / 3.0) << oneSided;
    EXPECT_LE(wrong, kSamples / 10000) << oneSided;
  }
}

TEST(ShaderLightPaths, OfTheSunCrossDisksAsDenselyAsTheyTell) {
  const With casters(glsl_variant::casters, kCasters);
  const With count(glsl_variant::casterCount, int(kCasters.size()));
  constexpr double kHalf = 6.0;
  const dvec3 along = glm::normalize(dvec3(0.3, -0.2, -0.9));
  const dvec3 right = glm::normalize(glm::cross(along, dvec3(0.0, 1.0, 0.0)));
  const dvec3 up = glm::cross(right, along);
  Draw draw(983);
  int wrong = 0;
  const auto draws = [&] {
    const float choice = draw.unit();
    const dvec2 uv(draw.unit(), draw.unit());
    const auto a = glsl_double::aimAlong(along, choice, uv);
    EXPECT_EQ(a.direction, along);
    wrong += std::abs(a.pdf / pdfAcross(a.origin, along) - 1.0) > 1e-6 ? 1 : 0;
    return dvec2(glm::dot(a.origin, right), glm::dot(a.origin, up)) / (2.0 * kHalf) + 0.5;
  };
  const auto pdf = [&](const dvec2& place) {
    const dvec2 p = (2.0 * place - 1.0) * kHalf;
    return pdfAcross(p.x * right + p.y * up, along);
  };
  EXPECT_GT(chanceOf(draws, pdf, 4.0 * kHalf * kHalf), kSignificance / 3.0);
  EXPECT_LE(wrong, kSamples / 10000);
}

TEST(ShaderLightPaths, ShadingNormalsWeighFluxAsVeachSays) {
  EXPECT_DOUBLE_EQ(glsl_double::fluxFactor({0.5, 0.6}, {-0.3, 0.2}), (0.6 / 0.5) * (0.3 / 0.2));
  EXPECT_EQ(glsl_float::fluxFactor({0.3f, 0.3f}, {-0.7f, -0.7f}), 1.0f);
}

TEST(ShaderLightPaths, RoundingErrorsOfFlatRaysWeighNothing) {
  // These cosines were seen at the edge of a sphere; they made a dot 7,000 times too bright.
  EXPECT_EQ(glsl_float::fluxFactor({1e-9f, 3e-6f}, {2e-7f, 9e-8f}), 1.0f);
}

}  // namespace
}  // namespace fragtrace
