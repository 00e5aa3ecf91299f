// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/scene_drawing.h"

#include "base/errors.h"
#include "bench/report/scratch_folder.h"
#include "bvh/bvh.h"
#include "gl/driver_choice.h"
#include "gltf/gltf.h"
#include "pack/literals.h"
#include "pack/pack_tree.h"

namespace fragtrace {

Scene sceneOf(const SceneSketch& sketch) {
  const ScratchFolder folder;
  writeSketch(sketch, folder.path());
  return loadGltf(folder.path() / "sketch.gltf", {.instancing = sketch.instancing});
}

Environment environmentOf(const SceneSketch& sketch) {
  return sketch.sky.width > 0 ? Environment{Surroundings::Map, sketch.sky} : Environment{};
}

SceneDrawing::SceneDrawing(const Context& context, const Scene& scene, const RenderOptions& options,
                           const Environment& environment, double environmentTurn)
    : options_(options), size_(options.camera.resolution.value_or(glm::ivec2(64))) {
  const TraitSet present = traitsOf(scene, environment.kind);
  const bool iterative = options.device.traversal == TraversalMethod::Iterative;
  const Bvh bvh = iterative ? listLeaves(scene) : buildSceneBvh(scene);
  picture_ = chooseVariant(options, present, environment.kind, bvh.stackNeed, options.device.bufferReads);
  depth_ = chooseAovVariant(options, present, environment.kind, bvh.stackNeed, options.device.bufferReads,
                            Aov::Depth);
  ShaderVariant everything = picture_;
  everything.traits |= depth_.traits;
  GpuScene packed = packScene(scene, bvh, environment, everything);
  if (options.device.traversal == TraversalMethod::Literals) {
    picture_.traversal = options.device.traversal;
    picture_.literals = literalScene(scene, bvh, packed, picture_);
  }
  picture_.reads = chooseReads(options.device.bufferReads, context.software, packed, readLimits()).reads;
  depth_.reads = picture_.reads;
  const bool literals = picture_.traversal == TraversalMethod::Literals;
  picture_.dispatch = chooseDispatch(options.device.dispatch, context, literals);
  chooseSchedule(picture_, options, {});
  renderer_ =
      std::make_unique<Renderer>(context, std::move(packed), picture_.reads, options.device.shaderFolder);
  view_.camera = scene.cameras.empty() ? frameScene(scene.bounds) : scene.cameras.front();
  view_.space = scene.space;
  view_.background = options.light.backgroundColor.value_or(glm::vec3(0.0f));
  view_.showEnvironment = environment.kind == Surroundings::Map;
  view_.hdriRotation = environmentTurn;
  view_.bounces = options.sampling.bounces;
}

FilmPixels SceneDrawing::draw(const GoOn& goOn, const ShaderVariant& variant, const View& view,
                              glm::ivec2 size, int samples) {
  Film film(size);
  renderer_->compile(variant, film, view);
  RenderTimes times;
  renderer_->addSamples(film, view, 0, samples, times, [&](double) {
    goOn();
    return true;
  });
  return film.read();
}

FilmPixels SceneDrawing::draw(const GoOn& goOn, const View& view, glm::ivec2 size, int samples) {
  FilmPixels pixels = draw(goOn, picture_, view, size, samples);
  if (totalsOf(pixels).budgetHits > 0) throw RenderError("the driver ended loops early (budget_hits)");
  return pixels;
}

FilmPixels SceneDrawing::picture(const GoOn& goOn) {
  view_.seed = options_.sampling.seed;
  return draw(goOn, picture_, view_, size_, options_.sampling.spp);
}

FilmPixels SceneDrawing::depth(const GoOn& goOn) {
  view_.seed = 0;
  return draw(goOn, depth_, view_, size_, 1);
}

}  // namespace fragtrace
