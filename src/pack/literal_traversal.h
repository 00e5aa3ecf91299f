// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pack/literal_faces.h"

namespace fragtrace {

struct LiteralOptions {
  bool weights = false;  ///< barycentric ones are kept; the faces must be triangles or parallelograms then
  bool whole = false;    ///< there is nothing else to test
  bool passing =
      false;  ///< rays pass through surfaces: hits are ordered as by isNearer() of shaders/traverse.glsl
  bool backFaces = false;  ///< light paths ask for the backs of single-sided faces
};

/// traverseLiterals() of shaders/literals.glsl for this mesh: Woop, Benthin and Wald's test
/// (shaders/intersect.glsl) of all its faces, unrolled. Points are projected once for all faces that share
/// them and edge functions made once for both sides, so no ray passes between neighbours, whatever the
/// compiler fuses.
std::string literalTraversal(const LiteralMesh& mesh, const LiteralOptions& options);

}  // namespace fragtrace
