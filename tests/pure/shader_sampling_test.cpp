// SPDX-License-Identifier: MIT
// shaders/sampling.glsl and the visible normals of shaders/ggx.glsl, drawn in float, against their densities.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/vectors.h"
#include "glsl.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec2;
using glm::vec3;

constexpr int kSamples = 1 << 20;
constexpr int kTests = 12;  // chi-square tests in this file
constexpr double kLeastChance = kSignificance / kTests;

size_t binOf(double x, size_t bins) { return std::min(size_t(std::max(0.0, x) * double(bins)), bins - 1); }

/// The angle of a point in the plane, as a part of the circle.
double turnOf(double x, double y) { return std::atan2(y, x) / (2.0 * M_PI) + 0.5; }

template <typename Vector>
void expectFrame(const Vector& normal, double tolerance) {
  auto f = [&] {
    if constexpr (std::is_same_v<Vector, vec3>) {
      return glsl_float::frameAround(normal);
    } else {
      return glsl_double::frameAround(normal);
    }
  }();
  const dvec3 t(f.tangent);
  const dvec3 b(f.bitangent);
  const dvec3 n(f.normal);
  EXPECT_EQ(f.normal, normal);
  EXPECT_NEAR(glm::length(t), 1.0, tolerance);
  EXPECT_NEAR(glm::length(b), 1.0, tolerance);
  EXPECT_NEAR(glm::dot(t, b), 0.0, tolerance);
  EXPECT_NEAR(glm::dot(t, n), 0.0, tolerance);
  EXPECT_LE(glm::distance(glm::cross(t, b), n), tolerance);
}

TEST(ShaderFrame, IsRightHandedAndOrthonormalForEveryNormal) {
  Draw draw(1);
  for (int i = 0; i < 100000; ++i) {
    dvec3 n = draw.direction();
    // A third close to the pole where a frame by cross products would break down, a third close to its seam.
    if (i % 3 == 1) n = glm::normalize(dvec3(n.x * 1e-4, n.y * 1e-4, n.z < 0.0 ? -1.0 : 1.0));
    if (i % 3 == 2) n = glm::normalize(dvec3(n.x, n.y, n.z * 1e-6));
    expectFrame(n, 1e-14);
    expectFrame(vec3(n), 5e-7);
  }
}

TEST(ShaderFrame, IsOrthonormalAtThePolesAndAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    for (double sign : {-1.0, 1.0}) {
      for (double zero : {0.0, -0.0}) {
        dvec3 n(zero);
        n[axis] = sign;
        expectFrame(n, 0.0);
        expectFrame(vec3(n), 0.0);
      }
    }
  }
}

TEST(ShaderFrame, ToWorldUndoesToFrame) {
  Draw draw(2);
  for (int i = 0; i < 1000; ++i) {
    const auto f = glsl_double::frameAround(draw.direction());
    const dvec3 v = draw.inCube(1.0);
    EXPECT_LE(glm::distance(glsl_double::toWorld(f, glsl_double::toFrame(f, v)), v), 1e-14);
    EXPECT_LE(glm::distance(glsl_double::toFrame(f, f.normal), dvec3(0, 0, 1)), 1e-14);
  }
}

TEST(ShaderSampling, DiskIsUniformByArea) {
  Draw draw(3);
  constexpr size_t kRings = 16;
  constexpr size_t kTurns = 32;
  std::vector<double> counts(kRings * kTurns);
  for (int i = 0; i < kSamples; ++i) {
    const float u = draw.unit();
    const vec2 p = glsl_float::sampleDisk(u, draw.unit());
    const double squared = double(p.x) * p.x + double(p.y) * p.y;
    ASSERT_LE(squared, 1.0 + 1e-6);
    ++counts[binOf(squared, kRings) * kTurns + binOf(turnOf(p.x, p.y), kTurns)];
  }
  EXPECT_GT(uniformChance(counts), kLeastChance);
}

TEST(ShaderSampling, DiskKeepsNeighboursTogether) {
  // The concentric map stretches by at most this much; a seam would tear points apart.
  constexpr double kStretch = 2.6;
  constexpr int kSteps = 512;
  constexpr double kStep = 1.0 / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double u = i * kStep;
      const double v = j * kStep;
      const glm::dvec2 p = glsl_double::sampleDisk(u, v);
      EXPECT_LE(glm::distance(p, glsl_double::sampleDisk(u + kStep, v)), kStretch * kStep);
      EXPECT_LE(glm::distance(p, glsl_double::sampleDisk(u, v + kStep)), kStretch * kStep);
    }
  }
}

TEST(ShaderSampling, CosineHemisphereHasTheCosineAsItsDensity) {
  Draw draw(4);
  constexpr size_t kBands = 32;
  constexpr size_t kTurns = 32;
  std::vector<double> counts(kBands * kTurns);
  double meanCosine = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const float u = draw.unit();
    const vec3 d = glsl_float::sampleCosineHemisphere(u, draw.unit());
    ASSERT_NEAR(glm::length(dvec3(d)), 1.0, 2e-6);
    ASSERT_GE(d.z, 0.0f);
    // The integral of cos / pi over a cap grows as the sine squared, so these bins are equally likely.
    ++counts[binOf(1.0 - double(d.z) * d.z, kBands) * kTurns + binOf(turnOf(d.x, d.y), kTurns)];
    meanCosine += d.z;
  }
  EXPECT_GT(uniformChance(counts), kLeastChance);
  EXPECT_NEAR(meanCosine / kSamples, 2.0 / 3.0, 5.0 * std::sqrt(1.0 / 18.0 / kSamples));
}

TEST(ShaderSampling, TriangleIsUniformByArea) {
  Draw draw(5);
  constexpr size_t kSide = 32;
  // Cells of equal area: the square of cells that two such triangles make, folded on its diagonal.
  std::vector<double> counts(kSide * kSide * 2);
  for (int i = 0; i < kSamples; ++i) {
    const float u = draw.unit();
    const vec2 w = glsl_float::sampleTriangle(u, draw.unit());
    ASSERT_GE(w.x, 0.0f);
    ASSERT_GE(w.y, 0.0f);
    ASSERT_LE(w.x + w.y, 1.0f + 1e-6f);
    const double x = w.x * double(kSide);
    const double y = w.y * double(kSide);
    const bool upper = x - std::floor(x) + y - std::floor(y) >= 1.0;
    ++counts[(binOf(w.y, kSide) * kSide + binOf(w.x, kSide)) * 2 + (upper ? 1 : 0)];
  }
  std::vector<double> expected(counts.size());
  for (size_t y = 0; y < kSide; ++y) {
    for (size_t x = 0; x + y < kSide; ++x) {
      expected[(y * kSide + x) * 2] = double(kSamples) / (kSide * kSide);
      if (x + y + 1 < kSide) expected[(y * kSide + x) * 2 + 1] = double(kSamples) / (kSide * kSide);
    }
  }
  EXPECT_GT(chiSquareChance(expected, counts), kLeastChance);
}

TEST(ShaderSampling, MisWeightsOfTwoStrategiesAddUpToOne) {
  for (double a : {1e-6, 0.3, 1.0, 40.0, 1e6}) {
    for (double b : {1e-6, 0.2, 1.0, 1e5}) {
      EXPECT_NEAR(glsl_double::misWeight(a, b, false), a * a / (a * a + b * b), 1e-14);
      EXPECT_NEAR(glsl_double::misWeight(a, b, true), a / (a + b), 1e-14);
      for (const bool environment : {false, true}) {
        const double both =
            glsl_double::misWeight(a, b, environment) + glsl_double::misWeight(b, a, environment);
        EXPECT_NEAR(both, 1.0, 1e-14);
      }
    }
    EXPECT_EQ(glsl_double::misWeight(a, 0.0, false), 1.0);
    EXPECT_EQ(glsl_double::misWeight(0.0, a, false), 1.0);  // a delta lobe
  }
  EXPECT_EQ(glsl_float::misWeight(1e-20f, 1e20f, false), 0.0f);  // the squared ratio overflows
}

TEST(ShaderSampling, LuminanceOfWhiteIsOne) {
  EXPECT_NEAR(glsl_double::luminance(dvec3(1.0)), 1.0, 1e-15);
  EXPECT_NEAR(glsl_double::luminance(dvec3(0, 1, 0)), 0.7152, 1e-15);
  // The host's is the same.
  for (const dvec3 color : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)})
    EXPECT_EQ(glsl_double::luminance(color), fragtrace::luminance(color));
  EXPECT_EQ(glsl_double::maxComponent(dvec3(0.3, 0.1, 0.7)), 0.7);
}

/// Sums f over the hemisphere above z by midpoints, finest towards the pole.
template <typename Function>
double integrateHemisphere(Function f) {
  constexpr int kSteps = 1500;
  constexpr int kTurns = 180;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = (i + 0.5) / kSteps;
    const double theta = 0.5 * M_PI * s * s;
    const double area = std::sin(theta) * M_PI * s / kSteps * 2.0 * M_PI / kTurns;
    for (int k = 0; k < kTurns; ++k) {
      const double phi = 2.0 * M_PI * (k + 0.5) / kTurns;
      sum +=
          area * f(dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  }
  return sum;
}

dvec3 atElevation(double z) { return {std::sqrt(1.0 - z * z) * 0.8, -std::sqrt(1.0 - z * z) * 0.6, z}; }

TEST(ShaderGgx, FacetsCoverTheSurfaceOnce) {
  for (double alpha : {0.05, 0.3, 1.0}) {
    EXPECT_NEAR(integrateHemisphere([&](const dvec3& h) { return glsl_double::ggxD(h, alpha) * h.z; }), 1.0,
                1e-4);
  }
}

TEST(ShaderGgx, FacetsSeenFromAnywhereFillItsView) {
  // Heitz 2014, equation 2: the projected areas of the visible facets add up to that of the surface.
  for (double alpha : {0.1, 0.4, 1.0}) {
    for (double z : {1.0, 0.6, 0.2}) {
      const dvec3 o = atElevation(z);
      const double seen = integrateHemisphere([&](const dvec3& h) {
        return glsl_double::ggxD(h, alpha) * glsl_double::ggxMasking(o, alpha) *
               std::max(0.0, glm::dot(o, h));
      });
      EXPECT_NEAR(seen, z, 2e-3 * z) << "alpha " << alpha << ", z " << z;
      EXPECT_NEAR(
          integrateHemisphere([&](const dvec3& h) { return glsl_double::visibleGgxPdf(o, h, alpha); }), 1.0,
          2e-3);
    }
  }
}

TEST(ShaderGgx, VisibleNormalsHaveTheirDensity) {
  constexpr size_t kBands = 24;
  constexpr size_t kTurns = 24;
  constexpr int kInner = 24;
  Draw draw(6);
  for (double alpha : {0.1, 0.4, 1.0}) {
    for (double z : {1.0, 0.6, 0.1}) {
      const dvec3 wo = atElevation(z);
      // Step: count; bands of equal area, as long as no facet leans more than the last is reached.
      std::vector<double> counts(kBands * kTurns);
      for (int i = 0; i < kSamples; ++i) {
        const float u = draw.unit();
        const vec3 h = glsl_float::sampleVisibleGgx(vec3(wo), float(alpha), u, draw.unit());
        ASSERT_NEAR(glm::length(dvec3(h)), 1.0, 2e-6);
        ++counts[binOf(std::acos(std::min(1.0, double(h.z))) / (0.5 * M_PI), kBands) * kTurns +
                 binOf(turnOf(h.x, h.y), kTurns)];
      }
      // Step: integrate the density over each bin.
      std::vector<double> expected(kBands * kTurns);
      for (size_t band = 0; band < kBands * kInner; ++band) {
        const double theta = (double(band) + 0.5) / (kBands * kInner) * 0.5 * M_PI;
        const double area = std::sin(theta) * M_PI * M_PI / (double(kBands) * kInner * kTurns * kInner);
        for (size_t turn = 0; turn < kTurns * kInner; ++turn) {
          const double phi = 2.0 * M_PI * ((double(turn) + 0.5) / (kTurns * kInner) - 0.5);
          const dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
          expected[band / kInner * kTurns + turn / kInner] +=
              kSamples * area * glsl_double::visibleGgxPdf(wo, h, alpha);
        }
      }
      EXPECT_GT(chiSquareChance(expected, counts), kLeastChance) << "alpha " << alpha << ", z " << z;
    }
  }
}

TEST(ShaderGgx, MaskingIsOneAlongTheNormalAndFallsToGrazing) {
  for (double alpha : {0.1, 1.0}) {
    EXPECT_EQ(glsl_double::ggxMasking(dvec3(0, 0, 1), alpha), 1.0);
    EXPECT_LT(glsl_double::ggxMasking(atElevation(1e-4), alpha), 0.01);
    // Height-correlated: less than both, more than their product (Heitz 2014).
    const dvec3 a = atElevation(0.3);
    const dvec3 b = atElevation(0.5);
    const double both = glsl_double::ggxMaskingShadowing(a, b, alpha);
    EXPECT_LT(both, std::min(glsl_double::ggxMasking(a, alpha), glsl_double::ggxMasking(b, alpha)));
    EXPECT_GT(both, glsl_double::ggxMasking(a, alpha) * glsl_double::ggxMasking(b, alpha));
  }
}

}  // namespace
}  // namespace fragtrace
