// SPDX-License-Identifier: MIT
// Pictures of scenes that are made in memory, for rows that look at pixels.
#pragma once

#include "tests/instruments/stress/scene_drawing.h"
#include "tests/instruments/stress/stress.h"

namespace fragtrace {

/// A radiance that comes from everywhere, as an environment map.
Environment whiteWorld(float radiance);

/// The distance between the random seeds of one seed of the setting and those of the next.
constexpr uint32_t kSeedStride = 1000;

/// The options of a stage with the setting's triangle test.
RenderOptions optionsOf(const StressSetting& setting, Stage stage);

/// A scene that was made in memory, on the device; by a tree unless the options ask for another traversal.
SceneDrawing drawingOf(const StressSetting& setting, Scene scene, const Environment& environment,
                       RenderOptions options);

/// Counts the paths of a picture that should be black as cases, and its pixels that are not as failures.
void countLight(const FilmPixels& film, StressOutcome& outcome);

/// Looks out of a point along the six axes, 90 degrees each: every direction is in one of the pictures.
std::vector<View> viewsAround(const glm::dvec3& position, uint32_t seed);

}  // namespace fragtrace
