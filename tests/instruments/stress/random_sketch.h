// SPDX-License-Identifier: MIT
#pragma once

#include "tests/instruments/rays/dice.h"
#include "tests/instruments/stress/sketch.h"

namespace fragtrace {

/// Scenes of one kind need the same shader.
inline constexpr uint32_t kSketchKinds = 6;

/// A scene of a few metres: objects in a tree of nodes over a floor and below a lamp, with triangles that
/// have no area, slivers and duplicates among theirs. Its kind is seed % kSketchKinds: diffuse; metals and
/// plastics; glass that absorbs; blended surfaces under a point light, too; spheres and meshes with colour
/// and normal textures; spheres and meshes under an environment map, too.
SceneSketch randomSketch(uint32_t seed);

}  // namespace fragtrace
