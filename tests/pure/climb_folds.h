// SPDX-License-Identifier: MIT
// Triangles that meet in creases, made of genes, and rays that leave one of them next to a crease.
#pragma once

#include <optional>
#include <vector>

#include "bvh_triangles.h"
#include "climb.h"
#include "scene/creases.h"
#include "shader_one_triangle.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;

inline constexpr double kLeastAngle = glm::radians(0.5);
inline constexpr double kMostAngle = glm::radians(133.0);

/// Triangles around an edge or a point, the first of which a ray leaves, and a point in front of all.
struct Fold {
  std::vector<std::array<vec3, 3>> faces;
  dvec3 inside;
};

/// From the space of a crease to that of the scene, by genes.
struct Turn {
  explicit Turn(Genes& g) : size(g.scale(0x1p-12, 1.0)), origin(g.inCube(1.0)), rotation(g.rotation()) {}
  vec3 operator()(const dvec3& p) const { return vec3(exact(p)); }
  dvec3 exact(const dvec3& p) const { return origin + size * (rotation * p); }

  double size;
  dvec3 origin;
  glm::dquat rotation;
};

/// Two triangles with a common edge along z, of length 1, which look into the wedge between them.
inline Fold wedgeOf(Genes& g, const Turn& turn) {
  const double angle = g.scale(kLeastAngle, kMostAngle);
  const auto third = [&](double direction) {
    const double away = g.scale(0x1p-6, 4.0);
    return dvec3(away * std::cos(direction), away * std::sin(direction), g.between(-1.0, 2.0));
  };
  const vec3 a = turn(dvec3(0.0));
  const vec3 b = turn({0, 0, 1});
  const vec3 low = turn(third(0.0));
  const vec3 high = turn(third(angle));
  const double middle = angle * g.between(0.05, 0.95);
  const double away = g.scale(0x1p-8, 256.0);
  return {{{a, b, low}, {b, a, high}},
          turn.exact({away * std::cos(middle), away * std::sin(middle), g.between(0.0, 1.0)})};
}

/// A cone over a convex polygon, seen from inside, with its point in the origin.
inline Fold coneOf(Genes& g, const Turn& turn) {
  const int count = 3 + int(g.take() * 5.99);
  const double width = g.scale(0.02, 2.0);
  const double height = g.scale(0.02, 2.0);
  const dvec3 middle(g.between(-1, 1), g.between(-1, 1), 1.0);
  std::vector<double> steps(static_cast<size_t>(count));
  double all = 0.0;
  for (double& step : steps) step = all += g.between(0.1, 1.0);
  Fold fold;
  const auto rim = [&](double part) {
    const double angle = glm::two_pi<double>() * part;
    return turn(middle + dvec3(width * std::cos(angle), height * std::sin(angle), 0.0));
  };
  for (size_t i = 0; i < steps.size(); ++i)
    fold.faces.push_back({turn(dvec3(0.0)), rim(steps[i] / all), rim(steps[(i + 1) % steps.size()] / all)});
  fold.inside = turn.exact(middle * g.between(0.1, 0.95));
  return fold;
}

inline Scene sceneOf(const Fold& fold) {
  Scene scene;
  for (const auto& face : fold.faces) {
    const auto first = uint32_t(scene.vertices.position.size());
    for (const vec3& p : face) scene.vertices.position.push_back(p);
    scene.triangles.push_back({{first, first + 1, first + 2}, 0, true});
  }
  return scene;
}

inline dvec3 pointWith(const std::array<vec3, 3>& v, const glm::dvec2& w) {
  return dvec3(v[0]) + w.x * (dvec3(v[1]) - dvec3(v[0])) + w.y * (dvec3(v[2]) - dvec3(v[0]));
}

inline double leastAltitude(const std::array<vec3, 3>& v) {
  const dvec3 a = dvec3(v[1]) - dvec3(v[0]);
  const dvec3 b = dvec3(v[2]) - dvec3(v[0]);
  const double longest = std::max({glm::length(a), glm::length(b), glm::length(b - a)});
  return longest > 0.0 ? glm::length(glm::cross(a, b)) / longest : 0.0;
}

/// Returns true if all faces are as wide as their insets need, and no two meet more narrowly than promised.
inline bool isPromised(const Fold& fold) {
  double leastSine = 1.0;
  double largest = 0.0;
  for (const auto& a : fold.faces) {
    largest = std::max(largest, hitPointError(a));
    for (const auto& b : fold.faces) {
      if (&a == &b) continue;
      const dvec3 na = normalOf(a);
      const dvec3 nb = normalOf(b);
      if (glm::dot(na, nb) < 0.0) leastSine = std::min(leastSine, glm::length(glm::cross(na, nb)));
    }
  }
  const double inset = 2.0 * 1.25 * largest / leastSine;
  return leastSine > std::sin(kLeastAngle) && std::ranges::all_of(fold.faces, [&](const auto& v) {
           return leastAltitude(v) > 16.0 * inset && !isSliver(v);
         });
}

/// A point next to a crease of the first face, near the edge from vertex 0 to 1, or near vertex 0.
inline dvec3 besideCrease(const std::array<vec3, 3>& v, Genes& g) {
  const double near = std::min(0.5, g.scale(0x1p-6, 64.0) * hitPointError(v) / leastAltitude(v));
  const double along = g.take();
  return pointWith(
      v, g.take() < 0.5 ? glm::dvec2(along * (1.0 - near), near) : near * glm::dvec2(along, 1.0 - along));
}

/// The hit of a ray on one face, as intersectLeaf of tree/leaf.glsl finds it.
inline auto hitOn(const std::array<vec3, 3>& v, const vec3& origin, const vec3& direction) {
  return glsl_float::intersectWord(glsl_float::startTraversal(1e30f, 1), origin, direction,
                                   glsl_float::makeShear(direction), v[0], v[1], v[2], 0u, 0);
}

/// The origin of a ray that leaves the first face, as surface.glsl and path.glsl compute it. error: the
/// offset as it is packed. None where the arriving ray misses the face, or begins nearer to its plane than
/// rays do.
inline std::optional<dvec3> startOn(const Fold& fold, const vec3& origin, const vec3& direction,
                                    float error) {
  const std::array<vec3, 3>& v = fold.faces[0];
  if (glm::dot(normalOf(v), dvec3(origin) - dvec3(v[0])) < hitPointError(v)) return std::nullopt;
  const glm::vec4 plane = planeOf(v[0], v[1], v[2]);
  const vec3 normal(plane);
  const auto hit = hitOn(v, origin, direction);
  if (hit.t <= 0.0f) return std::nullopt;
  vec3 point = glsl_float::pointOnPlane(origin, direction, hit.t, normal, plane.w);
  const std::vector<uint32_t> insets = creaseInsets(sceneOf(fold));
  if (!insets.empty()) {
    const vec3 middle((dvec3(v[0]) + dvec3(v[1]) + dvec3(v[2])) / 3.0);
    point = glsl_float::insetFromCreases(point, hit.weights, middle, insets[0],
                                         glsl_float::insetTimes(hit.t, error));
  }
  return dvec3(glsl_float::offsetOrigin(point, error, normal, normal));
}

/// Returns true if the face lies behind a ray in floats that meets it well within its sides in double
/// precision. A ray that runs past the face in floats meets one next to it.
inline bool isBehind(const std::array<vec3, 3>& v, const vec3& origin, const vec3& direction) {
  const dvec3 normal = normalOf(v);
  const dvec3 d(direction);
  const double t = glm::dot(normal, dvec3(v[0]) - dvec3(origin)) / glm::dot(normal, d);
  const dvec3 point = dvec3(origin) + t * d;
  const double area = glm::length(glm::cross(dvec3(v[1]) - dvec3(v[0]), dvec3(v[2]) - dvec3(v[0])));
  for (size_t i = 0; i < 3; ++i) {
    const dvec3 a(v[i]);
    const double weight = glm::dot(normal, glm::cross(dvec3(v[(i + 1) % 3]) - a, point - a)) / area;
    if (!(weight > 0.01)) return false;
  }
  constexpr float kMissed = -1.0f;
  const float found = distanceTo(v, origin, direction);
  return found <= 0.0f && found != kMissed;
}

}  // namespace
}  // namespace fragtrace
