// SPDX-License-Identifier: MIT
#include "image/compare/bias.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <vector>

#include "base/errors.h"
#include "base/vectors.h"
#include "image/channels.h"
#include "image/compare/difference.h"

namespace fragtrace {

namespace {

constexpr double kPrecision = 1e-15;
constexpr double kTiny = 1e-300;  // stands for 0 in a denominator
constexpr int kMostSteps = 1'000'000;

/// The continued fraction of the incomplete beta function (Digital Library of Mathematical Functions,
/// 8.17.22), by Lentz's method. It converges fast where x < (a + 1) / (a + b + 2).
double betaFraction(double x, double a, double b) {
  const auto orTiny = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double above = 1;
  double below = 1 / orTiny(1 - (a + b) * x / (a + 1));
  double result = below;
  for (int m = 1; m < kMostSteps; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1;
    for (const double term : std::array{even, odd}) {
      below = 1 / orTiny(1 + term * below);
      above = orTiny(1 + term / above);
      step = above * below;
      result *= step;
    }
    if (std::abs(step - 1) < kPrecision) break;
  }
  return result;
}

constexpr double kFloatRounding = 1e-6;  // smaller relative differences are those of floats
constexpr double kFullColorDigits = 6;   // -log10 of the p of full red or blue

/// A picture with all values that the test of bias reads.
class Estimates {
 public:
  Estimates(const Image& image, const char* which)
      : image_(isOverWhite(image) ? laidOverWhite(image) : image),
        color_(colorReader(image_, which)),
        variance_(findChannel(image_, "variance.Y")),
        counts_(findChannel(image_, "samples.Y")) {
    const auto fail = [&](const char* what) {
      throw RenderError(std::string("cannot compare: the ") + which + " " + what);
    };
    if (!variance_) fail("has no layer variance.Y, which render --aov variance writes");
    const auto& attributes = image_.attributes;
    if (!counts_) {
      const auto uniform = attributes.find("fragtrace:uniform");
      const auto samples = attributes.find("fragtrace:samples");
      if (uniform == attributes.end() || uniform->second != "1" || samples == attributes.end())
        fail("has no layer samples.Y, which render --aov samples writes");
      count_ = std::strtod(samples->second.c_str(), nullptr);
    }
    for (size_t i = 0; i < size_t(image_.width) * size_t(image_.height); ++i) {
      if (count(i) != 0 && !(count(i) >= 2))
        fail("has pixels with fewer than two samples, whose noise is not known");
      if (variance(i) < 0.0) fail("has pixels of negative variance");
    }
  }

  double luminance(size_t pixel) const {
    return fragtrace::luminance({color_(pixel, 0), color_(pixel, 1), color_(pixel, 2)});
  }
  double variance(size_t pixel) const { return image_.values[pixel * image_.channelCount() + *variance_]; }
  double count(size_t pixel) const {
    return counts_ ? image_.values[pixel * image_.channelCount() + *counts_] : count_;
  }

 private:
  Image image_;
  ColorReader color_;
  std::optional<size_t> variance_;
  std::optional<size_t> counts_;
  double count_ = 0;
};

/// A rectangle of pixels; right and bottom are not part of it.
struct Tile {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
};

/// Sums over the pixels of a tile that both pictures have seen.
struct Sums {
  int pixels = 0;
  double a = 0;         ///< luminance of the picture
  double b = 0;         ///< luminance of the reference
  double variance = 0;  ///< the variance of a - b
  double spread = 0;    ///< the sum of each mean's variance^2 / degrees of freedom
};

bool differ(double a, double b) { return std::abs(a - b) > kFloatRounding * (std::abs(a) + std::abs(b)); }

void add(Sums& sums, const Estimates& a, const Estimates& b, size_t pixel) {
  const double meanOfA = a.luminance(pixel);
  const double meanOfB = b.luminance(pixel);
  const double degreesOfA = a.count(pixel) - 1;
  const double degreesOfB = b.count(pixel) - 1;
  double ofA = a.variance(pixel);
  double ofB = b.variance(pixel);
  if ((ofA == 0 || ofB == 0) && differ(meanOfA, meanOfB)) {
    // At an edge, a few samples may have the same value by chance. As in Student's own test, the samples of
    // both then show how far apart samples are.
    const double apart = meanOfA - meanOfB;
    const double between = apart * apart / (degreesOfA + degreesOfB + 1);
    ofA += between / 2;
    ofB += between / 2;
  }
  ++sums.pixels;
  sums.a += meanOfA;
  sums.b += meanOfB;
  sums.variance += ofA + ofB;
  sums.spread += ofA * ofA / degreesOfA + ofB * ofB / degreesOfB;
}

Sums sumsOf(const Estimates& a, const Estimates& b, const Tile& tile, int width) {
  Sums sums;
  for (int y = tile.top; y < tile.bottom; ++y) {
    for (int x = tile.left; x < tile.right; ++x) {
      const size_t pixel = size_t(y) * size_t(width) + size_t(x);
      if (a.count(pixel) != 0 && b.count(pixel) != 0) add(sums, a, b, pixel);
    }
  }
  return sums;
}

bool isFinite(const Sums& sums) { return std::isfinite(sums.a + sums.b + sums.variance); }

/// p of a tile; none where both pictures are the same constant.
std::optional<double> welch(const Sums& sums) {
  if (!isFinite(sums)) return 0;
  if (sums.variance <= 0) return std::nullopt;
  // Welch and Satterthwaite, with a term for each pixel's mean.
  const double t = differ(sums.a, sums.b) ? (sums.a - sums.b) / std::sqrt(sums.variance) : 0;
  return studentTails(t, sums.variance * sums.variance / sums.spread);
}

/// BiasTest::chance of the tiles' p.
double chanceOf(std::vector<double> values) {
  if (values.empty()) return 1;
  std::sort(values.begin(), values.end());
  const double count = double(values.size());
  double step = 0;
  for (size_t i = 0; i < values.size(); ++i) step = std::max(step, double(i + 1) / count - values[i]);
  const double ofSmallest = -std::expm1(count * std::log1p(-values.front()));
  const double ofMany = std::exp(-2 * count * step * step);  // Massart's bound
  return std::min(1.0, 2 * std::min(ofSmallest, ofMany));
}

void paint(Image& map, const Tile& tile, std::optional<double> p, bool brighter) {
  std::array<float, 3> color{0.5F, 0.5F, 0.5F};
  if (p) {
    const double digits = -std::log10(std::max(*p, 1e-300));
    const float rest = float(std::max(1 - digits / kFullColorDigits, 0.0));
    color = brighter ? std::array{1.0F, rest, rest} : std::array{rest, rest, 1.0F};
  }
  for (int y = tile.top; y < tile.bottom; ++y)
    for (int x = tile.left; x < tile.right; ++x) std::copy(color.begin(), color.end(), map.pixel(x, y));
}

}  // namespace

double studentTails(double t, double freedom) {
  // The regularised incomplete beta function I_x(a, b), where 1 - x keeps its digits (ibid., 8.17.4).
  const double square = t * t;
  if (std::isinf(square)) return 0;
  const double a = freedom / 2;
  const double b = 0.5;
  const double x = freedom / (freedom + square);
  const double y = square / (freedom + square);
  const double logX = -std::log1p(square / freedom);
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * logX) * std::sqrt(y);
  if (x < (a + 1) / (a + b + 2)) return front * betaFraction(x, a, b) / a;
  return 1 - front * betaFraction(y, b, a) / b;
}

BiasTest testBias(const Image& picture, const Image& reference, int side) {
  const size_t pixelCount = commonPixelCount(picture, reference);
  const Estimates a(picture, "picture");
  const Estimates b(reference, "reference");
  BiasTest test;
  test.map = {picture.width, picture.height, {"R", "G", "B"}, std::vector<float>(pixelCount * 3), {}};
  std::vector<double> values;
  bool anyPixel = false;
  for (int top = 0; top < picture.height; top += side) {
    for (int left = 0; left < picture.width; left += side) {
      const Tile tile{left, top, std::min(left + side, picture.width), std::min(top + side, picture.height)};
      const Sums sums = sumsOf(a, b, tile, picture.width);
      anyPixel = anyPixel || sums.pixels > 0;
      const std::optional<double> p = welch(sums);
      paint(test.map, tile, p, sums.a > sums.b);
      ++test.tiles;
      if (!isFinite(sums)) {
        if (!std::isnan(test.chance)) test.place = {left, top};
        test.chance = test.smallest = std::numeric_limits<double>::quiet_NaN();
      } else if (p) {
        // A tile that is not finite stays the place of the result, however small the p of later ones is.
        if (values.empty() ? !std::isnan(test.chance) : *p < test.smallest) {
          test.smallest = *p;
          test.place = {left, top};
        }
        ++test.histogram[size_t(std::min(9.0, *p * 10))];
        values.push_back(*p);
      }
    }
  }
  if (!anyPixel) throw RenderError("no pixel has samples in both pictures");
  test.noisy = int(values.size());
  if (!std::isnan(test.chance)) test.chance = chanceOf(std::move(values));
  return test;
}

}  // namespace fragtrace
