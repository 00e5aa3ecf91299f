// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/prism.h"

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fragtrace {

using glm::dvec3;

Prism::Prism() {
  scene.materials.resize(1);
  scene.materials[0].doubleSided = true;
}

uint32_t Prism::add(const dvec3& p) {
  scene.vertices.position.emplace_back(turn * p + place);
  scene.bounds.include(dvec3(scene.vertices.position.back()));
  return uint32_t(scene.vertices.position.size() - 1);
}

void Prism::face(uint32_t a, uint32_t b, uint32_t c) {
  if (a != b && b != c && c != a) scene.triangles.push_back({{a, b, c}, 0, true});
}

void Prism::quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  face(a, b, c);
  face(a, c, d);
}

glm::dquat randomRotation(Dice& dice) {
  return glm::angleAxis(dice.between(0.0, glm::two_pi<double>()), dice.direction());
}

Prism makeBox(double degrees, double length, bool turned, Dice& dice) {
  Prism w;
  if (turned) w.turn = randomRotation(dice);
  const dvec3 x(1.0, 0.0, 0.0);
  const dvec3 y(std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees)), 0.0);
  const dvec3 z(0.0, 0.0, length);
  const dvec3 low = dice.inCube(0.5) - 0.5 * (x + y + z);
  w.inside = w.turn * (low + dice.between(0.1, 0.9) * x + dice.between(0.1, 0.9) * y + 0.5 * z);
  std::array<uint32_t, 8> p{};
  for (uint32_t i = 0; i < 8; ++i)
    p[i] = w.add(low + double(i & 1u) * x + double(i >> 1 & 1u) * y + double(i >> 2) * z);
  w.quad(p[0], p[2], p[3], p[1]);
  w.quad(p[4], p[5], p[7], p[6]);
  w.quad(p[0], p[1], p[5], p[4]);
  w.quad(p[2], p[6], p[7], p[3]);
  w.quad(p[0], p[4], p[6], p[2]);
  w.quad(p[1], p[3], p[7], p[5]);
  return w;
}

void scatterIn(const StressSetting& setting, const Prism& prism, bool literals, StressOutcome& outcome) {
  RenderOptions options = optionsOf(setting, Stage::Gi);
  if (literals) options.device.traversal = TraversalMethod::Literals;
  SceneDrawing picture = drawingOf(setting, prism.scene, whiteWorld(1e4f), options);
  View view;
  view.camera.position = prism.inside;
  view.camera.forward = prism.turn * dvec3(-1.0, 0.0, 0.0);
  view.camera.up = prism.turn * dvec3(0.0, 0.0, 1.0);
  view.camera.fovY = glm::radians(100.0);
  view.bounces = 4;
  view.seed = setting.seed;
  const int side = setting.quick ? 64 : 128;
  countLight(picture.draw(setting.goOn, view, glm::ivec2(side), setting.quick ? 4 : 16), outcome);
}

}  // namespace fragtrace
