// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/attack_scenes.h"

#include "tests/instruments/rays/ball_scene.h"
#include "tests/instruments/rays/dice.h"

namespace fragtrace::attack {

namespace {

using glm::dvec3;
using glm::vec3;

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

Scene scaled(Scene scene, double factor) {
  scene.bounds = {};
  for (vec3& p : scene.vertices.position) {
    p = vec3(factor * dvec3(p));
    scene.bounds.include(dvec3(p));
  }
  return scene;
}

constexpr std::array kTiledLow{-1.7, 0.3, -2.2};
constexpr std::array kTiledHigh{1.1, 2.9, 0.9};

}  // namespace

std::array<dvec3, 3> corners(const Scene& scene, size_t triangle) {
  const glm::uvec3& v = scene.triangles[triangle].vertex;
  const std::vector<vec3>& p = scene.vertices.position;
  return {dvec3(p[v.x]), dvec3(p[v.y]), dvec3(p[v.z])};
}

double tileLine(int axis, int line) {
  const auto i = size_t(axis);
  return kTiledLow[i] + (kTiledHigh[i] - kTiledLow[i]) * line / kTiles;
}

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

Scene tinyRoom() { return scaled(room(), 1e-7); }
Scene hugeRoom() { return scaled(room(), 1e8); }

}  // namespace fragtrace::attack
