// SPDX-License-Identifier: MIT
// src/render/film/noise.cpp on films of known noise.
#include "render/film/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "film_samples.h"

namespace fragtrace {
namespace {

/// A picture that is not even: means from 0.5 to 4.
double meanAt(int x, int y) { return 0.5 + 1.75 * (1.0 + std::sin(0.1 * x + 0.3 * y)); }

/// Independent samples about the mean: exponential, so their variance is its square.
std::vector<double> independentSamples(Draw& draw, double mean, int count) {
  std::vector<double> samples(size_t(count), 0.0);
  for (double& s : samples) s = -mean * std::log(draw.between(0.0, 1.0));
  return samples;
}

/// One sample in each of `count` strata of 0 .. 2 x mean: the variance of their mean is (2 mean)^2 / (12
/// count^3), that of as many independent ones (2 mean)^2 / (12 count).
std::vector<double> stratifiedSamples(Draw& draw, double mean, int count) {
  std::vector<double> samples(size_t(count), 0.0);
  for (int k = 0; k < count; ++k) samples[size_t(k)] = 2.0 * mean * (k + draw.between(0.0, 1.0)) / count;
  return samples;
}

constexpr glm::ivec2 kSize(96, 64);

/// Mean over the pixels from columns `first` to before `last` of the estimate over the true variance.
double meanRatio(const std::vector<double>& variance, int first, int last, auto truth) {
  double sum = 0.0;
  for (int y = 0; y < kSize.y; ++y) {
    for (int x = first; x < last; ++x) sum += variance[size_t(y) * size_t(kSize.x) + size_t(x)] / truth(x, y);
  }
  return sum / double((last - first) * kSize.y);
}

TEST(Noise, VarianceIsUnbiasedForIndependentSamples) {
  constexpr int kSamples = 32;
  constexpr int kTrials = 8;
  Draw draw(199);
  double sum = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto film = [&] {
      return filmOf(kSize, [&](int x, int y) { return independentSamples(draw, meanAt(x, y), kSamples); });
    };
    Halves halves;
    halves.a = film();
    halves.b = film();
    const double ratio = meanRatio(varianceOfMean(halves), 0, kSize.x, [](int x, int y) {
      return meanAt(x, y) * meanAt(x, y) / (2.0 * kSamples);
    });
    // Each trial rests on 6,144 squared differences: a standard error of 2 %.
    EXPECT_NEAR(ratio, 1.0, 0.09) << "trial " << trial;
    sum += ratio;
  }
  EXPECT_NEAR(sum / kTrials, 1.0, 0.03);
}

TEST(Noise, VarianceOfHalvesOfDifferentLengthsIsThatOfAllSamples) {
  constexpr int kSamples[2] = {12, 48};
  Draw draw(211);
  Halves halves;
  halves.a = filmOf(kSize, [&](int x, int y) { return independentSamples(draw, meanAt(x, y), kSamples[0]); });
  halves.b = filmOf(kSize, [&](int x, int y) { return independentSamples(draw, meanAt(x, y), kSamples[1]); });
  const double ratio = meanRatio(varianceOfMean(halves), 0, kSize.x, [&](int x, int y) {
    return meanAt(x, y) * meanAt(x, y) / double(kSamples[0] + kSamples[1]);
  });
  EXPECT_NEAR(ratio, 1.0, 0.1);
}

TEST(Noise, TheSmallerVarianceOfAntiCorrelatedSamplesIsFound) {
  constexpr int kSamples = 8;
  Draw draw(223);
  const auto film = [&] {
    return filmOf(kSize, [&](int x, int y) { return stratifiedSamples(draw, meanAt(x, y), kSamples); });
  };
  Halves halves;
  halves.a = film();
  halves.b = film();
  const std::vector<double> variance = varianceOfMean(halves);
  const double ratio = meanRatio(variance, 0, kSize.x, [](int x, int y) {
    return std::pow(2.0 * meanAt(x, y), 2.0) / (12.0 * std::pow(kSamples, 3.0)) / 2.0;
  });
  EXPECT_NEAR(ratio, 1.0, 0.09);
  // The variance of samples taken as independent is wrong by the square of their number.
  EXPECT_GT(halves.a.pixels[0].variance() / 2.0, 20.0 * variance[0]);
}

TEST(Noise, TheShareThatASamplerLeavesIsFoundWhereItIs) {
  constexpr int kSamples = 8;
  Draw draw(227);
  // Three windows' cells wide on each side: beyond column 16 of each no window sees the other side.
  const auto film = [&] {
    return filmOf(kSize, [&](int x, int y) {
      const double mean = meanAt(x, y);
      return x < 48 ? independentSamples(draw, mean, kSamples) : stratifiedSamples(draw, mean, kSamples);
    });
  };
  Halves halves;
  halves.a = film();
  halves.b = film();
  const std::vector<double> variance = varianceOfMean(halves);
  const auto independent = [](int x, int y) { return meanAt(x, y) * meanAt(x, y) / (2.0 * kSamples); };
  const auto stratified = [](int x, int y) {
    return std::pow(2.0 * meanAt(x, y), 2.0) / (24.0 * std::pow(kSamples, 3.0));
  };
  EXPECT_NEAR(meanRatio(variance, 0, 32, independent), 1.0, 0.15);
  // The whole picture's share, about a half against 1 / 64 here, has the weight of 24 of a window's 1,024
  // pixels and more, which at most doubles it.
  const double there = meanRatio(variance, 64, 96, stratified);
  EXPECT_GT(there, 0.9);
  EXPECT_LT(there, 2.3);
}

/// Light that one sample in a thousand meets: most pixels have none of it, and do not know that they are
/// noisy.
TEST(Noise, PixelsWhoseSamplesAllMissTheLightAreAsNoisyAsTheirNeighbours) {
  constexpr int kSamples = 32;
  constexpr double kChance = 1e-3;
  Draw draw(241);
  const auto film = [&] {
    return filmOf(kSize, [&](int, int) {
      std::vector<double> samples(size_t(kSamples), 0.0);
      for (double& s : samples) s = draw.between(0.0, 1.0) < kChance ? 1.0 : 0.0;
      return samples;
    });
  };
  FilmPixels both = pooled(film(), film());
  for (FilmPixel& p : both.pixels) p.alpha = p.samples;
  const std::vector<double> errors = relativeErrors(both, independentVariance(both));
  const double truth = 1.0 / std::sqrt(2 * kSamples * kChance);
  EXPECT_NEAR(quantileOf(errors, 0.5) / truth, 1.0, 0.3);
  EXPECT_GT(distanceTo(0.5 * truth, both, errors, false).error, 0.7 * truth);
  EXPECT_LT(distanceTo(0.5 * truth, both, errors, false).share, 0.1);
}

/// 9 of 6,144 pixels are lit and noisy; all others miss, or are black.
TEST(Noise, AGoalLooksAtTheFewPixelsThatAreLit) {
  constexpr int kSamples = 32;
  for (const double alpha : {0.0, 1.0}) {
    Draw draw(251);
    FilmPixels film = filmOf(kSize, [&](int x, int y) {
      const bool lit = x / 3 == 10 && y / 3 == 10;
      return lit ? independentSamples(draw, 1.0, kSamples) : std::vector<double>(size_t(kSamples), 0.0);
    });
    for (FilmPixel& p : film.pixels) p.alpha = alpha * p.samples;
    const GoalDistance distance =
        distanceTo(0.02, film, relativeErrors(film, independentVariance(film)), false);
    EXPECT_NEAR(distance.error, 1.0 / std::sqrt(double(kSamples)), 0.1) << alpha;
    EXPECT_LT(distance.share, 0.2) << alpha;
  }
  const FilmPixels missed = filmOf(kSize, [](int, int) { return std::vector<double>(4, 1.0); });
  EXPECT_EQ(distanceTo(0.02, missed, relativeErrors(missed, independentVariance(missed)), false).share, 1.0);
}

/// A hundred noisy pixels of a product stand on a plane of 6,000 quiet ones.
TEST(Noise, AQuietPlaneHidesNoNoiseOfTheObjectOnACatcher) {
  constexpr int kSamples = 32;
  Draw draw(7);
  const auto isObject = [](int x, int y) { return x >= 10 && x < 20 && y >= 10 && y < 20; };
  FilmPixels film = filmOf(kSize, [&](int x, int y) {
    std::vector<double> samples = independentSamples(draw, 1.0, kSamples);
    for (double& sample : samples) sample = isObject(x, y) ? sample : 1.0 + 1e-3 * sample;
    return samples;
  });
  for (int y = 0; y < kSize.y; ++y) {
    for (int x = 0; x < kSize.x; ++x) {
      FilmPixel& p = film.pixels[size_t(y) * size_t(kSize.x) + size_t(x)];
      p.alpha = isObject(x, y) ? p.samples : 0.1 * p.samples;
    }
  }
  const std::vector<double> errors = relativeErrors(film, independentVariance(film));
  EXPECT_LT(distanceTo(0.02, film, errors, false).error, 0.02);
  EXPECT_GT(distanceTo(0.02, film, errors, true).error, 0.1);
}

TEST(Noise, VarianceOfAConstantPictureIsNothing) {
  for (double level : {0.0, 1.0, 1e6}) {
    const FilmPixels film = filmOf({20, 10}, [&](int, int) { return std::vector<double>(4, level); });
    const std::vector<double> variance = varianceOfMean({film, film});
    ASSERT_EQ(variance.size(), 200u);
    for (double v : variance) EXPECT_EQ(v, 0.0) << "level " << level;
    for (double e : relativeErrors(film, variance)) EXPECT_EQ(e, 0.0) << "level " << level;
  }
}

TEST(Noise, VarianceIsFiniteAndNotNegativeWhateverTheFilmHolds) {
  Draw draw(229);
  const glm::ivec2 size(37, 21);  // no whole number of windows
  for (int trial = 0; trial < 20; ++trial) {
    const auto film = [&] {
      return filmOf(size, [&](int, int) {
        std::vector<double> samples(size_t(draw.integer(0, 3)), 0.0);
        for (double& s : samples) s = draw.integer(0, 3) == 0 ? std::pow(10.0, draw.between(-12, 6)) : 0.0;
        return samples;
      });
    };
    Halves halves;
    halves.a = film();
    halves.b = film();
    const std::vector<double> variance = varianceOfMean(halves);
    for (double v : variance) {
      EXPECT_TRUE(std::isfinite(v));
      EXPECT_GE(v, 0.0);
    }
    for (double e : relativeErrors(pooled(halves.a, halves.b), variance)) {
      EXPECT_TRUE(std::isfinite(e));
      EXPECT_GE(e, 0.0);
    }
  }
}

TEST(Noise, PixelsWithoutSamplesHaveNoVarianceAndLeaveThatOfOthersAlone) {
  constexpr int kSamples = 32;
  Draw draw(233);
  const auto film = [&](int empty) {
    return filmOf(kSize, [&](int x, int y) {
      return (x + y) % 4 == empty || (x + y) % 4 == 0 ? std::vector<double>{}
                                                      : independentSamples(draw, meanAt(x, y), kSamples);
    });
  };
  // A quarter has samples in neither half, a quarter in only one of them each.
  Halves halves;
  halves.a = film(1);
  halves.b = film(2);
  const std::vector<double> variance = varianceOfMean(halves);
  double ratios[4] = {};
  for (int y = 0; y < kSize.y; ++y) {
    for (int x = 0; x < kSize.x; ++x) {
      const double v = variance[size_t(y) * size_t(kSize.x) + size_t(x)];
      if ((x + y) % 4 == 0) {
        EXPECT_EQ(v, 0.0);
      }
      const int halvesWithSamples = (x + y) % 4 == 3 ? 2 : 1;
      ratios[(x + y) % 4] +=
          v / (meanAt(x, y) * meanAt(x, y) / (halvesWithSamples * kSamples)) / (kSize.x * kSize.y / 4.0);
    }
  }
  for (int k : {1, 2, 3}) EXPECT_NEAR(ratios[k], 1.0, 0.15) << "kind " << k;
}

TEST(Noise, RelativeErrorIsTheStandardErrorOverTheMeanAndAHundredthOfThePictures) {
  FilmPixels film = emptyFilm({2, 2});
  const double means[] = {1.0, 0.0, 10.0, 1.0};
  for (size_t i = 0; i < 4; ++i) {
    film.pixels[i].samples = 8;
    film.pixels[i].sum = glm::dvec3(8.0 * means[i]);
  }
  const std::vector<double> errors = relativeErrors(film, {0.04, 0.01, 4.0, 0.0});
  const double floor = 0.01 * 3.0;
  EXPECT_NEAR(errors[0], 0.2 / (1.0 + floor), 1e-14);
  EXPECT_NEAR(errors[1], 0.1 / floor, 1e-12);
  EXPECT_NEAR(errors[2], 2.0 / (10.0 + floor), 1e-14);
  EXPECT_EQ(errors[3], 0.0);
}

TEST(Noise, RelativeErrorIsNothingWhereAllIsBlackAndWhereVarianceIsNegative) {
  for (double e : relativeErrors(emptyFilm({3, 1}), {0.0, 1.0, 2.0})) EXPECT_EQ(e, 0.0);
  const FilmPixels grey = filmOf({1, 1}, [](int, int) { return std::vector<double>{1.0}; });
  EXPECT_EQ(relativeErrors(grey, {-1e-20})[0], 0.0);
}

TEST(Noise, QuantileIsTheValueThatThisPartOfAllDoesNotExceed) {
  std::vector<double> values(100);
  std::iota(values.begin(), values.end(), 1.0);
  std::shuffle(values.begin(), values.end(), Draw(239).engine);
  EXPECT_EQ(quantileOf(values, 0.95), 95.0);
  EXPECT_EQ(quantileOf(values, 0.951), 96.0);
  EXPECT_EQ(quantileOf(values, 1.0), 100.0);
  EXPECT_EQ(quantileOf(values, 0.01), 1.0);
  EXPECT_EQ(quantileOf(values, 0.0), 1.0);
  EXPECT_EQ(quantileOf({3.0}, 0.95), 3.0);
  EXPECT_EQ(quantileOf({4.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantileOf({}, 0.95), 0.0);
}

}  // namespace
}  // namespace fragtrace
