// SPDX-License-Identifier: MIT
#include "scene/casters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "base/vectors.h"

namespace fragtrace {

namespace {

/// Two balls replace one only if together they cover at most this share of its solid angle.
constexpr float kLeastSaving = 0.7f;
/// Light paths pay at glossy casters only where lamps are small. The measure is the variance without light
/// paths over the variance with them, at a ring of roughness 0.15 and at a ball of roughness 0.3. It is 81
/// and 3 for lamps of 0.002 sr, 5 and 3 for 0.02 sr, and 1.6 and 0.35 for 0.07 sr.
constexpr double kWidestLamps = 0.03;  // sr
constexpr size_t kBallsForWidth = 16;
constexpr size_t kMostPatches = 512;
constexpr double kHalfSphere = 2.0 * glm::pi<double>();

struct Group {
  std::vector<Ball> balls;
  Ball around;
};

Ball ballAround(const std::vector<Ball>& balls) {
  Bounds box;
  for (const Ball& b : balls) {
    box.include(b.middle - b.radius);
    box.include(b.middle + b.radius);
  }
  Ball around{box.center(), 0.0f};
  for (const Ball& b : balls)
    around.radius = std::max(around.radius, glm::distance(b.middle, around.middle) + b.radius);
  // This covers the rounding of sums in the shader.
  around.radius *= 1.0f + 1e-5f;
  return around;
}

Ball ballOfTriangle(const std::array<glm::vec3, 3>& corners) {
  Bounds box;
  for (const glm::vec3& c : corners) box.include(c);
  Ball ball{box.center(), 0.0f};
  for (const glm::vec3& c : corners) ball.radius = std::max(ball.radius, glm::distance(c, ball.middle));
  return ball;
}

/// The ball after a matrix, which stretches no direction by more than its norm.
Ball transformed(const Ball& ball, const glm::dmat4& matrix) {
  const glm::dmat3 turn(matrix);
  const double stretch =
      std::sqrt(glm::dot(turn[0], turn[0]) + glm::dot(turn[1], turn[1]) + glm::dot(turn[2], turn[2]));
  return {glm::vec3(matrix * glm::dvec4(ball.middle, 1.0)), float(double(ball.radius) * stretch)};
}

std::vector<Ball> ballsOfTriangles(const Scene& scene, const std::vector<Caster>& casters, size_t first,
                                   size_t count) {
  std::vector<Ball> balls;
  for (size_t i = first; i < first + count; ++i) {
    const Triangle& t = scene.triangles[i];
    if (casters[t.material] != Caster::None) balls.push_back(ballOfTriangle(cornersOf(scene, t)));
  }
  return balls;
}

/// Balls of spheres, and around the casters of each instance.
std::vector<Ball> ballsOfOthers(const Scene& scene, const std::vector<Caster>& casters) {
  std::vector<Ball> balls;
  for (const Sphere& s : scene.spheres) {
    if (casters[s.material] != Caster::None) balls.push_back({s.center, s.radius});
  }
  std::vector<std::vector<Ball>> ofMeshes;
  for (const SharedMesh& mesh : scene.sharedMeshes)
    ofMeshes.push_back(ballsOfTriangles(scene, casters, mesh.firstTriangle, mesh.triangleCount));
  for (const Instance& instance : scene.instances) {
    const std::vector<Ball>& own = ofMeshes[instance.mesh];
    if (!own.empty()) balls.push_back(transformed(ballAround(own), instance.toLocal));
  }
  return balls;
}

std::vector<Ball> allBalls(const Scene& scene, const std::vector<Caster>& casters) {
  std::vector<Ball> balls = ballsOfTriangles(scene, casters, 0, flatTriangleCount(scene));
  std::ranges::move(ballsOfOthers(scene, casters), std::back_inserter(balls));
  return balls;
}

/// The squared radius of a ball around a box.
float ballSquared(const Bounds& box) {
  const glm::vec3 half = box.extent() * 0.5f;
  return glm::dot(half, half);
}

/// A plane across an axis that divides balls by their middles.
struct Cut {
  int axis = 0;
  float place = 0.0f;
  float squared = std::numeric_limits<float>::infinity();  ///< radii of balls round both boxes, squared
};

/// The best of the planes between equal slices of the box of the middles: the one whose sides have the
/// smallest balls.
Cut bestCut(const std::vector<Ball>& balls) {
  constexpr int kSlices = 16;
  Bounds middles;
  for (const Ball& b : balls) middles.include(b.middle);
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = middles.minimum[axis];
    const float slice = middles.extent()[axis] / float(kSlices);
    if (slice <= 0.0f) continue;
    std::array<Bounds, kSlices> boxes;
    for (const Ball& b : balls) {
      Bounds& box = boxes[size_t(std::min(int((b.middle[axis] - low) / slice), kSlices - 1))];
      box.include(b.middle - b.radius);
      box.include(b.middle + b.radius);
    }
    std::array<Bounds, kSlices> above = boxes;
    for (size_t i = kSlices - 1; i-- > 0;) above[i].include(above[i + 1]);
    Bounds below;
    for (size_t i = 0; i + 1 < kSlices; ++i) {
      below.include(boxes[i]);
      const float squared = ballSquared(below) + ballSquared(above[i + 1]);
      if (squared < best.squared) best = {axis, low + slice * float(i + 1), squared};
    }
  }
  return best;
}

std::pair<Group, Group> halves(const Group& group) {
  const Cut cut = bestCut(group.balls);
  std::pair<Group, Group> parts;
  for (const Ball& b : group.balls)
    (b.middle[cut.axis] < cut.place ? parts.first : parts.second).balls.push_back(b);
  for (Group* part : {&parts.first, &parts.second}) {
    if (!part->balls.empty()) part->around = ballAround(part->balls);
  }
  return parts;
}

/// Returns at most `most` balls around these. Groups are divided breadth first, so that the largest ones are
/// divided before their number reaches the limit.
std::vector<Ball> fewBalls(std::vector<Ball> all, size_t most) {
  if (all.empty()) return {};
  std::vector<Group> groups{{std::move(all), {}}};
  groups[0].around = ballAround(groups[0].balls);
  for (size_t i = 0, tried = 0; groups.size() < most && tried < groups.size();) {
    const auto [first, second] = halves(groups[i]);
    const float whole = groups[i].around.radius * groups[i].around.radius;
    const bool parts =
        !first.balls.empty() && !second.balls.empty() &&
        first.around.radius * first.around.radius + second.around.radius * second.around.radius <
            kLeastSaving * whole;
    if (parts) {
      groups[i] = first;
      groups.push_back(second);
      tried = 0;
    } else {
      ++tried;
      i = (i + 1) % groups.size();
    }
  }
  std::vector<Ball> balls;
  balls.reserve(groups.size());
  for (const Group& group : groups) balls.push_back(group.around);
  return balls;
}

std::vector<Triangle> emissiveTriangles(const Scene& scene) {
  std::vector<Triangle> lamps;
  std::ranges::copy_if(scene.triangles, std::back_inserter(lamps),
                       [&](const Triangle& t) { return scene.materials[t.material].emissive(); });
  return lamps;
}

/// The solid angle, in sr, from which the light of lamps comes to a ball at most; infinite if one is inside.
double widthOfLamps(const Scene& scene, const std::vector<Triangle>& lamps, const Ball& ball) {
  double sum = 0.0;
  for (const Triangle& t : lamps) {
    const std::array<glm::dvec3, 3> c = cornersOf<glm::dvec3>(scene, t);
    const double distance = glm::distance((c[0] + c[1] + c[2]) / 3.0, glm::dvec3(ball.middle)) - ball.radius;
    if (distance <= 0.0) return std::numeric_limits<double>::infinity();
    sum += areaOf(c) / (distance * distance);
  }
  return sum;
}

/// A part of a surface.
struct Patch {
  glm::dvec3 place{0.0};
  double area = 0.0;
};

/// Patches of the flat triangles of such materials. Large triangles have many.
template <typename IsAsked>
std::vector<Patch> patchesOf(const Scene& scene, const IsAsked& isAsked) {
  std::vector<Triangle> triangles;
  std::ranges::copy_if(std::span(scene.triangles).first(flatTriangleCount(scene)),
                       std::back_inserter(triangles), [&](const Triangle& t) { return isAsked(t.material); });
  const auto share = double(kMostPatches) / double(std::max<size_t>(triangles.size(), 1));
  const size_t rows = std::clamp<size_t>(size_t(std::sqrt(share)), 1, 16);
  std::vector<Patch> patches;
  for (const Triangle& t : triangles) {
    const std::array<glm::dvec3, 3> c = cornersOf<glm::dvec3>(scene, t);
    const double area = areaOf(c) / double(rows * rows);
    // The triangles of a grid: those that point as the whole does, and those between them.
    for (size_t i = 0; i < rows; ++i) {
      for (size_t j = 0; j < 2 * (rows - i) - 1; ++j) {
        const double third = j % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
        const double u = (double(i) + third) / double(rows);
        const double v = (double(j / 2) + third) / double(rows);
        patches.push_back({c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]), area});
      }
    }
  }
  return patches;
}

/// As many of them as are looked at, which have the area of all.
std::vector<Patch> fewPatches(std::vector<Patch> all) {
  const size_t step = (all.size() + kMostPatches - 1) / kMostPatches;
  if (step <= 1) return all;
  std::vector<Patch> few;
  for (size_t i = 0; i < all.size(); i += step) few.push_back({all[i].place, all[i].area * double(step)});
  return few;
}

}  // namespace

Caster casterOf(const Material& m) {
  if (m.scattersInside() || m.scattersThinly() || m.unlit) return Caster::None;
  if (m.layered() || m.specularGlossiness || m.anisotropic()) return Caster::None;
  const bool metalOrGlass = m.transmissive() || m.metallicFactor > 0.0f;
  if (m.mirrorLike()) return metalOrGlass ? Caster::Smooth : Caster::None;
  const bool metal = m.metallicFactor == 1.0f;
  const bool glass =
      m.metallicFactor == 0.0f && m.transmissionFactor == 1.0f && !m.transmissionTexture.present();
  const bool oneLobe =
      (metal || glass) && !m.metallicRoughnessTexture.present() && m.diffuseTransmissionFactor == 0.0f;
  return oneLobe && m.roughnessFactor <= kMostGlossy ? Caster::Glossy : Caster::None;
}

std::vector<Caster> castersOf(const Scene& scene) {
  std::vector<Caster> casters;
  std::ranges::transform(scene.materials, std::back_inserter(casters), casterOf);
  if (std::ranges::count(casters, Caster::Glossy) == 0) return casters;
  const std::vector<Triangle> lamps = emissiveTriangles(scene);
  if (lamps.empty()) return casters;
  std::vector<Caster> glossy = casters;
  std::ranges::replace(glossy, Caster::Smooth, Caster::None);
  const std::vector<Ball> balls = fewBalls(allBalls(scene, glossy), kBallsForWidth);
  const bool wide = std::ranges::any_of(
      balls, [&](const Ball& ball) { return widthOfLamps(scene, lamps, ball) > kWidestLamps; });
  if (wide) std::ranges::replace(casters, Caster::Glossy, Caster::None);
  return casters;
}

bool areLampsWide(const Scene& scene, const std::vector<Caster>& casters) {
  if (!scene.lights.empty()) return false;
  const std::vector<Patch> lamps =
      fewPatches(patchesOf(scene, [&](uint32_t m) { return scene.materials[m].emissive(); }));
  std::vector<Patch> lit = patchesOf(scene, [&](uint32_t m) { return casters[m] != Caster::None; });
  for (const Ball& ball : ballsOfOthers(scene, casters)) {
    for (int side = 0; side < 6; ++side) {
      glm::dvec3 out(0.0);
      out[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
      lit.push_back({glm::dvec3(ball.middle) + double(ball.radius) * out, double(ball.radius) * ball.radius});
    }
  }
  double flux = 0.0;
  double widths = 0.0;  // weighted by the flux
  for (const Patch& patch : fewPatches(std::move(lit))) {
    double width = 0.0;
    for (const Patch& lamp : lamps) {
      const glm::dvec3 away = lamp.place - patch.place;
      width += std::min(lamp.area / glm::dot(away, away), kHalfSphere);
    }
    width = std::min(width, kHalfSphere);
    flux += patch.area * width;
    widths += patch.area * width * width;
  }
  return widths > kWidestLamps * flux;
}

std::vector<Ball> casterBalls(const Scene& scene, const std::vector<Caster>& casters, size_t most) {
  return fewBalls(allBalls(scene, casters), most);
}

}  // namespace fragtrace
