// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pack/literal_faces.h"

namespace fragtrace {

struct LiteralOptions {
  bool weights = false;  ///< barycentric ones are kept; the faces must be triangles or parallelograms then
  bool whole = false;    ///< there is nothing else to test
  bool passing =
      false;  ///< rays pass through surfaces: hits are ordered as by isNearer() of shaders/tree/leaf.glsl
  bool backFaces = false;  ///< light paths ask for the backs of single-sided faces
};

/// Returns the text of traverseLiterals() of shaders/literals.glsl for this mesh: the test of Woop, Benthin
/// and Wald (shaders/intersect.glsl) of all its faces, unrolled. Points are projected once for all faces that
/// share them, and an edge function is computed once for both faces of its edge. So no ray passes between
/// neighbours, even if the compiler fuses operations.
std::string literalTraversal(const LiteralMesh& mesh, const LiteralOptions& options);

}  // namespace fragtrace
