// SPDX-License-Identifier: MIT
// Scenes drawn as `render` would draw them, without files of their own.
#pragma once

#include <functional>

#include "bvh/bvh.h"
#include "pack/gpu_scene.h"
#include "render/film/film_pixels.h"
#include "render/renderer.h"
#include "tests/instruments/stress/sketch.h"

namespace fragtrace {

/// A scene on the device, lit by its own lights and, if there is one, by an environment.
class SceneDrawing {
 public:
  /// Called between draws; may throw to end the work.
  using GoOn = std::function<void()>;

  /// Throws RenderError.
  SceneDrawing(const Context& context, const Scene& scene, const RenderOptions& options,
               const Environment& environment = {}, double environmentTurn = 0.0);

  /// options.spp samples of options.seed.
  FilmPixels picture(const GoOn& goOn);
  /// Draws depths in metres along the view axis, with one sample per pixel and seed 0.
  FilmPixels depth(const GoOn& goOn);
  /// Draws from another point of view. Throws RenderError where the driver ended loops early.
  FilmPixels draw(const GoOn& goOn, const View& view, glm::ivec2 size, int samples);

 private:
  FilmPixels draw(const GoOn& goOn, const ShaderVariant& variant, const View& view, glm::ivec2 size,
                  int samples);

  RenderOptions options_;
  glm::ivec2 size_;
  View view_;
  ShaderVariant picture_;
  ShaderVariant depth_;
  std::unique_ptr<Renderer> renderer_;
};

/// Through a file that goes again. Throws InputError, RenderError.
Scene sceneOf(const SceneSketch& sketch);

/// The sketch's sky.
Environment environmentOf(const SceneSketch& sketch);

}  // namespace fragtrace
