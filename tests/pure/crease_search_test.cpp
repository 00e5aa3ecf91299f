// SPDX-License-Identifier: MIT
// A search for rays that leave a triangle beside a crease and are not in front of its neighbours: pairs that
// share an edge, and pointed cones, whose faces share a vertex, of any angle, shape, place and size that
// docs/design/ray-origins.md promises. It is steered towards the least height over a neighbour's plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "bvh_triangles.h"
#include "scene/creases.h"
#include "shader_one_triangle.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double kImpossible = std::numeric_limits<double>::infinity();
/// Rays that graze more have points that are not promised to be in the triangle.
constexpr float kLeastCosine = 0x1p-10f;
constexpr double kLeastAngle = glm::radians(0.5);
constexpr double kMostAngle = glm::radians(133.0);

/// The numbers of 0 to 1 of which a case is made, taken one after the other.
struct Genes {
  std::array<double, 40> value;
  size_t next = 0;

  double take() { return value.at(next++); }
  double between(double least, double most) { return std::lerp(least, most, take()); }
  /// Uniform in the logarithm.
  double scale(double least, double most) { return std::exp(between(std::log(least), std::log(most))); }
};

/// Triangles around an edge or a point, the first of which a ray leaves, and a point in front of all.
struct Fold {
  std::vector<std::array<vec3, 3>> faces;
  dvec3 inside;
};

/// From the space of a crease to that of the scene, by genes.
struct Turn {
  explicit Turn(Genes& g)
      : size(g.scale(0x1p-12, 1.0)), origin(g.between(-1, 1), g.between(-1, 1), g.between(-1, 1)) {
    // A rotation that is uniform for uniform genes (Shoemake, Uniform Random Rotations, 1992).
    const double u = g.take();
    const double a = glm::two_pi<double>() * g.take();
    const double b = glm::two_pi<double>() * g.take();
    const double s = std::sqrt(1.0 - u);
    const double c = std::sqrt(u);
    rotation = glm::dquat(c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b));
  }
  vec3 operator()(const dvec3& p) const { return vec3(exact(p)); }
  dvec3 exact(const dvec3& p) const { return origin + size * (rotation * p); }

  double size;
  dvec3 origin;
  glm::dquat rotation;
};

/// Two triangles with a common edge along z, of length 1, which look into the wedge between them.
Fold wedgeOf(Genes& g, const Turn& turn) {
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
Fold coneOf(Genes& g, const Turn& turn) {
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

Scene sceneOf(const Fold& fold) {
  Scene scene;
  for (const auto& face : fold.faces) {
    const auto first = uint32_t(scene.vertices.position.size());
    for (const vec3& p : face) scene.vertices.position.push_back(p);
    scene.triangles.push_back({{first, first + 1, first + 2}, 0, true});
  }
  return scene;
}

dvec3 pointWith(const std::array<vec3, 3>& v, const glm::dvec2& w) {
  return dvec3(v[0]) + w.x * (dvec3(v[1]) - dvec3(v[0])) + w.y * (dvec3(v[2]) - dvec3(v[0]));
}

double leastAltitude(const std::array<vec3, 3>& v) {
  const dvec3 a = dvec3(v[1]) - dvec3(v[0]);
  const dvec3 b = dvec3(v[2]) - dvec3(v[0]);
  const double longest = std::max({glm::length(a), glm::length(b), glm::length(b - a)});
  return longest > 0.0 ? glm::length(glm::cross(a, b)) / longest : 0.0;
}

/// Returns true if all faces are as wide as their insets need, and no two meet more narrowly than promised.
bool isPromised(const Fold& fold) {
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

/// The origin of a ray that leaves the first face, as surface.glsl and path.glsl compute it. None where the
/// arriving ray misses the face, grazes it, or begins nearer to its plane than rays do.
std::optional<dvec3> startOn(const Fold& fold, Genes& g) {
  const std::array<vec3, 3>& v = fold.faces[0];
  const double error = hitPointError(v) * g.between(1.0, 1.25);
  // The point lies near the edge from vertex 0 to 1, or near vertex 0.
  const double near = std::min(0.5, g.scale(0x1p-6, 64.0) * error / leastAltitude(v));
  const double along = g.take();
  const glm::dvec2 aim =
      g.take() < 0.5 ? glm::dvec2(along * (1.0 - near), near) : near * glm::dvec2(along, 1.0 - along);
  const vec3 origin(fold.inside);
  if (glm::dot(normalOf(v), dvec3(origin) - dvec3(v[0])) < hitPointError(v)) return std::nullopt;
  const vec3 direction = glm::normalize(vec3(pointWith(v, aim) - dvec3(origin)));
  const glm::vec4 plane = planeOf(v[0], v[1], v[2]);
  const vec3 normal(plane);
  const auto hit = glsl_float::intersectWord(glsl_float::startTraversal(1e30f, 1), origin, direction,
                                             glsl_float::makeShear(direction), v[0], v[1], v[2], 0u, 0);
  if (hit.t <= 0.0f || glm::dot(direction, normal) > -kLeastCosine) return std::nullopt;
  vec3 point = glsl_float::pointOnPlane(origin, direction, hit.t, normal, plane.w);
  const std::vector<uint32_t> insets = creaseInsets(sceneOf(fold));
  if (!insets.empty()) {
    const vec3 middle((dvec3(v[0]) + dvec3(v[1]) + dvec3(v[2])) / 3.0);
    point = glsl_float::insetFromCreases(point, hit.weights, middle, insets[0],
                                         glsl_float::insetTimes(hit.t, float(error)));
  }
  return dvec3(glsl_float::offsetOrigin(point, float(error), normal, normal));
}

/// Returns true if the face lies behind a ray in floats that meets it well within its sides in double
/// precision. A ray that runs past the face in floats meets one beside it.
bool isBehind(const std::array<vec3, 3>& v, const vec3& origin, const vec3& direction) {
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

struct Trial {
  double height = kImpossible;  ///< least height over a neighbour's plane, in units of eps m
  bool leaks = false;           ///< a ray from there begins behind a neighbour, or finds it behind itself
};

Trial tried(Genes g) {
  const glsl_variant::With spheres(glsl_variant::kSpheres, false);
  const Turn turn(g);
  const Fold fold = g.take() < 0.5 ? wedgeOf(g, turn) : coneOf(g, turn);
  if (!isPromised(fold)) return {};
  const std::optional<dvec3> start = startOn(fold, g);
  if (!start) return {};
  Trial trial;
  const glm::dvec2 aim(g.between(0.02, 0.96), g.take());
  for (size_t i = 1; i < fold.faces.size(); ++i) {
    const std::array<vec3, 3>& v = fold.faces[i];
    const double unit = std::max(hitPointError(v), hitPointError(fold.faces[0])) / 32.0;
    trial.height = std::min(trial.height, glm::dot(normalOf(v), *start - dvec3(v[0])) / unit);
    const dvec3 target = pointWith(v, {aim.x, 0.02 + (0.96 - aim.x) * aim.y});
    const vec3 direction = glm::normalize(vec3(target - *start));
    trial.leaks = trial.leaks || trial.height <= 0.0 || isBehind(v, vec3(*start), direction);
  }
  return trial;
}

Genes drawGenes(Draw& draw) {
  Genes g{};
  for (double& value : g.value) value = double(draw.unit());
  return g;
}

/// A few genes change, by steps of many sizes.
Genes changed(const Genes& from, Draw& draw) {
  Genes g = from;
  const int count = draw.integer(1, 4);
  for (int i = 0; i < count; ++i) {
    double& value = g.value[size_t(draw.integer(0, int(g.value.size()) - 1))];
    const double step = std::exp2(-20.0 * double(draw.unit())) * (2.0 * double(draw.unit()) - 1.0);
    value = std::clamp(value + step, 0.0, 1.0);
  }
  return g;
}

long numberFrom(const char* variable, long otherwise) {
  const char* value = std::getenv(variable);
  return value != nullptr ? std::atol(value) : otherwise;
}

TEST(CreaseSearch, NoRayStartsBehindAFaceOrMissesIt) {
  constexpr int kClimb = 400;
  Draw draw(uint32_t(numberFrom("FRAGTRACE_ATTACK_SEED", 1)));
  const long cases = numberFrom("FRAGTRACE_ATTACK_RAYS", 6000) * 10;
  double least = kImpossible;
  long leaks = 0;
  long promised = 0;
  for (long k = 0; k < cases;) {
    Genes best = drawGenes(draw);
    double lowest = kImpossible;
    for (int i = 0; i < kClimb; ++i, ++k) {
      const Genes next = i < kClimb / 10 || lowest == kImpossible ? drawGenes(draw) : changed(best, draw);
      const Trial trial = tried(next);
      promised += trial.height < kImpossible ? 1 : 0;
      leaks += trial.leaks ? 1 : 0;
      if (trial.height > lowest) continue;
      lowest = trial.height;
      best = next;
    }
    least = std::min(least, lowest);
  }
  std::printf("%ld cases, %ld of them promised, least height %.3f eps m, %ld leaks\n", cases, promised, least,
              leaks);
  EXPECT_EQ(leaks, 0);
  EXPECT_GT(least, 0.0);
  EXPECT_GT(promised, cases / 2);
}

}  // namespace
}  // namespace fragtrace
