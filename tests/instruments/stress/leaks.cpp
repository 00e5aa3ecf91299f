// SPDX-License-Identifier: MIT
// Shells of which docs/design/ray-origins.md says that they leak: how much they do.
#include "tests/instruments/stress/rows.h"

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>

#include "tests/instruments/stress/prism.h"

namespace fragtrace {

namespace {

using glm::dvec3;

/// A closed prism of so many sides, of radius 1, along z.
Prism makeColumn(uint32_t sides, double length, Dice& dice) {
  Prism p;
  p.turn = randomRotation(dice);
  p.place = dice.inCube(0.5);
  p.inside = p.turn * dvec3(dice.between(-0.3, 0.3), dice.between(-0.3, 0.3), 0.0) + p.place;
  for (uint32_t i = 0; i < sides; ++i) {
    const double angle = glm::two_pi<double>() * i / sides;
    for (const double z : {-0.5, 0.5}) p.add({std::cos(angle), std::sin(angle), length * z});
  }
  for (uint32_t i = 0; i < sides; ++i) {
    const uint32_t next = (i + 1) % sides;
    p.quad(2 * i, 2 * next, 2 * next + 1, 2 * i + 1);
    if (i < 2) continue;
    p.face(0, 2 * i, 2 * (i - 1));
    p.face(1, 2 * (i - 1) + 1, 2 * i + 1);
  }
  return p;
}

/// The number of a corner in a triangle.
std::optional<int> cornerOf(const Triangle& t, uint32_t vertex) {
  for (int k = 0; k < 3; ++k)
    if (t.vertex[k] == vertex) return k;
  return {};
}

/// Cuts a triangle in two by a line from its third corner to a point of the edge from `a` to `b`.
void cutAt(Scene& scene, size_t triangle, uint32_t a, uint32_t b, uint32_t point) {
  Triangle other = scene.triangles[triangle];
  scene.triangles[triangle].vertex[*cornerOf(other, b)] = point;
  other.vertex[*cornerOf(other, a)] = point;
  scene.triangles.push_back(other);
}

/// Cuts random edges of random triangles at random places, each edge in all its triangles, so that the mesh
/// stays closed. A thousand cuts leave triangles of all sizes down to a ten-thousandth.
void cutAtRandom(Prism& p, int count, Dice& dice) {
  Scene& scene = p.scene;
  for (int i = 0; i < count; ++i) {
    const Triangle& t = scene.triangles[dice.below(scene.triangles.size())];
    const int corner = int(dice.below(3));
    const uint32_t a = t.vertex[corner];
    const uint32_t b = t.vertex[(corner + 1) % 3];
    const dvec3 from(scene.vertices.position[a]);
    const auto point = uint32_t(scene.vertices.position.size());
    scene.vertices.position.emplace_back(from + dice.unit() * (dvec3(scene.vertices.position[b]) - from));
    const size_t triangles = scene.triangles.size();
    for (size_t k = 0; k < triangles; ++k)
      if (cornerOf(scene.triangles[k], a) && cornerOf(scene.triangles[k], b)) cutAt(scene, k, a, b, point);
  }
}

/// Adds a square sheet with a random direction that cuts through a box of 1 x 1 x 1 and stands out of it.
void addSheet(Prism& box, Dice& dice) {
  const dvec3 normal = dice.direction();
  const dvec3 side = glm::normalize(glm::cross(normal, dice.direction()));
  const dvec3 up = glm::cross(normal, side);
  const dvec3 middle = box.scene.bounds.center() + 0.2 * dice.direction();
  std::array<uint32_t, 4> p{};
  for (uint32_t i = 0; i < 4; ++i) {
    const dvec3 corner = middle + ((i & 1u) != 0 ? side : -side) + ((i & 2u) != 0 ? up : -up);
    p[i] = box.add(glm::inverse(box.turn) * (corner - box.place));
  }
  box.quad(p[0], p[1], p[3], p[2]);
}

StressOutcome scatterInColumns(const StressSetting& setting, double length, uint32_t seed) {
  Dice dice(seed + setting.seed * kSeedStride);
  StressOutcome outcome;
  for (const uint32_t sides : {3u, 4u}) {
    for (int i = 0; i < (setting.quick ? 1 : 10); ++i) {
      Prism p = makeColumn(sides, length, dice);
      cutAtRandom(p, 1000, dice);
      scatterIn(setting, p, false, outcome);
    }
  }
  return outcome;
}

}  // namespace

StressOutcome scatterInCutMeshes(const StressSetting& setting) { return scatterInColumns(setting, 1.0, 140); }

StressOutcome scatterInLongPrisms(const StressSetting& setting) {
  return scatterInColumns(setting, 20000.0, 160);
}

StressOutcome scatterInCrossedBoxes(const StressSetting& setting) {
  Dice dice(180 + setting.seed * kSeedStride);
  StressOutcome outcome;
  for (int i = 0; i < (setting.quick ? 2 : 20); ++i) {
    Prism box = makeBox(90.0, 1.0, true, dice);
    for (int sheet = 0; sheet < 5; ++sheet) addSheet(box, dice);
    scatterIn(setting, box, false, outcome);
  }
  return outcome;
}

}  // namespace fragtrace
