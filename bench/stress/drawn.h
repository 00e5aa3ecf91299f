// SPDX-License-Identifier: MIT
// Pictures of scenes that are made in memory, for rows that look at pixels.
#pragma once

#include "bench/stress/stress.h"
#include "film/film_pixels.h"
#include "pack/gpu_scene.h"
#include "render/renderer.h"

namespace fragtrace {

/// A radiance that comes from everywhere, as an environment map.
Environment whiteWorld(float radiance);

/// The options of a stage with the setting's triangle test.
RenderOptions optionsOf(const StressSetting& setting, Stage stage);

/// Draws a scene from one place after the other, by a tree unless the options ask for another traversal; it
/// is built and uploaded once.
class StressPicture {
 public:
  StressPicture(const StressSetting& setting, Scene scene, const Environment& environment,
                const RenderOptions& options);
  FilmPixels draw(const View& view, glm::ivec2 size, int samples);

 private:
  const StressSetting& setting_;
  ShaderVariant variant_;
  std::unique_ptr<Renderer> renderer_;
};

/// Counts the paths of a picture that should be black as cases, and its pixels that are not as failures.
void countLight(const FilmPixels& film, StressOutcome& outcome);

/// Looks out of a point along the six axes, 90 degrees each: every direction is in one of the pictures.
std::vector<View> viewsAround(const glm::dvec3& position);

}  // namespace fragtrace
