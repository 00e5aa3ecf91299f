// SPDX-License-Identifier: MIT
// src/pack/literals.cpp replaces this file when a scene is so small that it becomes part of the shader's text. All its
// triangles are then tested without a tree, and its faces, materials and emitters are constants to choose from.

const bool kLiterals = false;    // the whole scene
const bool kLargeFirst = false;  // its largest triangles, which the tree does not hold

/// The nearest hit of the ray, or any.
Traversal traverseLiterals(vec3 origin, vec3 direction, Traversal s, bool anyHit) { return s; }

uvec4 literalFace(int slot, int row) { return uvec4(0u); }
uvec4 literalInset(int slot, int row) { return uvec4(0u); }
uvec4 literalMaterial(uint material, uint row) { return uvec4(0u); }
uvec4 literalEmitter(int emitter, int row) { return uvec4(0u); }
