// SPDX-License-Identifier: MIT
// Equivalent forms of a scene: other files that show the same.
#pragma once

#include <array>
#include <string_view>

#include "tests/instruments/stress/sketch.h"

namespace fragtrace {

enum class Form : uint8_t {
  /// Scaled by 1e-6 to 1e6, with all lengths; lights are as bright from as many times farther away.
  Scaled,
  Moved,      ///< moved by 1 to 1e6 times its size
  Turned,     ///< about any axis; under a sky about +y, and the sky, too
  Reordered,  ///< triangles in a mesh, meshes and nodes in the file
  Flattened,  ///< vertices in world space instead of nodes
  Split,      ///< each mesh into several
  Shared,     ///< meshes held once, shown by instances
};
inline constexpr std::array<std::string_view, 7> kFormNames{"scaled",    "moved", "turned", "reordered",
                                                            "flattened", "split", "shared"};

/// The sketch in another form; the seed chooses by how much, or in which way.
SceneSketch inForm(const SceneSketch& sketch, Form form, uint32_t seed);

}  // namespace fragtrace
