// SPDX-License-Identifier: MIT
// shaders/media/: what is drawn in float against its densities, and closed forms against numerical
// integration.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "glsl_media.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr int kSamples = 1 << 18;
constexpr int kTests = 20;  // chi-square tests in this file
constexpr double kLeastChance = kSignificance / kTests;
const double kFar = glsl_double::kFarAway;

/// Chance of a cosine of at most c, by Henyey and Greenstein's phase function.
double phaseBelow(double g, double c) {
  if (std::abs(g) < 1e-6) return 0.5 * (1.0 + c);
  return (1.0 - g * g) / (2.0 * g) * (1.0 / std::sqrt(1.0 + g * g - 2.0 * g * c) - 1.0 / (1.0 + g));
}

TEST(ShaderPhase, DrawsTheCosinesOfItsDensity) {
  constexpr size_t kBins = 64;
  for (const float g : {-0.95f, -0.8f, -0.3f, 0.0f, 1e-4f, 0.3f, 0.7f, 0.9f, 0.95f}) {
    Draw draw(1);
    std::vector<double> counted(kBins, 0.0);
    std::vector<double> expected(kBins);
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const double c = double(glsl_float::samplePhaseCosine(g, draw.unit()));
      counted[std::min(kBins - 1, size_t((0.5 + 0.5 * c) * kBins))] += 1.0;
      sum += c;
    }
    for (size_t i = 0; i < kBins; ++i) {
      const double low = 2.0 * double(i) / kBins - 1.0;
      expected[i] = kSamples * (phaseBelow(double(g), low + 2.0 / kBins) - phaseBelow(double(g), low));
    }
    EXPECT_GE(chiSquareChance(expected, counted), kLeastChance) << "g = " << g;
    EXPECT_NEAR(sum / kSamples, double(g), 0.006) << "g = " << g;
  }
}

TEST(ShaderPhase, DensityIsOneOverAllDirections) {
  for (const double g : {-0.9, -0.2, 0.0, 0.5, 0.95}) {
    constexpr int kSteps = 200000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
      sum += glsl_double::phasePdf(g, 2.0 * (i + 0.5) / kSteps - 1.0) * 2.0 * M_PI * 2.0 / kSteps;
    EXPECT_NEAR(sum, 1.0, 1e-5) << "g = " << g;
  }
}

TEST(ShaderPhase, TurnsTheDirectionByTheCosine) {
  Draw draw(2);
  for (int i = 0; i < 1000; ++i) {
    const dvec3 before = draw.direction();
    const double u = draw.between(0.0, 1.0);
    const dvec3 after = glsl_double::samplePhase(0.6, before, u, draw.between(0.0, 1.0));
    EXPECT_NEAR(glm::dot(before, after), glsl_double::samplePhaseCosine(0.6, u), 1e-12);
    EXPECT_NEAR(glm::length(after), 1.0, 1e-7);
  }
}

TEST(ShaderFlight, DistancesHaveTheDensityOfTheThreeChannels) {
  constexpr size_t kBins = 50;
  constexpr double kLongest = 2.0;
  const vec3 extinction(0.5f, 2.0f, 9.0f);
  const glsl_float::Medium medium{extinction, vec3(0.9f, 0.5f, 0.2f), 0.0f};
  const vec3 chances = glsl_float::channelChances(vec3(0.6f, 0.3f, 0.3f));
  Draw draw(3);
  std::vector<double> counted(kBins + 1, 0.0);
  std::vector<double> expected(kBins + 1, 0.0);
  for (int i = 0; i < kSamples; ++i) {
    const double t = double(glsl_float::flightDistance(medium, chances, draw.unit()));
    counted[std::min(kBins, size_t(t / kLongest * kBins))] += 1.0;
  }
  for (int c = 0; c < 3; ++c) {
    const double s = double(extinction[c]);
    for (size_t i = 0; i <= kBins; ++i) {
      const double low = std::exp(-s * kLongest * double(i) / kBins);
      const double high = i == kBins ? 0.0 : std::exp(-s * kLongest * double(i + 1) / kBins);
      expected[i] += kSamples * double(chances[c]) * (low - high);
    }
  }
  EXPECT_GE(chiSquareChance(expected, counted), kLeastChance);
}

TEST(ShaderFlight, WeightsTimesTheirChancesAreTransmittanceAndScattering) {
  Draw draw(4);
  for (int i = 0; i < 1000; ++i) {
    const dvec3 extinction(draw.between(0.0, 9.0), draw.between(0.1, 3.0), draw.between(0.0, 60.0));
    const dvec3 albedo(draw.between(0.1, 1.0), draw.between(0.0, 1.0), draw.between(0.0, 1.0));
    const glsl_double::Medium medium{extinction, albedo, 0.0};
    const dvec3 chances = glsl_double::channelChances(
        {draw.between(0.1, 1.0), draw.between(0.0, 1.0), i % 3 == 0 ? 0.0 : draw.between(0.0, 1.0)});
    const double t = draw.between(0.0, 5.0);
    const dvec3 through = glm::exp(-t * extinction);
    const double pass = glm::dot(chances, through);
    const double density = glm::dot(chances, extinction * through);
    const dvec3 passed = glsl_double::passWeight(medium, chances, t) * pass;
    const dvec3 scattered = glsl_double::scatterWeight(medium, chances, t) * density;
    for (int c = 0; c < 3; ++c) {
      if (chances[c] <= 0.0) continue;  // no light there
      EXPECT_NEAR(passed[c], through[c], 1e-12);
      EXPECT_NEAR(scattered[c], albedo[c] * extinction[c] * through[c], 1e-10);
    }
  }
}

TEST(ShaderFlight, WeightsStayFiniteInDenseMedia) {
  const glsl_float::Medium medium{vec3(1e4f, 3e4f, 0.0f), vec3(1.0f), 0.0f};
  for (const vec3& chances : {vec3(1.0f, 0.0f, 0.0f), vec3(0.5f, 0.5f, 0.0f), vec3(0.3f, 0.3f, 0.4f)}) {
    for (const float t : {0.0f, 1e-6f, 1e-3f, 1.0f, 1e6f}) {
      EXPECT_TRUE(std::isfinite(glm::dot(glsl_float::passWeight(medium, chances, t), vec3(1.0f)))) << t;
      EXPECT_TRUE(std::isfinite(glm::dot(glsl_float::scatterWeight(medium, chances, t), vec3(1.0f)))) << t;
    }
  }
}

TEST(ShaderFlight, AbsorptionAloneIsNoMatterOfChance) {
  const glsl_double::Medium medium{{1.0, 2.0, 0.5}, dvec3(0.0), 0.0};
  const dvec3 weight = glsl_double::passWeight(medium, dvec3(1.0 / 3.0), 2.0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(weight[c], std::exp(-2.0 * medium.extinction[c]), 1e-15);
}

/// A fog, and a ray that has a good chance to meet it; origin may be inside.
struct FogCase {
  layout::Fog fog;
  dvec3 origin;
  dvec3 direction;
};

FogCase fogCase(Draw& draw, int i) {
  const glm::vec4 ball(glm::vec3(draw.inCube(1.0)), float(draw.between(0.5, 3.0)));
  const float inverseHeight = i % 3 == 0 ? 0.0f : float(std::exp(draw.between(-5.0, 3.0)));
  const float base = ball.y + float(draw.between(-2.0, 2.0));
  const layout::Fog fog{ball, glm::vec4(1.0f), {float(draw.between(0.01, 3.0)), inverseHeight, base, 0.0f}};
  const dvec3 aimed = dvec3(glm::vec3(ball)) + draw.direction() * double(ball.w) * draw.between(0.0, 1.0);
  const dvec3 origin = dvec3(glm::vec3(ball)) + draw.direction() * double(ball.w) * draw.between(0.0, 2.0);
  dvec3 direction = glm::normalize(aimed - origin);
  if (i % 5 == 0) direction = glm::normalize(dvec3(direction.x, direction.y * 1e-4, direction.z));
  return {fog, origin, direction};
}

double fogDensityAt(const layout::Fog& fog, const dvec3& point) {
  if (glm::distance(point, dvec3(glm::vec3(fog.ball))) > double(fog.ball.w)) return 0.0;
  const double height = std::max(0.0, point.y - double(fog.density.z));
  return double(fog.density.x) * std::exp(-height * double(fog.density.y));
}

TEST(ShaderFog, DepthIsTheIntegralOfTheDensity) {
  Draw draw(5);
  for (int i = 0; i < 300; ++i) {
    const FogCase c = fogCase(draw, i);
    const double from = draw.between(0.0, 2.0);
    const double to = from + draw.between(0.0, 6.0);
    constexpr int kSteps = 20000;
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double t = from + (to - from) * (k + 0.5) / kSteps;
      sum += fogDensityAt(c.fog, c.origin + t * c.direction) * (to - from) / kSteps;
    }
    const double depth = glsl_double::fogDepth(c.fog, c.origin, c.direction, from, to);
    EXPECT_NEAR(depth, sum, 2e-3) << i;
    const float single =
        glsl_float::fogDepth(c.fog, vec3(c.origin), vec3(c.direction), float(from), float(to));
    EXPECT_NEAR(double(single), depth, 1e-4 * (1.0 + depth)) << i;
  }
}

TEST(ShaderFog, FlightsEndAtTheDepthThatTheirNumberDraws) {
  Draw draw(6);
  int ended = 0;
  for (int i = 0; i < 3000; ++i) {
    const FogCase c = fogCase(draw, i);
    const double from = draw.between(0.0, 1.0);
    const double u = draw.between(0.0, 1.0);
    const double t = glsl_double::fogFlight(c.fog, c.origin, c.direction, from, u);
    const double wanted = -std::log(1.0 - u);
    if (t >= kFar) {
      EXPECT_LE(glsl_double::fogDepth(c.fog, c.origin, c.direction, from, 1e3), wanted * (1.0 + 1e-6)) << i;
      continue;
    }
    ++ended;
    EXPECT_GE(t, from);
    EXPECT_NEAR(glsl_double::fogDepth(c.fog, c.origin, c.direction, from, t), wanted, 1e-6 * (1.0 + wanted))
        << i;
    const double single =
        double(glsl_float::fogFlight(c.fog, vec3(c.origin), vec3(c.direction), float(from), float(u)));
    if (single < kFar) {
      EXPECT_NEAR(single, t, 2e-3 * (1.0 + t)) << i;
    }
  }
  EXPECT_GE(ended, 800);
}

TEST(ShaderFog, FlightsThroughUniformFogAreExponential) {
  constexpr size_t kBins = 40;
  const layout::Fog fog{{0.0f, 0.0f, 0.0f, 2.0f}, glm::vec4(1.0f), {0.8f, 0.0f, 0.0f, 0.0f}};
  Draw draw(7);
  std::vector<double> counted(kBins + 1, 0.0);
  std::vector<double> expected(kBins + 1);
  for (int i = 0; i < kSamples; ++i) {
    const float t = glsl_float::fogFlight(fog, vec3(-5, 0, 0), vec3(1, 0, 0), 0.0f, draw.unit());
    const size_t bin = t >= glsl_float::kFarAway ? kBins : size_t((double(t) - 3.0) / 4.0 * kBins);
    counted[std::min(bin, kBins)] += 1.0;
  }
  for (size_t i = 0; i <= kBins; ++i) {
    const double low = std::exp(-0.8 * 4.0 * double(i) / kBins);
    expected[i] = kSamples * (i == kBins ? low : low - std::exp(-0.8 * 4.0 * double(i + 1) / kBins));
  }
  EXPECT_GE(chiSquareChance(expected, counted), kLeastChance);
}

}  // namespace
}  // namespace fragtrace
