// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/ray_sets.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

#include "scene/camera.h"

namespace fragtrace {

namespace {

constexpr double kTwoPi = glm::two_pi<double>();
constexpr float kRayLimit = 1e30f;

double uniform(std::mt19937& random) { return double(random()) * 0x1p-32; }

/// The place that a primary ray has hit, and the normal on the ray's side.
struct Place {
  glm::dvec3 point;
  glm::dvec3 normal;
  double error;
};

Place placeOf(const ExactTracer& tracer, const Ray& ray, const ExactHit& hit) {
  Place place;
  place.point = glm::dvec3(ray.origin) + hit.t * glm::dvec3(ray.direction);
  place.normal = tracer.normal(hit.primitive, place.point);
  if (glm::dot(place.normal, glm::dvec3(ray.direction)) > 0.0) place.normal = -place.normal;
  place.error = tracer.pointError(hit.primitive);
  return place;
}

/// Unit; density cosine / pi over the half space of the normal.
glm::dvec3 cosineDirection(const glm::dvec3& normal, std::mt19937& random) {
  const double z = 1.0 - 2.0 * uniform(random);
  const double phi = kTwoPi * uniform(random);
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  const glm::dvec3 sum = normal + glm::dvec3(r * std::cos(phi), r * std::sin(phi), z);
  const double length = glm::length(sum);
  return length > 1e-6 ? sum / length : normal;
}

/// Points on the emissive triangles, uniform over their area; without any, of the scene's box.
class Targets {
 public:
  explicit Targets(const Scene& scene) : scene_(scene) {
    double sum = 0.0;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
      if (!scene.materials[scene.triangles[i].material].emissive()) continue;
      const auto [a, b, c] = cornersOf<glm::dvec3>(scene, scene.triangles[i]);
      sum += glm::length(glm::cross(b - a, c - a));
      lamps_.push_back(i);
      sums_.push_back(sum);
    }
    for (const glm::vec3& p : scene.vertices.position) box_.include(glm::dvec3(p));
    for (const Sphere& s : scene.spheres) {
      box_.include(glm::dvec3(s.center) - glm::dvec3(s.radius));
      box_.include(glm::dvec3(s.center) + glm::dvec3(s.radius));
    }
  }

  glm::dvec3 draw(std::mt19937& random) const {
    if (lamps_.empty() || !(sums_.back() > 0.0)) {
      const double x = uniform(random);
      const double y = uniform(random);
      const double z = uniform(random);
      return box_.minimum + glm::dvec3(x, y, z) * box_.extent();
    }
    const auto found = std::upper_bound(sums_.begin(), sums_.end(), uniform(random) * sums_.back());
    const size_t index = std::min(size_t(found - sums_.begin()), lamps_.size() - 1);
    const auto [a, b, c] = cornersOf<glm::dvec3>(scene_, scene_.triangles[lamps_[index]]);
    const double root = std::sqrt(uniform(random));
    const double v = root * uniform(random);
    return (1.0 - root) * a + (root - v) * b + v * c;
  }

 private:
  const Scene& scene_;
  std::vector<uint32_t> lamps_;
  std::vector<double> sums_;
  BoundsDouble box_;
};

}  // namespace

std::vector<Ray> primaryRays(const Camera& camera, const LocalSpace& space, glm::ivec2 size) {
  const Projection projection = projectionOf(camera, double(size.x) / size.y);
  std::vector<Ray> rays;
  rays.reserve(size_t(size.x) * size_t(size.y));
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec2 place = 2.0 * (glm::dvec2(x, y) + 0.5) / glm::dvec2(size) - 1.0;
      if (const std::optional<Ray> ray = rayThrough(projection, space, place)) rays.push_back(*ray);
    }
  }
  return rays;
}

std::vector<Ray> diffuseRays(const ExactTracer& tracer, std::span<const Ray> primary,
                             std::span<const ExactHit> hits, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Ray> rays(primary.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].primitive == kMissIndex) continue;
    const Place place = placeOf(tracer, primary[i], hits[i]);
    rays[i] = {glm::vec3(place.point + place.error * place.normal),
               glm::vec3(cosineDirection(place.normal, random)), kRayLimit};
  }
  return rays;
}

std::vector<Ray> shadowRays(const ExactTracer& tracer, const Scene& scene, std::span<const Ray> primary,
                            std::span<const ExactHit> hits, uint32_t seed) {
  // The ray ends before the target, so that it does not meet the target itself.
  constexpr double kShortOf = 1.0 - 1e-4;
  const Targets targets(scene);
  std::mt19937 random(seed);
  std::vector<Ray> rays(primary.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].primitive == kMissIndex) continue;
    const Place place = placeOf(tracer, primary[i], hits[i]);
    const glm::dvec3 target = targets.draw(random);
    if (glm::dot(target - place.point, place.normal) <= 0.0) continue;
    const glm::dvec3 origin = place.point + place.error * place.normal;
    const double distance = glm::length(target - origin);
    if (!(distance > 100.0 * place.error)) continue;
    rays[i] = {glm::vec3(origin), glm::vec3((target - origin) / distance), float(distance * kShortOf)};
  }
  return rays;
}

size_t countRays(std::span<const Ray> rays) {
  return size_t(std::count_if(rays.begin(), rays.end(), [](const Ray& ray) { return ray.limit > 0.0f; }));
}

}  // namespace fragtrace
