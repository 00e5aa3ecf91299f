// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/ray_attacks.h"

#include <array>

#include "bvh/exact_tracer.h"
#include "tests/instruments/rays/attack_scenes.h"
#include "tests/instruments/rays/dice.h"

namespace fragtrace {

namespace {

using attack::corners;
using attack::kTiles;
using attack::tileLine;
using glm::dvec3;
using glm::vec3;

constexpr float kFar = 1e30f;

Ray rayTo(const dvec3& origin, const dvec3& target) {
  const vec3 start(origin);
  return {start, vec3(glm::normalize(target - dvec3(start))), kFar};
}

dvec3 pointOn(const Scene& scene, size_t triangle, Dice& dice) {
  const auto [a, b, c] = corners(scene, triangle);
  const double root = std::sqrt(dice.unit());
  const double v = root * dice.unit();
  return (1.0 - root) * a + (root - v) * b + v * c;
}

/// A vertex, or a point of an edge.
dvec3 pointOnRim(const Scene& scene, size_t triangle, Dice& dice) {
  const auto p = corners(scene, triangle);
  const size_t i = dice.below(3);
  const double along = dice.coin() ? 0.0 : dice.unit();
  return p[i] + along * (p[(i + 1) % 3] - p[i]);
}

/// Makes `count` rays, one after the other from the same random numbers.
template <typename MakeRay>
AttackRays raysFrom(size_t count, uint32_t seed, const MakeRay& makeRay) {
  Dice dice(seed);
  AttackRays attack;
  attack.rays.reserve(count);
  for (size_t i = 0; i < count; ++i) attack.rays.push_back(makeRay(dice, i));
  return attack;
}

// ---- closed meshes ----

AttackRays atRimsFromInside(const Scene& scene, size_t count, uint32_t seed) {
  const double near = 0.05 * scene.bounds.extent().x;
  return raysFrom(count, seed, [&](Dice& dice, size_t) {
    const dvec3 origin = scene.bounds.center() + dice.inCube(near);
    return rayTo(origin, pointOnRim(scene, dice.below(scene.triangles.size()), dice));
  });
}

AttackRays atRimsFromOutside(const Scene& scene, size_t count, uint32_t seed) {
  const double size = scene.bounds.extent().x;
  return raysFrom(count, seed, [&](Dice& dice, size_t) {
    const dvec3 origin = scene.bounds.center() + size * dice.between(1.0, 3.0) * dice.direction();
    return rayTo(origin, pointOnRim(scene, dice.below(scene.triangles.size()), dice));
  });
}

/// The rays begin 10 to 100,000 sizes of the scene away.
AttackRays fromFarAway(const Scene& scene, size_t count, uint32_t seed) {
  const double size = scene.bounds.extent().x;
  return raysFrom(count, seed, [&](Dice& dice, size_t) {
    const double away = size * std::pow(10.0, dice.between(1.0, 5.0));
    const size_t target = dice.below(scene.triangles.size());
    return rayTo(scene.bounds.center() + away * dice.direction(),
                 dice.coin() ? pointOn(scene, target, dice) : pointOnRim(scene, target, dice));
  });
}

// ---- rays along axes and planes ----

/// Along an axis with zeros of both signs, or in a plane of two axes, through corners and middles; a few have
/// denormal components.
AttackRays alongAxes(const Scene& scene, size_t count, uint32_t seed) {
  const double size = scene.bounds.extent().x;
  return raysFrom(count, seed, [&](Dice& dice, size_t i) {
    const size_t target = dice.below(scene.triangles.size());
    const dvec3 aim = dice.coin() ? pointOnRim(scene, target, dice) : pointOn(scene, target, dice);
    const int axis = int(dice.below(3));
    vec3 direction(dice.coin() ? 0.0f : -0.0f, dice.coin() ? 0.0f : -0.0f, dice.coin() ? 0.0f : -0.0f);
    direction[axis] = dice.coin() ? 1.0f : -1.0f;
    if (i % 3 == 1) direction[(axis + 1) % 3] = float(dice.between(-1.0, 1.0));
    if (i % 7 == 0) direction[(axis + 2) % 3] = 1e-41f;
    direction = vec3(glm::normalize(dvec3(direction)));
    Ray ray = {vec3(aim), direction, kFar};
    ray.origin[axis] = float(aim[axis] - size * double(direction[axis]));
    if (i % 3 == 1)
      ray.origin[(axis + 1) % 3] = float(aim[(axis + 1) % 3] - size * double(direction[(axis + 1) % 3]));
    return ray;
  });
}

/// The rays lie in the plane of a triangle, and point to it.
AttackRays inPlanes(const Scene& scene, size_t count, uint32_t seed) {
  return raysFrom(count, seed, [&](Dice& dice, size_t) {
    const auto [a, b, c] = corners(scene, dice.below(scene.triangles.size()));
    const dvec3 aim = (a + b + c) / 3.0;
    const double turn = glm::two_pi<double>() * dice.unit();
    const dvec3 away = std::cos(turn) * (b - a) + std::sin(turn) * (c - a);
    return rayTo(aim + dice.between(2.0, 20.0) * away, aim);
  });
}

AttackRays fromAnywhere(const Scene& scene, size_t count, uint32_t seed) {
  return raysFrom(count, seed, [&](Dice& dice, size_t i) {
    const size_t target = dice.below(scene.triangles.size());
    const dvec3 origin = i % 4 == 0
                             ? pointOn(scene, dice.below(scene.triangles.size()), dice) + dice.inCube(1e-3)
                             : dice.inCube(3.0);
    dvec3 aim = origin + dice.direction();
    if (i % 3 == 1) aim = pointOn(scene, target, dice);
    if (i % 3 == 2) aim = pointOnRim(scene, target, dice);
    return rayTo(origin, aim);
  });
}

// ---- spheres ----

/// The rays begin inside a sphere, on its surface, and up to 100,000 radii away.
AttackRays atSpheres(const Scene& scene, size_t count, uint32_t seed) {
  return raysFrom(count, seed, [&](Dice& dice, size_t i) {
    const Sphere& s = scene.spheres[dice.below(scene.spheres.size())];
    const dvec3 center(s.center);
    const double away = i % 3 == 0   ? dice.unit()
                        : i % 3 == 1 ? 1.0 + 1e-4
                                     : std::pow(10.0, dice.between(0.1, 5.0));
    return rayTo(center + away * double(s.radius) * dice.direction(),
                 center + dice.unit() * double(s.radius) * dice.direction());
  });
}

/// Along an axis, in the planes in which the boxes of tiles meet.
AttackRays betweenTiles(const Scene& scene, size_t count, uint32_t seed) {
  return raysFrom(count, seed, [&](Dice& dice, size_t) {
    const int axis = int(dice.below(3));
    const int u = (axis + (dice.coin() ? 1 : 2)) % 3;
    const int v = 3 - axis - u;
    dvec3 origin;
    origin[axis] = scene.bounds.center()[axis] + dice.between(-0.3, 0.3);
    origin[u] = tileLine(u, 1 + int(dice.below(kTiles - 1)));
    const int line = 1 + int(dice.below(kTiles - 1));
    origin[v] = dice.coin() ? tileLine(v, line) : tileLine(v, line) + 0.01;
    Ray ray = {vec3(origin), vec3(dice.coin() ? 0.0f : -0.0f), kFar};
    ray.direction[axis] = dice.coin() ? 1.0f : -1.0f;
    return ray;
  });
}

AttackRays insideRoom(const Scene& scene, size_t count, uint32_t seed) {
  const double size = scene.bounds.extent().x;
  return raysFrom(count, seed, [&](Dice& dice, size_t i) {
    const dvec3 origin = scene.bounds.center() + dice.inCube(0.15 * size);
    const size_t target = dice.below(scene.triangles.size());
    return rayTo(origin, i % 2 == 0 ? pointOnRim(scene, target, dice) : origin + dice.direction());
  });
}

/// From points of triangles, off them by the bound on a hit point's error; half of them graze.
AttackRays leaving(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  const Bvh none;
  const ExactTracer tracer(scene, none);
  AttackRays attack;
  for (size_t i = 0; i < count; ++i) {
    const auto from = uint32_t(dice.below(scene.triangles.size()));
    const dvec3 point = pointOn(scene, from, dice);
    const dvec3 side = (dice.coin() ? 1.0 : -1.0) * tracer.normal(from, point);
    dvec3 direction = dice.direction();
    const double height = std::abs(glm::dot(direction, side));
    const double kept = i % 2 == 0 ? 1.0 : std::pow(10.0, dice.between(-7.0, 0.0));
    direction = glm::normalize(direction + (kept * height - glm::dot(direction, side)) * side);
    attack.rays.push_back({vec3(point + tracer.pointError(from) * side), vec3(direction), kFar});
    attack.leaves.push_back(from);
  }
  return attack;
}

constexpr std::array kAttacks = {
    RayAttack{"rims-from-inside", "edges and vertices of a closed mesh, from inside", 0.0, true, attack::ball,
              atRimsFromInside},
    RayAttack{"rims-far-away", "the same in coordinates of 300 km, without recentring", 0.0, true,
              attack::farBall, atRimsFromInside},
    RayAttack{"rims-from-outside", "the same edges and vertices, from outside", 0.0, false, attack::ball,
              atRimsFromOutside},
    RayAttack{"far-cameras", "a mesh from 10 to 100,000 of its sizes away", 0.0, false, attack::ball,
              fromFarAway},
    RayAttack{"axes", "along axes and in planes of box faces, zeros of both signs, denormals", 0.0, false,
              attack::grid, alongAxes},
    RayAttack{"in-plane", "in the plane of a triangle, towards it", 0.0, false, attack::scattered, inPlanes},
    RayAttack{"slivers", "triangles of aspect 1,000,000", 0.0, false, attack::slivers, fromAnywhere},
    RayAttack{"flat-and-double", "zero area, duplicates, overlaps in one plane", 0.0, false,
              attack::flatAndDouble, fromAnywhere},
    RayAttack{"huge-and-tiny", "10 km beside a micrometre", 0.0, false, attack::hugeAndTiny, fromAnywhere},
    RayAttack{"nested", "sizes in a geometric progression round one place", 0.0, false, attack::nested,
              fromAnywhere},
    RayAttack{"spheres", "from inside, from the surface, from 100,000 radii away", 0.0, false,
              attack::spheres, atSpheres},
    RayAttack{"leaving-mesh", "rays that leave a mesh, half of them grazing", 0.0, false, attack::ball,
              leaving},
    RayAttack{"leaving-room", "the same of 36 large triangles", 0.0, false, attack::room, leaving},
    RayAttack{"room", "edges, vertices and walls of a closed room of 36 triangles", 0.0, true, attack::room,
              insideRoom},
    RayAttack{"tiles", "along axes, in the planes in which the boxes of neighbours meet", 0.0, true,
              attack::tiledRoom, betweenTiles},
    RayAttack{"room-tiny", "the same of 500 nanometres", 0.0, true, attack::tinyRoom, insideRoom},
    RayAttack{"room-huge", "the same of 500,000 km", 0.0, true, attack::hugeRoom, insideRoom},
    RayAttack{"room-far-cameras", "the same from 10 to 100,000 of its sizes away", 0.0, false, attack::room,
              fromFarAway},
};

}  // namespace

std::span<const RayAttack> rayAttacks() { return kAttacks; }

}  // namespace fragtrace
