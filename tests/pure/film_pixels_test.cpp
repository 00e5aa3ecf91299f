// SPDX-License-Identifier: MIT
#include "render/film/film_pixels.h"

#include <gtest/gtest.h>

#include "film_samples.h"
#include "image/image.h"
#include "shader/layout.h"

namespace fragtrace {
namespace {

TEST(FilmPixel, MeanAndVarianceAreThoseOfItsSamples) {
  FilmPixel p;
  EXPECT_EQ(p.mean(), glm::dvec3(0.0));
  EXPECT_EQ(p.variance(), 0.0);
  addSample(p, glm::dvec3(1, 2, 3));
  EXPECT_EQ(p.mean(), glm::dvec3(1, 2, 3));
  EXPECT_EQ(p.variance(), 0.0);  // one sample shows no variance
  addSample(p, glm::dvec3(3, 4, 5));
  EXPECT_EQ(p.mean(), glm::dvec3(2, 3, 4));
  EXPECT_NEAR(p.luminance(), 2 * 0.2126 + 3 * 0.7152 + 4 * 0.0722, 1e-15);
  // Luminances 2 apart: a variance of 2 of the samples, of half as much of the mean.
  EXPECT_NEAR(p.variance(), 1.0, 1e-14);
}

/// A shadow that is there in one of two samples, behind half a surface of radiance 0.2.
FilmPixels shadowOverNothing() {
  FilmPixels film = emptyFilm({3, 1});
  for (FilmPixel& pixel : film.pixels) {
    pixel.samples = 2;
    pixel.flags = layout::kPixelOverWhite;
  }
  film.pixels[0].alpha = 1.0;
  film.pixels[1].alpha = 2.0;
  film.pixels[1].sum = glm::dvec3(0.4);
  film.pixels[2].alpha = 1.5;
  film.pixels[2].sum = glm::dvec3(0.2);
  return film;
}

TEST(FilmPixels, AShadowInAlphaAloneIsSeenOverWhite) {
  const FilmPixels film = shadowOverNothing();
  EXPECT_NEAR(film.pixels[0].luminance(), 0.5, 1e-12);
  EXPECT_NEAR(film.pixels[1].luminance(), 0.2, 1e-12);
  EXPECT_NEAR(film.pixels[2].luminance(), 0.1 + 0.25, 1e-12);
  EXPECT_FALSE(isOverWhite(imageOf(emptyFilm({1, 1}), {true})));
  EXPECT_FALSE(isOverWhite(imageOf(film, {false})));
  const Image picture = imageOf(film, {true});
  ASSERT_TRUE(isOverWhite(picture));
  Image seen = laidOverWhite(picture);
  for (size_t x = 0; x < 3; ++x) EXPECT_NEAR(seen.pixel(int(x), 0)[0], film.pixels[x].luminance(), 1e-6);
  const Image same = liftedFromWhite(picture, seen, picture);
  for (size_t i = 0; i < picture.values.size(); ++i) EXPECT_NEAR(same.values[i], picture.values[i], 1e-6);
  for (float& value : seen.values) value *= 0.5f;
  const Image lifted = liftedFromWhite(picture, seen, picture);
  // A shadow alone gets darker, a surface keeps its alpha, and its colour stays among those around it.
  const std::vector<float> expected{0, 0, 0, 0.75f, 0.1f, 0.1f, 0.1f, 1, 0.1f, 0.1f, 0.1f, 0.75f};
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(lifted.values[i], expected[i], 1e-6) << i;
}

TEST(FilmPixels, PooledFilmsAreOneFilmOfAllSamples) {
  const glm::ivec2 size(6, 5);
  FilmPixels all = emptyFilm(size);
  FilmPixels parts[3] = {all, all, all};
  Draw draw(197);
  for (size_t i = 0; i < all.pixels.size(); ++i) {
    for (FilmPixels& part : parts) {
      // Some have no sample, some one; a bright offset shows what cancels.
      const int samples = draw.integer(0, 4) * draw.integer(0, 30);
      const double offset = i % 3 == 0 ? 1000.0 : 0.0;
      for (int k = 0; k < samples; ++k) {
        const glm::dvec3 color = draw.inCube(1.0) + offset;
        for (FilmPixel* p : {&all.pixels[i], &part.pixels[i]}) {
          addSample(*p, color);
          p->alpha += 0.25;
          p->rays += 3;
          p->nonfinite += k % 7 == 0;
          p->flags |= k == 20 ? layout::kPixelBudgetHit : 0u;
        }
      }
    }
  }
  const FilmPixels joined = pooled(pooled(parts[0], parts[1]), parts[2]);
  const FilmPixels other = pooled(parts[1], pooled(parts[2], parts[0]));
  ASSERT_EQ(joined.size, size);
  for (size_t i = 0; i < all.pixels.size(); ++i) {
    const FilmPixel& expected = all.pixels[i];
    for (const FilmPixel* p : {&joined.pixels[i], &other.pixels[i]}) {
      EXPECT_LE(glm::distance(p->mean(), expected.mean()), 1e-12 * (1.0 + glm::length(expected.mean())));
      const double scale =
          expected.m2 + 1e-3 * expected.samples * expected.luminance() * expected.luminance();
      EXPECT_NEAR(p->m2, expected.m2, 1e-12 * scale);
      EXPECT_NEAR(p->alpha, expected.alpha, 1e-12);
      EXPECT_EQ(p->samples, expected.samples);
      EXPECT_EQ(p->rays, expected.rays);
      EXPECT_EQ(p->nonfinite, expected.nonfinite);
      EXPECT_EQ(p->flags, expected.flags);
    }
  }
}

TEST(FilmPixels, PooledKeepsAFilmThatMeetsAnEmptyOne) {
  FilmPixels film = filmOf({2, 1}, [](int x, int) { return std::vector<double>{1.0 + x, 4.0}; });
  for (const FilmPixels& p : {pooled(film, emptyFilm({2, 1})), pooled(emptyFilm({2, 1}), film)}) {
    for (size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(p.pixels[i].sum, film.pixels[i].sum);
      EXPECT_EQ(p.pixels[i].m2, film.pixels[i].m2);
      EXPECT_EQ(p.pixels[i].samples, 2u);
    }
  }
}

TEST(FilmPixels, TotalsCountPixelsAndSamples) {
  FilmPixels film = emptyFilm({2, 2});
  film.pixels[0].samples = 5;
  film.pixels[0].rays = 17;
  film.pixels[0].nonfinite = 2;
  film.pixels[1].samples = 3;
  film.pixels[1].rays = 4;
  film.pixels[1].flags = layout::kPixelBudgetHit | layout::kPixelSuspended;
  film.pixels[2].samples = 9;
  film.pixels[2].flags = layout::kPixelSuspended;
  const FilmTotals totals = totalsOf(film);
  EXPECT_EQ(totals.samples, 17u);
  EXPECT_EQ(totals.rays, 21u);
  EXPECT_EQ(totals.emptyPixels, 1u);
  EXPECT_EQ(totals.nonfinitePixels, 1u);
  EXPECT_EQ(totals.budgetHits, 1u);
  EXPECT_EQ(totals.fewestSamples, 0u);
  EXPECT_EQ(totals.mostSamples, 9u);
  EXPECT_EQ(totalsOf(FilmPixels{}).fewestSamples, 0u);
}

TEST(FilmPixels, ImageHoldsMeansWithTheFirstRowAtTheTop) {
  // Means are 10 x + y, y from the bottom; pixel (2, 1) is empty.
  const glm::ivec2 size(3, 2);
  FilmPixels film = emptyFilm(size);
  for (int i = 0; i < 5; ++i) {
    FilmPixel& p = film.pixels[size_t(i)];
    p.samples = 4;
    p.sum = 4.0 * (10.0 * (i % 3) + i / 3.0 - (i % 3) / 3.0) * glm::dvec3(1, 2, 3);
    p.alpha = 3.0;
    p.m2 = 24.0 * i;
  }
  const Image image = imageOf(film, {true, true, true});
  ASSERT_EQ(image.width, 3);
  ASSERT_EQ(image.height, 2);
  ASSERT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A", "samples.Y", "variance.Y"}));
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      const float* p = image.pixel(x, 1 - y);  // the film counts from the bottom
      const bool empty = x == 2 && y == 1;
      const float mean = empty ? 0.0f : float(10 * x + y);
      EXPECT_NEAR(p[0], mean, 1e-5f) << x << ", " << y;
      EXPECT_NEAR(p[1], 2.0f * mean, 1e-5f);
      EXPECT_NEAR(p[2], 3.0f * mean, 1e-5f);
      EXPECT_EQ(p[3], empty ? 0.0f : 0.75f);
      EXPECT_EQ(p[4], empty ? 0.0f : 4.0f);
      EXPECT_EQ(p[5], empty ? 0.0f : 2.0f * float(3 * y + x));
    }
  }
}

TEST(FilmPixels, ImageHasTheLayersAskedForAndABetterVarianceWhereThereIsOne) {
  const FilmPixels film = filmOf({2, 2}, [](int x, int y) {
    return std::vector<double>{double(x), double(y) + 3};
  });
  EXPECT_EQ(imageOf(film, {}).channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(imageOf(film, {false, true, false}).channels,
            (std::vector<std::string>{"R", "G", "B", "samples.Y"}));
  const std::vector<double> variance{0.5, 1.5, 2.5, 3.5};
  const Image image = imageOf(film, {false, false, true}, variance);
  ASSERT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "variance.Y"}));
  EXPECT_EQ(image.pixel(0, 1)[3], 0.5f);
  EXPECT_EQ(image.pixel(1, 1)[3], 1.5f);
  EXPECT_EQ(image.pixel(0, 0)[3], 2.5f);
  EXPECT_EQ(image.pixel(1, 0)[3], 3.5f);
}

}  // namespace
}  // namespace fragtrace
