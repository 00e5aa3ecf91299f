// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pack/literal_faces.h"

namespace fragtrace {

/// traverseLiterals() of shaders/literals.glsl for this mesh: Woop, Benthin and Wald's test
/// (shaders/intersect.glsl) of all its faces, unrolled. Points are projected once for all faces that share
/// them and edge functions made once for both sides, so no ray passes between neighbours, whatever the
/// compiler fuses. `weights`: barycentric ones are kept; the faces must be triangles then. `whole`: there is
/// nothing else to test.
std::string literalTraversal(const LiteralMesh& mesh, bool weights, bool whole);

}  // namespace fragtrace
