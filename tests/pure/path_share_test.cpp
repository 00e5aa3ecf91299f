// SPDX-License-Identifier: MIT
#include "render/film/path_share.h"

#include <gtest/gtest.h>

#include <initializer_list>

#include "film_samples.h"

namespace fragtrace {
namespace {

/// A small picture, and what one sample or light path of it costs and varies by.
struct Pilot {
  double cameraVariance = 0.0;  ///< of a sample
  double pathVariance = 0.0;    ///< of a picture with one light path per pixel
  double raysPerSample = 1.0;
  double raysPerPath = 1.0;
};

constexpr uint32_t kSamples = 16;
constexpr size_t kPixels = 64;

FilmPixels pilotFilm(double light, double variance, double raysPerSample) {
  FilmPixels film = emptyFilm({8, 8});
  for (FilmPixel& p : film.pixels) {
    p.samples = kSamples;
    p.rays = uint32_t(raysPerSample * kSamples);
    p.sum = glm::dvec3(light * kSamples);
    p.m2 = light * light * variance * (kSamples - 1.0);
  }
  return film;
}

/// The same with 4 light paths a pixel, as if each sample had brought a part of them.
FilmPixels withLightPaths(FilmPixels film, double variance) {
  film.lightPaths = 4 * kPixels;
  for (FilmPixel& p : film.pixels) p.m2 += variance / 4.0 * kSamples * (kSamples - 1.0);
  return film;
}

int chosenFor(const Pilot& pilot, double light = 1.0) {
  const FilmPixels camera = pilotFilm(light, pilot.cameraVariance, pilot.raysPerSample);
  return pixelsPerPath(camera, withLightPaths(camera, light * light * pilot.pathVariance), pilot.raysPerPath);
}

/// Variance times cost of a picture with one path for n pixels, where a path also draws points.
double productOf(const Pilot& pilot, double n) {
  return (pilot.cameraVariance + n * pilot.pathVariance) *
         (pilot.raysPerSample + (pilot.raysPerPath + 1.0) / n);
}

TEST(PathShare, NoOtherPowerOfTwoHasLessVarianceTimesCost) {
  for (const double camera : {0.01, 0.3, 1.0, 7.0, 300.0}) {
    for (const double path : {0.02, 1.0, 5.0}) {
      for (const double rays : {1.0, 6.0}) {
        const Pilot pilot{camera, path, 4.0, rays};
        const int chosen = chosenFor(pilot);
        for (int n = 1; n <= kMostPixelsPerPath; n *= 2)
          EXPECT_LE(productOf(pilot, chosen), 1.000001 * productOf(pilot, n))
              << camera << " " << path << " " << rays;
      }
    }
  }
}

TEST(PathShare, CameraPathsSufficeWithHalfOfTheVarianceTimesCostAndMostOfTheLight) {
  // All light comes through glass, so camera paths that leave it out bring none.
  const FilmPixels camera = pilotFilm(0.0, 0.0, 4.0);
  FilmPixels both = withLightPaths(pilotFilm(1.0, 0.0, 4.0), 2.0);
  const double product = productOf({0.0, 2.0, 4.0, 4.0}, 4);
  const auto suffice = [&](double share, double light) {
    return cameraPathsSuffice(camera, both, 4.0, 4,
                              pilotFilm(light, share * product / 4.0 / (light * light), 4.0));
  };
  EXPECT_TRUE(suffice(0.45, 1.0));
  EXPECT_FALSE(suffice(0.55, 1.0));
  EXPECT_FALSE(suffice(0.01, 0.4));
  // Light paths that have met few pixels leave the others dark, whose noise counts all the same.
  for (size_t p = 0; p < kPixels; ++p) {
    if (p % 4 != 0)
      both.pixels[p].sum = glm::dvec3(0.0);
    else
      both.pixels[p].sum *= 4.0;
  }
  EXPECT_TRUE(suffice(0.45, 1.0));
}

TEST(PathShare, TheUnitOfLightDoesNotMatter) {
  const Pilot pilot{0.4, 0.1, 4.0, 3.0};
  EXPECT_EQ(chosenFor(pilot), 2);
  EXPECT_EQ(chosenFor(pilot, 1e-4), 2);
  EXPECT_EQ(chosenFor(pilot, 1e4), 2);
}

TEST(PathShare, WithoutAnyLightOfLightPathsTheirNumberStays) {
  EXPECT_EQ(chosenFor({1.0, 0.0, 4.0, 3.0}), kPixelsPerPath);
  EXPECT_EQ(chosenFor({0.0, 1.0, 4.0, 3.0}), kPixelsPerPath);
  EXPECT_EQ(chosenFor({1.0, 1.0, 4.0, 3.0}, 0.0), kPixelsPerPath);
}

}  // namespace
}  // namespace fragtrace
