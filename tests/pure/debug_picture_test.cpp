// SPDX-License-Identifier: MIT
#include "render/film/film_pixels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/display/heatmap.h"
#include "image/display/tone_map.h"

namespace fragtrace {
namespace {

/// Two samples per pixel, both of this value, of which so many have hit something. The first pixel is the
/// bottom left.
FilmPixels filmOf(glm::ivec2 size, const std::vector<glm::dvec3>& values,
                  const std::vector<double>& hits = {}) {
  FilmPixels film{size, std::vector<FilmPixel>(values.size())};
  for (size_t i = 0; i < values.size(); ++i) {
    film.pixels[i].samples = 2;
    film.pixels[i].alpha = hits.empty() ? 2.0 : hits[i];
    film.pixels[i].sum = film.pixels[i].alpha * values[i];
  }
  return film;
}

/// Returns the colour that a display shows.
glm::dvec3 shown(const Image& image, int x, int y) {
  const float* p = image.pixel(x, y);
  return {encodeSrgb(p[0]), encodeSrgb(p[1]), encodeSrgb(p[2])};
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LE(glm::distance(a, b), 1e-6) << a.x << " " << a.y << " " << a.z;
}

TEST(DebugPicture, NormalsAreHalfAndHalf) {
  const FilmPixels film = filmOf({2, 2}, {{0, 0, 1}, {-1, 0, 0}, {0.6, -0.8, 0}, {1, 1, 1}}, {2, 2, 1, 0});
  for (const DebugView view : {DebugView::Normal, DebugView::GeometricNormal}) {
    const Image image = debugPicture(view, film);
    expectNear(shown(image, 0, 1), {0.5, 0.5, 1.0});
    expectNear(shown(image, 1, 1), {0.0, 0.5, 0.5});
    // The pixel is half covered, so it has half of the colour's light.
    const float* half = image.pixel(0, 0);
    EXPECT_NEAR(half[0], 0.5 * decodeSrgb(0.8), 1e-6);
    EXPECT_NEAR(half[1], 0.5 * decodeSrgb(0.1), 1e-6);
    expectNear(shown(image, 1, 0), {0, 0, 0});
  }
}

TEST(DebugPicture, RoughnessAndTexcoordsAreShownAsTheyAre) {
  const FilmPixels film = filmOf({3, 1}, {{0.25, 0.25, 0.25}, {1.25, -0.25, 0.0}, {0.5, 1.0, 0.0}});
  expectNear(shown(debugPicture(DebugView::Roughness, film), 0, 0), {0.25, 0.25, 0.25});
  const Image texcoords = debugPicture(DebugView::Texcoords, film);
  expectNear(shown(texcoords, 1, 0), {0.25, 0.75, 0.0});
  expectNear(shown(texcoords, 2, 0), {0.5, 0.0, 0.0});
}

TEST(DebugPicture, DepthGoesFromWhiteToATenth) {
  const FilmPixels film = filmOf({2, 2}, {{2, 2, 2}, {6, 6, 6}, {4, 4, 4}, {0, 0, 0}}, {2, 2, 1, 0});
  const Image image = debugPicture(DebugView::Depth, film);
  expectNear(shown(image, 0, 1), {1, 1, 1});
  expectNear(shown(image, 1, 1), {0.1, 0.1, 0.1});
  EXPECT_NEAR(image.pixel(0, 0)[1], 0.5 * decodeSrgb(0.55), 1e-6);
  expectNear(shown(image, 1, 0), {0, 0, 0});
  // One depth only, or none: no division by zero.
  expectNear(shown(debugPicture(DebugView::Depth, filmOf({1, 1}, {{3, 3, 3}})), 0, 0), {1, 1, 1});
  expectNear(shown(debugPicture(DebugView::Depth, filmOf({1, 1}, {{0, 0, 0}}, {0})), 0, 0), {0, 0, 0});
}

/// A film whose left half has this many samples and the right half 64, of luminance 1, each with such a
/// variance of the mean; high enough for the scale along the bottom.
FilmPixels halves(uint32_t left, double leftVariance) {
  constexpr int kSide = 40;
  FilmPixels film{{kSide, kSide}, std::vector<FilmPixel>(size_t(kSide) * kSide)};
  for (size_t i = 0; i < film.pixels.size(); ++i) {
    FilmPixel& pixel = film.pixels[i];
    const bool isLeft = i % kSide < kSide / 2;
    pixel.samples = isLeft ? left : 64;
    pixel.sum = glm::dvec3(pixel.samples);
    pixel.m2 = (isLeft ? leftVariance : 0.0) * pixel.samples * (pixel.samples - 1.0);
  }
  return film;
}

glm::vec3 colorAt(const Image& image, int x, int y) {
  const float* p = image.pixel(x, y);
  return {p[0], p[1], p[2]};
}

TEST(DebugPicture, SamplesAreAHeatMapOfTheirCount) {
  const Image image = debugPicture(DebugView::Samples, halves(32, 0.0));
  ASSERT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  // The scale ends at 80, the round number above 64.
  EXPECT_LE(glm::distance(colorAt(image, 30, 0), glm::vec3(1.0f, 0.8f, 0.0f)), 1e-6f);
  EXPECT_LE(glm::distance(colorAt(image, 5, 0), glm::vec3(0.0f, 1.0f, 0.4f)), 1e-5f);
}

TEST(DebugPicture, VarianceIsTheRelativeErrorInPerCent) {
  // Standard error 0.02 of mean 1: 0.02 / (1 + 0.01) = 1.98 per cent on a scale that ends at 2.
  const FilmPixels film = halves(32, 0.0004);
  const Image image = debugPicture(DebugView::Variance, film);
  const float part = float(0.02 / 1.01 * 100.0 / 2.0);
  EXPECT_LE(glm::distance(colorAt(image, 5, 0), glm::vec3(1.0f, 4.0f - 4.0f * part, 0.0f)), 1e-5f);
  EXPECT_LE(glm::distance(colorAt(image, 30, 0), glm::vec3(0.0f, 0.0f, 0.25f)), 1e-6f);
  // A better estimate takes the place of the film's own.
  const std::vector<double> better(film.pixels.size(), 0.0001 * 1.01 * 1.01);
  const Image other = debugPicture(DebugView::Variance, film, better);
  EXPECT_EQ(colorAt(other, 5, 0), colorAt(other, 30, 0));
  EXPECT_LE(glm::distance(colorAt(other, 5, 0), glm::vec3(1.0f, 0.0f, 0.0f)), 1e-5f);
}

TEST(DebugPicture, ABlackPictureHasNoError) {
  FilmPixels film = halves(32, 0.0);
  for (FilmPixel& pixel : film.pixels) pixel.sum = glm::dvec3(0.0);
  const Image image = debugPicture(DebugView::Variance, film);
  for (const float value : image.values) EXPECT_TRUE(std::isfinite(value));
}

TEST(DebugPicture, VisitsKeepTheirNumbers) {
  const Image image =
      debugPicture(DebugView::Visits, filmOf({2, 40}, std::vector<glm::dvec3>(80, glm::dvec3(7.0))));
  ASSERT_EQ(image.channels.back(), "visits");
  EXPECT_EQ(image.pixel(0, 0)[3], 7.0f);
}

TEST(DebugViews, RowsStandInTheirOrder) {
  for (const DebugViewRow& row : kDebugViewRows) {
    EXPECT_FALSE(row.label.empty());
    // A view of a layer has the layer's name.
    if (row.aov != Aov::None) {
      EXPECT_EQ(row.name, rowOf(row.aov).name);
    }
  }
  EXPECT_EQ(rowOf(DebugView::Variance).name, "variance");
  EXPECT_EQ(rowOf(Aov::Texcoords).name, "texcoords");
}

}  // namespace
}  // namespace fragtrace
