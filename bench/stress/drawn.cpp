// SPDX-License-Identifier: MIT
#include "bench/stress/drawn.h"

#include <glm/gtc/constants.hpp>

#include "bench/report/formatted.h"
#include "bvh/two_level.h"
#include "errors.h"
#include "gl/schedule.h"
#include "pack/literals.h"
#include "pack/pack_tree.h"
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

StressPicture::StressPicture(const StressSetting& setting, Scene scene, const Environment& environment,
                             const RenderOptions& options)
    : setting_(setting) {
  scene.insets = creaseInsets(scene);
  const bool iterative = options.device.traversal == TraversalMethod::Iterative;
  const Bvh bvh = iterative ? listLeaves(scene) : buildSceneBvh(scene);
  variant_ = chooseVariant(options, traitsOf(scene, environment.kind), environment.kind, bvh.depth,
                           BufferReads::Auto);
  GpuScene packed = packScene(scene, bvh, environment, variant_);
  if (options.device.traversal == TraversalMethod::Literals) {
    variant_.traversal = options.device.traversal;
    variant_.literals = literalScene(scene, bvh, packed, variant_);
  }
  variant_.reads = chooseReads(BufferReads::Auto, setting.context.software, packed, readLimits()).reads;
  chooseSchedule(variant_, options, {});
  renderer_ =
      std::make_unique<Renderer>(setting.context, std::move(packed), variant_.reads, setting.shaderFolder);
}

FilmPixels StressPicture::draw(const View& view, glm::ivec2 size, int samples) {
  Film film(size);
  renderer_->compile(variant_, film, view);
  RenderTimes times;
  renderer_->addSamples(film, view, 0, samples, times, [&](double) {
    setting_.goOn();
    return true;
  });
  FilmPixels pixels = film.read();
  if (totalsOf(pixels).budgetHits > 0) throw RenderError("the driver ended loops early (budget_hits)");
  return pixels;
}

void countLight(const FilmPixels& film, StressOutcome& outcome) {
  for (const FilmPixel& p : film.pixels) {
    outcome.cases += p.samples;
    outcome.failures += p.sum != glm::dvec3(0.0) || p.nonfinite > 0 ? 1 : 0;
  }
  outcome.worst = formatted("light in %zu pixels", outcome.failures);
}

std::vector<View> viewsAround(const glm::dvec3& position) {
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
      views.push_back(view);
    }
  }
  return views;
}

}  // namespace fragtrace
