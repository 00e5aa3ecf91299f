// SPDX-License-Identifier: MIT
// Counts of work (shaders/work/count.glsl), and their names. What shaders count of camera_rays, they count by
// countCameraRays(number).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "shader/layout.h"

namespace fragtrace {

/// The last ones are rows read of the scene buffers, in the order of their bindings. Surfaces passed are
/// those behind which rays are traced once more; shadow surfaces are among the surfaces, whose attributes are
/// computed.
inline constexpr std::array kWorkNames =
    std::to_array<std::string_view>({"camera_rays",   "bounce_rays",      "shadow_rays",
                                     "light_rays",    "splat_rays",       "surfaces_passed",
                                     "node_steps",    "boxes_tested",     "primitives_tested",
                                     "surfaces",      "shadow_surfaces",  "bsdf_evaluations",
                                     "volume_walks",  "volume_steps",     "node_rows",
                                     "leaf_rows",     "face_rows",        "normal_rows",
                                     "texcoord_rows", "tangent_rows",     "color_rows",
                                     "material_rows", "texel_reads",      "emitter_rows",
                                     "light_rows",    "environment_rows", "environment_inversion_rows"});

struct WorkCounts {
  uint64_t draws = 0;  ///< also of programs that count nothing else
  std::array<uint64_t, kWorkNames.size()> numbers{};
};

inline WorkCounts operator+(WorkCounts a, const WorkCounts& b) {
  a.draws += b.draws;
  for (size_t i = 0; i < a.numbers.size(); ++i) a.numbers[i] += b.numbers[i];
  return a;
}

inline WorkCounts operator-(WorkCounts a, const WorkCounts& b) {
  a.draws -= b.draws;
  for (size_t i = 0; i < a.numbers.size(); ++i) a.numbers[i] -= b.numbers[i];
  return a;
}

}  // namespace fragtrace
