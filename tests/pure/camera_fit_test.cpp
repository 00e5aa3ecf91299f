// SPDX-License-Identifier: MIT
#include "scene/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "scene/camera.h"

namespace fragtrace {
namespace {

/// Returns the part of the picture that the points take, from -1 to 1.
BoundsDouble placesOf(const Camera& camera, const std::vector<glm::dvec3>& points, double aspect) {
  const Projection projection = projectionOf(camera, aspect);
  BoundsDouble places;
  for (const glm::dvec3& point : points) {
    const glm::dvec3 p = projected(projection, point);
    EXPECT_GT(p.z, 0.0);
    places.include({p.x / p.z, p.y / p.z, 0.0});
  }
  return places;
}

/// Returns the depth of the point nearest to the camera, along the view.
double nearestDepth(const Camera& camera, const std::vector<glm::dvec3>& points) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const glm::dvec3& point : points)
    nearest = std::min(nearest, glm::dot(point - camera.position, camera.forward));
  return nearest;
}

std::vector<glm::dvec3> cloud(int count, const glm::dvec3& size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> points(size_t(count), glm::dvec3(100, -3, 7));
  for (glm::dvec3& point : points) point += size * glm::dvec3(normal(random), normal(random), normal(random));
  return points;
}

TEST(Fit, FillsThePictureFromAnySideWithAnyLensAndAspectRatio) {
  int tips = 0;
  for (unsigned i = 0; i < 300; ++i) {
    const auto points = cloud(3 + int(i % 50), {std::exp(i % 7), 1.0, std::exp(0.5 * (i % 5))}, i);
    const double aspect = std::exp(0.1 * (i % 31) - 1.5);
    CameraOverrides overrides{.orbit = Orbit{37.0 * i, double(i % 181) - 90.0}};
    if (i % 3 == 0) overrides.parallelScale = 1.0;
    if (i % 3 == 1) overrides.viewAngleDegrees = 5.0 + i % 120;
    BoundsDouble bounds;
    for (const glm::dvec3& point : points) bounds.include(point);
    if (i % 4 == 0) overrides.lensShift = {0.2 * (i % 5) - 0.4, 0.3};
    const Camera before = chooseCamera({}, {}, overrides, bounds, aspect);
    const Camera camera = fitted(before, points, aspect);
    EXPECT_EQ(camera.forward, before.forward);
    EXPECT_EQ(camera.fovY, before.fovY);
    const BoundsDouble places = placesOf(camera, points, aspect);
    const glm::dvec3 most = glm::max(places.maximum, -places.minimum);
    const double reach = std::max(most.x, most.y);
    EXPECT_LE(reach, kFitted + 1e-6) << i;
    // A tip that would touch the lens stays a little away, and with it all else.
    const bool isTip = nearestDepth(camera, points) < 0.0101 * glm::length(bounds.extent()) * 2.0;
    EXPECT_TRUE(isTip || reach > kFitted - 1e-6) << i << ": " << reach;
    tips += int(isTip && camera.type == CameraType::Perspective);
    EXPECT_NEAR(places.maximum.x, -places.minimum.x, 1e-6) << i;
    EXPECT_NEAR(places.maximum.y, -places.minimum.y, 1e-6) << i;
  }
  EXPECT_LT(tips, 60);
}

TEST(Fit, OfATurntableHoldsAllViewsAndFillsOne) {
  const auto points = cloud(40, {5, 1, 1}, 7);
  BoundsDouble bounds;
  for (const glm::dvec3& point : points) bounds.include(point);
  const double aspect = 1.6;
  const Camera start = chooseCamera({}, {}, {.orbit = Orbit{20, 25}}, bounds, aspect);
  const Camera camera = fitted(start, sweptAbout(bounds.center(), points), aspect);
  double most = 0.0;
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double angle = glm::radians(double(degrees));
    std::vector<glm::dvec3> turned;
    for (const glm::dvec3& point : points) {
      const glm::dvec3 p = point - bounds.center();
      turned.push_back(bounds.center() + glm::dvec3(std::cos(angle) * p.x + std::sin(angle) * p.z, p.y,
                                                    -std::sin(angle) * p.x + std::cos(angle) * p.z));
    }
    const BoundsDouble places = placesOf(camera, turned, aspect);
    const glm::dvec3 reach = glm::max(places.maximum, -places.minimum);
    most = std::max({most, reach.x, reach.y});
  }
  EXPECT_LE(most, kFitted);
  EXPECT_GT(most, 0.93);
}

TEST(Fit, FillsTheShareThatIsAskedFor) {
  const auto points = cloud(40, {5, 1, 1}, 7);
  BoundsDouble bounds;
  for (const glm::dvec3& point : points) bounds.include(point);
  for (const double share : {0.05, 0.5, 1.0}) {
    const Camera camera =
        fitted(chooseCamera({}, {}, {.orbit = Orbit{20, 25}}, bounds, 1.6), points, 1.6, share);
    const BoundsDouble places = placesOf(camera, points, 1.6);
    EXPECT_NEAR(std::max(places.maximum.x, places.maximum.y), share, 1e-6);
  }
}

TEST(Fit, StraysAreAHundredthFarAway) {
  std::vector<glm::dvec3> points = cloud(500, {1, 1, 1}, 3);
  const auto rest = points;
  points.emplace_back(100, -3, 2000);
  EXPECT_EQ(withoutStrays(points).size(), 496u);
  points.insert(points.end(), 5, glm::dvec3(100, -3, 2000));
  EXPECT_EQ(withoutStrays(points).size(), points.size());  // more than a hundredth
  points = rest;
  points.emplace_back(100, -3, 40);
  EXPECT_EQ(withoutStrays(points).size(), points.size());  // not far enough
  const std::vector<glm::dvec3> few(99, glm::dvec3(1.0));
  EXPECT_EQ(withoutStrays(few).size(), 99u);
}

TEST(Fit, TheFarthestPointsAreThoseOfASearchThroughAll) {
  const std::vector<glm::dvec3> points = cloud(10'000, {3, 1, 0.2}, 5);
  const std::vector<glm::dvec3> hull = farthest(points);
  const std::vector<glm::dvec3> directions = directionsAllAround();
  ASSERT_EQ(hull.size(), directions.size());
  for (size_t i = 0; i < hull.size(); ++i) {
    const auto along = [&](const glm::dvec3& point) { return glm::dot(point, directions[i]); };
    EXPECT_EQ(hull[i], *std::ranges::max_element(points, {}, along));
  }
}

TEST(Fit, FlatAndEmptyScenesHaveACamera) {
  const Camera camera = chooseCamera({}, {}, {}, {});
  EXPECT_EQ(fitted(camera, {}, 1.0).position, camera.position);
  const std::vector<glm::dvec3> one{{1, 2, 3}};
  EXPECT_EQ(fitted(camera, one, 1.0).position, camera.position);
  const std::vector<glm::dvec3> alongTheView{{0, 0, 0}, {0, 0, -5}};
  const Camera along = fitted(camera, alongTheView, 1.0);
  EXPECT_GT(along.position.z, 0.0);
  EXPECT_TRUE(std::isfinite(along.position.z));
}

}  // namespace
}  // namespace fragtrace
