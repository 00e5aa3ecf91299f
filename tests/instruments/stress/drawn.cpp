// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/drawn.h"

#include <glm/gtc/constants.hpp>

#include "base/text.h"
#include "scene/creases.h"

namespace fragtrace {

Environment whiteWorld(float radiance) {
  Environment world;
  world.kind = Surroundings::Map;
  world.image = {2, 1, {"R", "G", "B"}, std::vector<float>(6, radiance), {}};
  return world;
}

RenderOptions optionsOf(const StressSetting& setting, Stage stage) {
  RenderOptions options;
  options.stages = stagesUpTo(stage);
  options.stages.set(size_t(Stage::Watertight), setting.watertight);
  options.device.schedule = setting.schedule;
  return options;
}

SceneDrawing drawingOf(const StressSetting& setting, Scene scene, const Environment& environment,
                       RenderOptions options) {
  settleCreases(scene);
  options.device.shaderFolder = setting.shaderFolder;
  return {setting.context, scene, options, environment};
}

void countLight(const FilmPixels& film, StressOutcome& outcome) {
  for (const FilmPixel& p : film.pixels) {
    outcome.cases += p.samples;
    outcome.failures += p.sum != glm::dvec3(0.0) || p.nonfinite > 0 ? 1 : 0;
  }
  outcome.worst = formatted("light in %zu pixels", outcome.failures);
}

std::vector<View> viewsAround(const glm::dvec3& position, uint32_t seed) {
  std::vector<View> views;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      View view;
      view.camera.position = position;
      view.camera.forward = glm::dvec3(0.0);
      view.camera.forward[axis] = sign;
      view.camera.up = glm::dvec3(0.0);
      view.camera.up[(axis + 1) % 3] = 1.0;
      view.camera.fovY = glm::half_pi<double>();
      view.seed = seed;
      views.push_back(view);
    }
  }
  return views;
}

}  // namespace fragtrace
