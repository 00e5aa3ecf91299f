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

int chosenFor(const Pilot& pilot, double light = 1.0) {
  FilmPixels camera = emptyFilm({8, 8});
  for (FilmPixel& p : camera.pixels) {
    p.samples = kSamples;
    p.rays = uint32_t(pilot.raysPerSample * kSamples);
    p.sum = glm::dvec3(light * kSamples);
    p.m2 = light * light * pilot.cameraVariance * (kSamples - 1.0);
  }
  FilmPixels both = camera;
  both.lightPaths = 4 * kPixels;
  // The mean of 4 paths a pixel, as if each sample had brought a part of it.
  for (FilmPixel& p : both.pixels)
    p.m2 += light * light * pilot.pathVariance / 4.0 * kSamples * (kSamples - 1.0);
  return pixelsPerPath(camera, both, pilot.raysPerPath);
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
