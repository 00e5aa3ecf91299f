// SPDX-License-Identifier: MIT
#include "stress/shell.h"

#include <cmath>

#include "bench/ball_scene.h"
#include "bench/formatted.h"
#include "stress/drawn.h"

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
  StressPicture picture(setting, scene, {}, optionsOf(setting, Stage::Flat));
  StressOutcome outcome;
  for (View view : viewsAround(place)) {
    view.background = glm::vec3(1.0f);
    view.showEnvironment = false;
    const FilmPixels film = picture.draw(view, pixels, samples);
    for (const FilmPixel& p : film.pixels) {
      outcome.cases += p.samples;
      outcome.failures += size_t(std::lround(p.sum.x)) + p.nonfinite;
    }
  }
  outcome.worst = formatted("%zu rays met nothing", outcome.failures);
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
  StressPicture picture(setting, scene, whiteWorld(1e4f), optionsOf(setting, Stage::Gi));
  StressOutcome outcome;
  for (View view : viewsAround(place)) {
    view.bounces = 4;
    const FilmPixels film = picture.draw(view, pixels, samples);
    for (const FilmPixel& p : film.pixels) {
      outcome.cases += p.samples;
      outcome.failures += p.sum != glm::dvec3(0.0) || p.nonfinite > 0 ? 1 : 0;
    }
  }
  outcome.worst = formatted("light in %zu pixels", outcome.failures);
  return outcome;
}

}  // namespace fragtrace
