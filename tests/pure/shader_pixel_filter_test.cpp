// SPDX-License-Identifier: MIT
// shaders/pixel_filter.glsl: where camera samples lie, against the filters' formulas written down a second
// time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "glsl.h"
#include "shader/render_options.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec2;
using glm::vec2;
using glsl_double::kBlackmanHarrisFilter;
using glsl_double::kBoxFilter;
using glsl_double::kGaussianFilter;

constexpr int kFilters[] = {kBoxFilter, kGaussianFilter, kBlackmanHarrisFilter};
constexpr int kSamples = 1 << 19;
constexpr double kLeastChance = kSignificance / 3.0;  // three chi-square tests in this file
constexpr float kBelowOne = 0x1.fffffep-1f;
constexpr double kMostRadius = 2.0;  // pixels from the middle that any filter reaches along an axis

// ---- the filters, a second time ----

// Harris 1978, table 1: the minimum four-term window, as a sum about its middle.
constexpr double kTerms[] = {0.35875, 0.48829, 0.14128, 0.01168};
constexpr double kWidth = 3.0;

double blackmanHarrisAt(double x) {
  if (std::abs(x) > 0.5 * kWidth) return 0.0;
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) sum += kTerms[k] * std::cos(2.0 * M_PI * k * x / kWidth);
  return sum / (kTerms[0] * kWidth);
}

double pdfOf(int filter, const dvec2& p) {
  if (filter == kBoxFilter) return std::max(std::abs(p.x), std::abs(p.y)) < 0.5 ? 1.0 : 0.0;
  if (filter == kBlackmanHarrisFilter) return blackmanHarrisAt(p.x) * blackmanHarrisAt(p.y);
  // Standard deviation 0.5, cut off at radius 2.
  const double squared = glm::dot(p, p);
  return squared < 4.0 ? std::exp(-2.0 * squared) * 2.0 / (M_PI * (1.0 - std::exp(-8.0))) : 0.0;
}

/// Returns the variance along one axis.
double varianceOf(int filter) {
  if (filter == kBoxFilter) return 1.0 / 12.0;
  if (filter == kGaussianFilter) return 0.25 * (1.0 - 8.0 * std::exp(-8.0) / (1.0 - std::exp(-8.0)));
  double sum = kTerms[0] / 12.0;
  for (int k = 1; k < 4; ++k) sum += (k % 2 == 0 ? 1.0 : -1.0) * kTerms[k] / (2.0 * M_PI * M_PI * k * k);
  return kWidth * kWidth * sum / kTerms[0];
}

/// The density's integrals over square bins of [-2, 2] x [-2, 2], row by row.
std::vector<double> integrateBins(int filter, int side) {
  constexpr int kInner = 20;
  const double step = 2.0 * kMostRadius / (side * kInner);
  std::vector<double> bins(size_t(side) * size_t(side));
  for (int y = 0; y < side * kInner; ++y) {
    for (int x = 0; x < side * kInner; ++x) {
      const dvec2 p(step * (x + 0.5) - kMostRadius, step * (y + 0.5) - kMostRadius);
      bins[size_t(y / kInner) * size_t(side) + size_t(x / kInner)] += step * step * pdfOf(filter, p);
    }
  }
  return bins;
}

// ---- tests ----

TEST(ShaderPixelFilter, KindsAreThoseOfTheOptions) {
  EXPECT_EQ(kBoxFilter, int(PixelFilter::Box));
  EXPECT_EQ(kGaussianFilter, int(PixelFilter::Gaussian));
  EXPECT_EQ(kBlackmanHarrisFilter, int(PixelFilter::BlackmanHarris));
}

TEST(ShaderPixelFilter, SamplesFollowTheDensityOfTheFilter) {
  constexpr int kSide = 40;
  for (int filter : kFilters) {
    std::vector<double> expected = integrateBins(filter, kSide);
    double sum = 0.0;
    for (double& e : expected) {
      sum += e;
      e *= kSamples;
    }
    EXPECT_NEAR(sum, 1.0, 1e-4) << "filter " << filter;
    std::vector<double> counts(expected.size());
    Draw draw(83);
    for (int i = 0; i < kSamples; ++i) {
      const float u = draw.unit();
      const vec2 p = glsl_float::samplePixelFilter(filter, u, draw.unit());
      const dvec2 cell = (dvec2(p) + kMostRadius) * (kSide / (2.0 * kMostRadius));
      ASSERT_TRUE(cell.x >= 0.0 && cell.y >= 0.0 && cell.x < kSide && cell.y < kSide) << "filter " << filter;
      ++counts[size_t(cell.y) * kSide + size_t(cell.x)];
    }
    EXPECT_GT(chiSquareChance(expected, counts), kLeastChance) << "filter " << filter;
  }
}

TEST(ShaderPixelFilter, DensityIsTheFilters) {
  for (int filter : kFilters) {
    Draw draw(71);
    for (int i = 0; i < 20000; ++i) {
      const dvec2 p(draw.between(-2.2, 2.2), draw.between(-2.2, 2.2));
      EXPECT_NEAR(glsl_double::pixelFilterPdf(filter, p), pdfOf(filter, p), 2e-3 * pdfOf(filter, p) + 1e-6)
          << "filter " << filter << " at " << p.x << ", " << p.y;
    }
  }
}

/// Means of x, y, x^2, y^2 and x y over midpoints of a lattice.
struct Moments {
  dvec2 mean{0.0};
  dvec2 squares{0.0};
  double product = 0.0;
};
Moments momentsOf(int filter, int across, int up) {
  Moments m;
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < up; ++j) {
      const dvec2 p = glsl_double::samplePixelFilter(filter, (i + 0.5) / across, (j + 0.5) / up);
      const double part = 1.0 / (double(across) * up);
      m.mean += p * part;
      m.squares += p * p * part;
      m.product += p.x * p.y * part;
    }
  }
  return m;
}

TEST(ShaderPixelFilter, MeanIsTheMiddleAndVarianceThatOfTheFilter) {
  // The tails need fine steps along u, and along v too for filters in which v alone decides y.
  constexpr int kFine = 1 << 14;
  for (int filter : kFilters) {
    const Moments wide = momentsOf(filter, kFine, 8);
    const Moments high = filter == kGaussianFilter ? wide : momentsOf(filter, 8, kFine);
    for (const Moments& m : {wide, high}) {
      EXPECT_LE(glm::length(m.mean), 1e-10) << "filter " << filter;
      EXPECT_NEAR(m.product, 0.0, 1e-10) << "filter " << filter;
    }
    EXPECT_NEAR(wide.squares.x, varianceOf(filter), 5e-6) << "filter " << filter;
    EXPECT_NEAR(high.squares.y, varianceOf(filter), 5e-6) << "filter " << filter;
  }
}

TEST(ShaderPixelFilter, TheWindowsDensityIntegratesToOneAndIsTheSlopeOfItsIntegral) {
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps;
    const dvec2 here = glsl_double::blackmanHarris(t);
    sum += here.x / kSteps;
    EXPECT_NEAR(here.x, kWidth * blackmanHarrisAt(kWidth * (t - 0.5)), 1e-14);
    const double slope =
        (glsl_double::blackmanHarris(t + 1e-5).y - glsl_double::blackmanHarris(t - 1e-5).y) / 2e-5;
    EXPECT_NEAR(here.x, slope, 1e-7) << "t " << t;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_EQ(glsl_double::blackmanHarris(0.0).y, 0.0);
  EXPECT_NEAR(glsl_double::blackmanHarris(1.0).y, 1.0, 1e-12);
}

/// Undoes the window's integral by 60 halvings of its width.
double byBisection(double u) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (glsl_double::blackmanHarris(middle).y < u ? low : high) = middle;
  }
  return kWidth * (0.5 * (low + high) - 0.5);
}

TEST(ShaderPixelFilter, NewtonsMethodFindsThePlaceThatBisectionFinds) {
  double worst = 0.0;
  double worstShare = 0.0;
  const auto check = [&](double u) {
    const double exact = byBisection(u);
    worst = std::max(worst, std::abs(glsl_double::sampleBlackmanHarris(u) - exact));
    // The ends hold next to nothing: there, floats are near in the share of the samples beyond them.
    const double rounded = glsl_float::sampleBlackmanHarris(float(u));
    worstShare = std::max(worstShare, std::abs(glsl_double::blackmanHarris(rounded / kWidth + 0.5).y - u));
  };
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) check((i + 0.5) / kSteps);
  for (int i = 1; i < 24; ++i) {
    check(std::ldexp(1.0, -i));
    check(1.0 - std::ldexp(1.0, -i));
  }
  EXPECT_LE(worst, 3e-6);
  EXPECT_LE(worstShare, 3e-7);
}

TEST(ShaderPixelFilter, FloatIsNearDouble) {
  for (int filter : kFilters) {
    Draw draw(89);
    double worst = 0.0;
    for (int i = 0; i < 50000; ++i) {
      // Near 0 and 1, the next float after u moves the sample by a hundredth of a pixel. So they are left
      // out.
      const float u = float(draw.between(0.001, 0.999));
      const float v = float(draw.between(0.001, 0.999));
      worst = std::max(worst, glm::distance(dvec2(glsl_float::samplePixelFilter(filter, u, v)),
                                            glsl_double::samplePixelFilter(filter, u, v)));
    }
    EXPECT_LE(worst, filter == kBlackmanHarrisFilter ? 3e-5 : 5e-6) << "filter " << filter;
  }
}

TEST(ShaderPixelFilter, IsSymmetric) {
  Draw draw(97);
  for (int i = 0; i < 10000; ++i) {
    const float u = draw.unit() + 0x1p-24f;
    const float v = draw.unit() + 0x1p-24f;
    for (int filter : {kBoxFilter, kBlackmanHarrisFilter}) {
      const vec2 p = glsl_float::samplePixelFilter(filter, u, v);
      EXPECT_EQ(glsl_float::samplePixelFilter(filter, 1.0f - u, v), vec2(-p.x, p.y)) << filter << ", u " << u;
      EXPECT_EQ(glsl_float::samplePixelFilter(filter, u, 1.0f - v), vec2(p.x, -p.y)) << filter << ", v " << v;
    }
    const dvec2 half = glsl_double::samplePixelFilter(kGaussianFilter, u, 0.5 * v);
    EXPECT_LE(glm::distance(glsl_double::samplePixelFilter(kGaussianFilter, u, 0.5 * v + 0.5), -half), 1e-12);
    EXPECT_LE(glm::distance(glsl_double::samplePixelFilter(kGaussianFilter, u, 1.0 - 0.5 * v),
                            dvec2(half.x, -half.y)),
              1e-12);
  }
}

TEST(ShaderPixelFilter, IsFiniteAndInsideAtTheEndsOfTheUnitInterval) {
  const double most[] = {0.5, 2.0, 1.5};
  for (int filter : kFilters) {
    for (float u : {0.0f, 0x1p-24f, 0.5f - 0x1p-25f, 0.5f, kBelowOne}) {
      for (float v : {0.0f, 0x1p-24f, 0.5f, kBelowOne}) {
        const dvec2 p(glsl_float::samplePixelFilter(filter, u, v));
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y))
            << "filter " << filter << ", " << u << ", " << v;
        const double far =
            filter == kGaussianFilter ? glm::length(p) : std::max(std::abs(p.x), std::abs(p.y));
        EXPECT_LE(far, most[filter] + 1e-4) << "filter " << filter << ", " << u << ", " << v;
      }
    }
    const float middle = filter == kGaussianFilter ? 0.0f : 0.5f;
    EXPECT_LE(glm::length(glsl_float::samplePixelFilter(filter, middle, 0.5f)), 2e-7f) << "filter " << filter;
  }
}

}  // namespace
}  // namespace fragtrace
