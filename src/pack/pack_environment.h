// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

/// The distribution by which directions to the environment are drawn.
enum class EnvironmentDraws {
  Nothing,
  Light,          ///< light samples alone: each direction by its luminance
  LightAndPaths,  ///< beside scattered rays, which find what is darker than the mean: by the luminance above
                  ///< that (MIS compensation: Karlik, Sik, Vivoda, Skrivan and Krivanek, 2019)
};

struct PackedEnvironment {
  Words texels;     ///< two a row: radiance, and the density that shaders/environment.glsl draws by (mean 1)
  Words inversion;  ///< empty for Nothing, else a row per step: as many steps as the map has rows, then
                    ///< kMostEnvironmentSteps or half as many as it has columns for each row
  glm::ivec2 size{0};
  double power =
      0.0;  ///< luminance that falls on a disk of unit radius from all around: pi * integral over directions
  double drawnPower = 0.0;  ///< the part of it by which directions are drawn
};

/// Irradiance of a plane that faces up (+Y), from all of an equirectangular map with R, G, B.
glm::vec3 upwardIrradiance(const Image& image);

/// Appends radiance, with a density of 0.
void appendBackdrop(const Image& image, Words& texels);

/// Luminance that the sun sends to a disk of unit radius.
double powerOf(const SunDisc& sun);

/// Appends the rows of the suns before and in a map of which `drawnPower` is sampled (shaders/sky/sun.glsl).
void appendSuns(const Environment& environment, double drawnPower, Words& texels);

/// An equirectangular map with R, G, B of at most 65,535 x 65,535 texels, with a sun of that power before it.
/// Uses all processors.
PackedEnvironment packEnvironment(const Image& image, EnvironmentDraws draws, double sunPower = 0.0);

}  // namespace fragtrace
