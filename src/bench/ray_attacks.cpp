// SPDX-License-Identifier: MIT
#include "bench/ray_attacks.h"

#include <algorithm>
#include <array>

#include "bench/ball_scene.h"
#include "bench/dice.h"
#include "bvh/exact_tracer.h"

namespace fragtrace {

namespace {

using glm::dvec3;
using glm::vec3;

constexpr float kFar = 1e30f;

Ray rayTo(const dvec3& origin, const dvec3& target) {
  const vec3 start(origin);
  return {start, vec3(glm::normalize(target - dvec3(start))), kFar};
}

Scene emptyScene() {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].doubleSided = true;
  return scene;
}

void add(Scene& scene, const dvec3& a, const dvec3& b, const dvec3& c) {
  const auto first = uint32_t(scene.vertices.position.size());
  for (const dvec3& p : {a, b, c}) {
    scene.vertices.position.emplace_back(p);
    scene.bounds.include(dvec3(scene.vertices.position.back()));
  }
  scene.triangles.push_back({glm::uvec3(first, first + 1, first + 2), 0, true});
}

std::array<dvec3, 3> corners(const Scene& scene, size_t triangle) {
  const glm::uvec3& v = scene.triangles[triangle].vertex;
  const std::vector<vec3>& p = scene.vertices.position;
  return {dvec3(p[v.x]), dvec3(p[v.y]), dvec3(p[v.z])};
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

// ---- closed meshes ----

Scene ball() {
  Scene scene = makeBallScene(20000);
  for (Material& m : scene.materials) m.doubleSided = true;
  return scene;
}

Scene farBall() {
  Scene scene = ball();
  scene.bounds = {};
  for (vec3& p : scene.vertices.position) {
    p = vec3(dvec3(148376.0, 1234.0, -223423.0) + 100.0 * dvec3(p));
    scene.bounds.include(dvec3(p));
  }
  return scene;
}

AttackRays atRimsFromInside(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  std::vector<Ray> rays(count);
  const double near = 0.05 * scene.bounds.extent().x;
  for (Ray& ray : rays) {
    const dvec3 origin = scene.bounds.center() + dice.inCube(near);
    ray = rayTo(origin, pointOnRim(scene, dice.below(scene.triangles.size()), dice));
  }
  return {std::move(rays), {}};
}

AttackRays atRimsFromOutside(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  std::vector<Ray> rays(count);
  const double size = scene.bounds.extent().x;
  for (Ray& ray : rays) {
    const dvec3 origin = scene.bounds.center() + size * dice.between(1.0, 3.0) * dice.direction();
    ray = rayTo(origin, pointOnRim(scene, dice.below(scene.triangles.size()), dice));
  }
  return {std::move(rays), {}};
}

/// From 10 to 100,000 sizes of the scene away.
AttackRays fromFarAway(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  std::vector<Ray> rays(count);
  const double size = scene.bounds.extent().x;
  for (Ray& ray : rays) {
    const double away = size * std::pow(10.0, dice.between(1.0, 5.0));
    const size_t target = dice.below(scene.triangles.size());
    ray = rayTo(scene.bounds.center() + away * dice.direction(),
                dice.coin() ? pointOn(scene, target, dice) : pointOnRim(scene, target, dice));
  }
  return {std::move(rays), {}};
}

// ---- rays along axes and planes ----

/// Steps of quads that lie in planes of the axes.
Scene grid() {
  Scene scene = emptyScene();
  constexpr double kCell = 0.125;
  for (int x = -8; x < 8; ++x) {
    for (int z = -8; z < 8; ++z) {
      const dvec3 a = kCell * dvec3(x, (x % 3 + z % 2), z);
      const std::array<dvec3, 3> sides{dvec3(kCell, 0, 0), dvec3(0, kCell, 0), dvec3(0, 0, kCell)};
      for (size_t i = 0; i < 3; ++i) {
        const dvec3& right = sides[i];
        const dvec3& up = sides[(i + 1) % 3];
        add(scene, a, a + right, a + up);
        add(scene, a + right, a + right + up, a + up);
      }
    }
  }
  return scene;
}

/// Along an axis with zeros of both signs, or in a plane of two axes, through corners and middles; a few have
/// denormal components.
AttackRays alongAxes(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  std::vector<Ray> rays(count);
  const double size = scene.bounds.extent().x;
  for (size_t i = 0; i < count; ++i) {
    const size_t target = dice.below(scene.triangles.size());
    const dvec3 aim = dice.coin() ? pointOnRim(scene, target, dice) : pointOn(scene, target, dice);
    const int axis = int(dice.below(3));
    vec3 direction(dice.coin() ? 0.0f : -0.0f, dice.coin() ? 0.0f : -0.0f, dice.coin() ? 0.0f : -0.0f);
    direction[axis] = dice.coin() ? 1.0f : -1.0f;
    if (i % 3 == 1) direction[(axis + 1) % 3] = float(dice.between(-1.0, 1.0));
    if (i % 7 == 0) direction[(axis + 2) % 3] = 1e-41f;
    direction = vec3(glm::normalize(dvec3(direction)));
    rays[i] = {vec3(aim), direction, kFar};
    rays[i].origin[axis] = float(aim[axis] - size * double(direction[axis]));
    if (i % 3 == 1)
      rays[i].origin[(axis + 1) % 3] = float(aim[(axis + 1) % 3] - size * double(direction[(axis + 1) % 3]));
  }
  return {std::move(rays), {}};
}

Scene scattered() {
  Dice dice(7);
  Scene scene = emptyScene();
  for (int i = 0; i < 1500; ++i) {
    const dvec3 place = dice.inCube(1.0);
    const dvec3 a = place + dice.inCube(0.15);
    const dvec3 b = place + dice.inCube(0.15);
    add(scene, a, b, place + dice.inCube(0.15));
  }
  return scene;
}

/// In the plane of a triangle, towards it.
AttackRays inPlanes(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    const auto [a, b, c] = corners(scene, dice.below(scene.triangles.size()));
    const dvec3 aim = (a + b + c) / 3.0;
    const double turn = glm::two_pi<double>() * dice.unit();
    const dvec3 away = std::cos(turn) * (b - a) + std::sin(turn) * (c - a);
    ray = rayTo(aim + dice.between(2.0, 20.0) * away, aim);
  }
  return {std::move(rays), {}};
}

// ---- bad triangles ----

/// A metre long and a micrometre wide, some along axes.
Scene slivers() {
  Dice dice(11);
  Scene scene = emptyScene();
  for (int i = 0; i < 600; ++i) {
    const dvec3 a = dice.inCube(1.0);
    const int axis = i % 6;
    const dvec3 along = axis < 3 ? dvec3(axis == 0, axis == 1, axis == 2) : dice.direction();
    add(scene, a, a + along, a + dice.unit() * along + 1e-6 * dice.direction());
  }
  return scene;
}

/// Of no area, twenty times the same, and overlapping in one plane.
Scene flatAndDouble() {
  Dice dice(13);
  Scene scene = emptyScene();
  for (int i = 0; i < 40; ++i) {
    const dvec3 a = dice.inCube(1.0);
    const dvec3 b = a + dice.inCube(0.3);
    const dvec3 c = a + dice.inCube(0.3);
    for (int copy = 0; copy < 20; ++copy) add(scene, a, b, c);
    add(scene, a, b, a);
    add(scene, a, a, a);
    add(scene, a, 0.5 * (a + b), b);
  }
  for (int i = 0; i < 200; ++i) {
    const dvec3 a(dice.between(-1.0, 1.0), 0.25, dice.between(-1.0, 1.0));
    const dvec3 b = a + dvec3(dice.between(-0.5, 0.5), 0.0, dice.between(-0.5, 0.5));
    add(scene, a, b, a + dvec3(dice.between(-0.5, 0.5), 0.0, dice.between(-0.5, 0.5)));
  }
  return scene;
}

/// Ten kilometres beside a micrometre.
Scene hugeAndTiny() {
  Dice dice(17);
  Scene scene = emptyScene();
  for (int i = 0; i < 4; ++i) {
    const dvec3 a = 3.0 * dice.direction();
    add(scene, a + 1e4 * dice.direction(), a + 1e4 * dice.direction(), a + 1e4 * dice.direction());
  }
  for (int i = 0; i < 50; ++i) {
    const dvec3 place = dice.inCube(1.0);
    const double size = std::pow(10.0, dice.between(-6.0, -1.0));
    const dvec3 a = place + size * dice.direction();
    const dvec3 b = place + size * dice.direction();
    add(scene, a, b, place + size * dice.direction());
  }
  return scene;
}

/// Round one place, each smaller than the one before, down to a millionth of the first.
Scene nested() {
  Dice dice(19);
  Scene scene = emptyScene();
  for (int i = 0; i < 40; ++i) {
    const double size = std::pow(1.4, -i);
    const dvec3 a = size * dice.direction();
    const dvec3 b = size * dice.direction();
    add(scene, a, b, -a - b);
  }
  return scene;
}

AttackRays fromAnywhere(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  std::vector<Ray> rays(count);
  for (size_t i = 0; i < count; ++i) {
    const size_t target = dice.below(scene.triangles.size());
    const dvec3 origin = i % 4 == 0
                             ? pointOn(scene, dice.below(scene.triangles.size()), dice) + dice.inCube(1e-3)
                             : dice.inCube(3.0);
    dvec3 aim = origin + dice.direction();
    if (i % 3 == 1) aim = pointOn(scene, target, dice);
    if (i % 3 == 2) aim = pointOnRim(scene, target, dice);
    rays[i] = rayTo(origin, aim);
  }
  return {std::move(rays), {}};
}

// ---- spheres ----

Scene spheres() {
  Dice dice(23);
  Scene scene = emptyScene();
  for (int i = 0; i < 100; ++i) {
    Sphere sphere;
    sphere.center = vec3(dice.inCube(2.0));
    sphere.radius = float(std::pow(10.0, dice.between(-3.0, 0.0)));
    scene.spheres.push_back(sphere);
    scene.bounds.include(dvec3(sphere.center) - dvec3(sphere.radius));
    scene.bounds.include(dvec3(sphere.center) + dvec3(sphere.radius));
  }
  return scene;
}

/// From inside, from the surface, and from up to 100,000 radii away.
AttackRays atSpheres(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  std::vector<Ray> rays(count);
  for (size_t i = 0; i < count; ++i) {
    const Sphere& s = scene.spheres[dice.below(scene.spheres.size())];
    const dvec3 center(s.center);
    const double away = i % 3 == 0   ? dice.unit()
                        : i % 3 == 1 ? 1.0 + 1e-4
                                     : std::pow(10.0, dice.between(0.1, 5.0));
    rays[i] = rayTo(center + away * double(s.radius) * dice.direction(),
                    center + dice.unit() * double(s.radius) * dice.direction());
  }
  return {std::move(rays), {}};
}

// ---- few triangles: literals, and the largest before a tree ----

void addBox(Scene& scene, const dvec3& low, const dvec3& high) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      std::array<dvec3, 4> c;
      for (size_t i = 0; i < 4; ++i) {
        dvec3 w(side);
        w[(axis + 1) % 3] = i == 0 || i == 3 ? 0.0 : 1.0;
        w[(axis + 2) % 3] = i < 2 ? 0.0 : 1.0;
        c[i] = low + w * (high - low);
      }
      add(scene, c[0], c[1], c[2]);
      add(scene, c[2], c[3], c[0]);
    }
  }
}

/// A closed room with two boxes, off the origin, turned so that nothing is along an axis.
Scene room() {
  Scene straight = emptyScene();
  addBox(straight, dvec3(-2.0), dvec3(2.0));
  addBox(straight, dvec3(-1.3, -2.0, -0.7), dvec3(-0.2, 0.1, 0.5));
  addBox(straight, dvec3(0.3, -2.0, -0.1), dvec3(1.4, -0.9, 1.1));
  Scene scene = emptyScene();
  const dvec3 x = glm::normalize(dvec3(1.0, 0.3, -0.2));
  const dvec3 y = glm::normalize(glm::cross(dvec3(0.1, 0.2, 1.0), x));
  const dvec3 z = glm::cross(x, y);
  for (size_t i = 0; i < straight.triangles.size(); ++i) {
    std::array<dvec3, 3> p = corners(straight, i);
    for (dvec3& v : p) v = dvec3(0.7, -1.1, 3.0) + v.x * x + v.y * y + v.z * z;
    add(scene, p[0], p[1], p[2]);
  }
  return scene;
}

Scene scaled(Scene scene, double factor) {
  scene.bounds = {};
  for (vec3& p : scene.vertices.position) {
    p = vec3(factor * dvec3(p));
    scene.bounds.include(dvec3(p));
  }
  return scene;
}

constexpr int kTiles = 24;  // along each side of a wall
constexpr std::array kTiledLow{-1.7, 0.3, -2.2};
constexpr std::array kTiledHigh{1.1, 2.9, 0.9};

double tileLine(int axis, int line) {
  const auto i = size_t(axis);
  return kTiledLow[i] + (kTiledHigh[i] - kTiledLow[i]) * line / kTiles;
}

/// A closed room along the axes, its walls cut into tiles: neighbours' boxes meet in planes.
Scene tiledRoom() {
  Scene scene = emptyScene();
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const int side : {0, kTiles}) {
      const auto corner = [&](int i, int j) {
        dvec3 p;
        p[axis] = tileLine(axis, side);
        p[u] = tileLine(u, i);
        p[v] = tileLine(v, j);
        return p;
      };
      for (int i = 0; i < kTiles; ++i) {
        for (int j = 0; j < kTiles; ++j) {
          add(scene, corner(i, j), corner(i + 1, j), corner(i, j + 1));
          add(scene, corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
        }
      }
    }
  }
  return scene;
}

/// Along an axis, in the planes in which the boxes of tiles meet.
AttackRays betweenTiles(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    const int axis = int(dice.below(3));
    const int u = (axis + (dice.coin() ? 1 : 2)) % 3;
    const int v = 3 - axis - u;
    dvec3 origin;
    origin[axis] = scene.bounds.center()[axis] + dice.between(-0.3, 0.3);
    origin[u] = tileLine(u, 1 + int(dice.below(kTiles - 1)));
    const int line = 1 + int(dice.below(kTiles - 1));
    origin[v] = dice.coin() ? tileLine(v, line) : tileLine(v, line) + 0.01;
    ray = {vec3(origin), vec3(dice.coin() ? 0.0f : -0.0f), kFar};
    ray.direction[axis] = dice.coin() ? 1.0f : -1.0f;
  }
  return {std::move(rays), {}};
}

Scene tinyRoom() { return scaled(room(), 1e-7); }
Scene hugeRoom() { return scaled(room(), 1e8); }

AttackRays insideRoom(const Scene& scene, size_t count, uint32_t seed) {
  Dice dice(seed);
  std::vector<Ray> rays(count);
  const double size = scene.bounds.extent().x;
  for (size_t i = 0; i < count; ++i) {
    const dvec3 origin = scene.bounds.center() + dice.inCube(0.15 * size);
    const size_t target = dice.below(scene.triangles.size());
    rays[i] = rayTo(origin, i % 2 == 0 ? pointOnRim(scene, target, dice) : origin + dice.direction());
  }
  return {std::move(rays), {}};
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
    RayAttack{"rims-from-inside", "edges and vertices of a closed mesh, from inside", 0.0, true, ball,
              atRimsFromInside},
    RayAttack{"rims-far-away", "the same in coordinates of 300 km, without recentring", 0.0, true, farBall,
              atRimsFromInside},
    RayAttack{"rims-from-outside", "the same edges and vertices, from outside", 0.0, false, ball,
              atRimsFromOutside},
    RayAttack{"far-cameras", "a mesh from 10 to 100,000 of its sizes away", 0.0, false, ball, fromFarAway},
    RayAttack{"axes", "along axes and in planes of box faces, zeros of both signs, denormals", 0.0, false,
              grid, alongAxes},
    RayAttack{"in-plane", "in the plane of a triangle, towards it", 0.0, false, scattered, inPlanes},
    RayAttack{"slivers", "triangles of aspect 1,000,000", 0.0, false, slivers, fromAnywhere},
    RayAttack{"flat-and-double", "zero area, duplicates, overlaps in one plane", 0.0, false, flatAndDouble,
              fromAnywhere},
    RayAttack{"huge-and-tiny", "10 km beside a micrometre", 0.0, false, hugeAndTiny, fromAnywhere},
    RayAttack{"nested", "sizes in a geometric progression round one place", 0.0, false, nested, fromAnywhere},
    RayAttack{"spheres", "from inside, from the surface, from 100,000 radii away", 0.0, false, spheres,
              atSpheres},
    RayAttack{"leaving-mesh", "rays that leave a mesh, half of them grazing", 0.0, false, ball, leaving},
    RayAttack{"leaving-room", "the same of 36 large triangles", 0.0, false, room, leaving},
    RayAttack{"room", "edges, vertices and walls of a closed room of 36 triangles", 0.0, true, room,
              insideRoom},
    RayAttack{"tiles", "along axes, in the planes in which the boxes of neighbours meet", 0.0, true,
              tiledRoom, betweenTiles},
    RayAttack{"room-tiny", "the same of 500 nanometres", 0.0, true, tinyRoom, insideRoom},
    RayAttack{"room-huge", "the same of 500,000 km", 0.0, true, hugeRoom, insideRoom},
    RayAttack{"room-far-cameras", "the same from 10 to 100,000 of its sizes away", 0.0, false, room,
              fromFarAway},
};

}  // namespace

std::span<const RayAttack> rayAttacks() { return kAttacks; }

}  // namespace fragtrace
