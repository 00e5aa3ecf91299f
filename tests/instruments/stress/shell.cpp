// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/rows.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/text.h"
#include "tests/instruments/rays/ball_scene.h"
#include "tests/instruments/rays/dice.h"
#include "tests/instruments/stress/drawn.h"

namespace fragtrace {

namespace {

constexpr size_t kTriangles = 80000;

Scene shellAt(const glm::dvec3& place, double size, float color) {
  Scene scene = makeBallScene(kTriangles);
  scene.bounds = {};
  for (glm::vec3& p : scene.vertices.position) {
    p = glm::vec3(place + size * glm::dvec3(p));
    scene.bounds.include(glm::dvec3(p));
  }
  for (Material& m : scene.materials) {
    m.baseColorFactor = glm::vec4(glm::vec3(color), 1.0f);
    m.doubleSided = true;
  }
  return scene;
}

StressOutcome lookOut(const StressSetting& setting, const glm::dvec3& place, double size) {
  const glm::ivec2 pixels = setting.quick ? glm::ivec2(130) : glm::ivec2(1024);
  const int samples = setting.quick ? 10 : 16;
  const Scene scene = shellAt(place, size, 0.0f);
  SceneDrawing picture = drawingOf(setting, scene, {}, optionsOf(setting, Stage::Flat));
  StressOutcome outcome;
  for (View view : viewsAround(place, setting.seed)) {
    view.background = glm::vec3(1.0f);
    view.showEnvironment = false;
    const FilmPixels film = picture.draw(setting.goOn, view, pixels, samples);
    for (const FilmPixel& p : film.pixels) {
      outcome.cases += p.samples;
      outcome.failures += size_t(std::lround(p.sum.x)) + p.nonfinite;
    }
  }
  outcome.worst = formatted("%zu rays met nothing", outcome.failures);
  return outcome;
}

/// A spike on every triangle of a ball of 320, as one shared mesh; it holds the unit ball scaled by a
/// quarter.
Scene spikyMesh(Dice& dice) {
  const Scene ball = makeBallScene(320);
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].doubleSided = true;
  for (const glm::vec3& p : ball.vertices.position) scene.vertices.position.push_back(0.25f * p);
  for (const Triangle& t : ball.triangles) {
    const auto top = uint32_t(scene.vertices.position.size());
    glm::dvec3 middle(0.0);
    for (int i = 0; i < 3; ++i) middle += glm::dvec3(scene.vertices.position[t.vertex[i]]) / 3.0;
    scene.vertices.position.emplace_back(middle * dice.between(1.2, 3.0));
    for (int i = 0; i < 3; ++i)
      scene.triangles.push_back({{t.vertex[i], t.vertex[(i + 1) % 3], top}, 0, true});
  }
  scene.sharedMeshes.push_back({0, uint32_t(scene.triangles.size())});
  return scene;
}

/// Counts light in the six views around a place.
void scatterInside(const StressSetting& setting, SceneDrawing& picture, const glm::dvec3& place,
                   glm::ivec2 pixels, int samples, StressOutcome& outcome) {
  for (View view : viewsAround(place, setting.seed)) {
    view.bounces = 4;
    countLight(picture.draw(setting.goOn, view, pixels, samples), outcome);
  }
}

/// Traces paths inside spiky shells that are instances of one mesh.
StressOutcome scatterInShells(const StressSetting& setting, bool uneven) {
  constexpr size_t kShells = 8;
  const glm::ivec2 pixels = setting.quick ? glm::ivec2(32) : glm::ivec2(128);
  Dice dice(71 + setting.seed * kSeedStride);
  Scene scene = spikyMesh(dice);
  for (size_t i = 0; i < kShells; ++i) {
    // Half of the shells are near the origin, half far from it. None is within another.
    const glm::dvec3 place =
        glm::dvec3(20.0 * double(i), 0.0, 0.0) + (i % 2 == 0 ? glm::dvec3(0.0) : 1000.0 * dice.direction());
    const glm::dmat4 turned =
        glm::rotate(glm::translate(glm::dmat4(1.0), place), dice.between(0.0, 6.0), dice.direction());
    glm::dvec3 scale(dice.between(2.0, 8.0));
    if (uneven) scale *= glm::dvec3(1.0, dice.between(1.0, 3.0), dice.between(1.0, 3.0));
    scene.instances.push_back({glm::scale(turned, scale), 0, ""});
  }
  SceneDrawing picture = drawingOf(setting, scene, whiteWorld(1e4f), optionsOf(setting, Stage::Gi));
  StressOutcome outcome;
  for (const Instance& instance : scene.instances)
    scatterInside(setting, picture, glm::dvec3(instance.toLocal[3]), pixels, setting.quick ? 4 : 16, outcome);
  return outcome;
}

}  // namespace

StressOutcome lookOutOfBlackShell(const StressSetting& setting) {
  return lookOut(setting, glm::dvec3(0.0), 1.0);
}

StressOutcome lookOutOfFarShell(const StressSetting& setting) {
  return lookOut(setting, {148376.0, 1234.0, -223423.0}, 100.0);
}

StressOutcome scatterInWhiteShell(const StressSetting& setting) {
  const glm::ivec2 pixels = setting.quick ? glm::ivec2(40) : glm::ivec2(256);
  const int samples = setting.quick ? 4 : 16;
  // Surfaces near the origin have the smallest coordinates, and with them the smallest offsets of rays that
  // leave them.
  const glm::dvec3 place(1.0, 0.0, 0.0);
  const Scene scene = shellAt(place, 1.0, 1.0f);
  SceneDrawing picture = drawingOf(setting, scene, whiteWorld(1e4f), optionsOf(setting, Stage::Gi));
  StressOutcome outcome;
  scatterInside(setting, picture, place, pixels, samples, outcome);
  return outcome;
}

StressOutcome scatterInSharedShells(const StressSetting& setting) { return scatterInShells(setting, false); }

StressOutcome scatterInUnevenShells(const StressSetting& setting) { return scatterInShells(setting, true); }

}  // namespace fragtrace
