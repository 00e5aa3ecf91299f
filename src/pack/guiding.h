// SPDX-License-Identifier: MIT
// Guiding of camera paths towards caustics (shaders/caustics/guiding.glsl), fitted to where light paths land.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "shader/layout.h"

namespace fragtrace {

/// A light path where it lands on a rough surface, behind casters.
struct Photon {
  glm::vec3 point{0.0f};  ///< local space
  glm::vec3 wi{0.0f};     ///< towards where it came from
  float flux = 0.0f;      ///< the largest of its channels; only ratios matter
  uint32_t chain = 0;     ///< those that met the same surfaces on the same sides have the same number
};

constexpr size_t kGuidingRows = size_t(layout::kGuidingCells) * layout::kGuidingLobes;

/// Fits a lobe to the photons of each cell that met the same surfaces. A cell keeps the strongest lobes.
/// Returns kGuidingRows rows of uvec4: kGuidingLobes for each of kGuidingCells.
std::vector<uint32_t> fitGuiding(std::span<const Photon> photons, std::span<const glm::vec4> casters);

}  // namespace fragtrace
