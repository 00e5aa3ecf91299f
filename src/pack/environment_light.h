// SPDX-License-Identifier: MIT
// The light of the environment in the stages before global illumination, without noise: irradiance as nine
// spherical harmonics, and the map as the lobes of Blinn-Phong see it (docs/design/surfaces.md).
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "image/image.h"
#include "pack/gpu_scene.h"
#include "scene/sky/map_filter.h"

namespace fragtrace {

/// Factors of 1, x, y, z, xy, yz, zx, x^2 - z^2 and 3 y^2 - 1 of a unit normal before the map is turned; the
/// sum is the irradiance (Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment
/// Maps, 2001).
using Irradiance = std::array<glm::dvec3, layout::kIrradianceRows>;

/// An equirectangular picture with R, G, B as `height` rows of twice as many texels: means of finer ones,
/// between coarser ones as shaders/environment.glsl reads them. Uses all processors.
MapRows resized(const Image& image, int height);

/// Sums a map's texels over the solid angles that they have.
Irradiance irradianceOf(const MapRows& map);

/// Exponent of the lobe of a level: lobes are twice as narrow from one to the next.
double exponentOfLevel(int level);

/// A level of the map, its first and last row at the poles; `map` is fine enough for it.
MapRows lobesOf(const MapRows& map, int level);

/// The most words that appendEnvironmentLight() appends.
size_t mostLightWords();

/// Appends the light of a map to the rows of the environment's buffer (layout.glsl).
void appendEnvironmentLight(const Image& image, Words& texels);

}  // namespace fragtrace
