// SPDX-License-Identifier: MIT
// The shader files that choose lights, and the reads they need. No include guard: glsl_lights.h includes this
// once a precision.

inline uvec4 readTexcoords(int index) { return rowOf(glsl_variant::texcoords, index); }
inline uvec4 readMaterials(int index) { return rowOf(glsl_variant::materials, index); }
inline uvec4 readEmitters(int index) { return rowOf(glsl_variant::emitters, index); }
inline uvec4 readLights(int index) { return rowOf(glsl_variant::lights, index); }
inline uvec4 readEnvironment(int index) { return rowOf(glsl_variant::environment, index); }
inline uvec2 readEnvironmentTexel(int index) {
  const uvec4 row = readEnvironment(index >> 1);
  return (index & 1) == 0 ? uvec2(row.x, row.y) : uvec2(row.z, row.w);
}
inline uvec4 readEnvironmentInversion(int index) { return rowOf(glsl_variant::environmentInversion, index); }

// These functions are those of material.glsl and surface.glsl; the tests' emission has no textures.
inline vec4 readTexcoordsAt(int i) { return uintBitsToFloat(readTexcoords(i)); }
inline vec4 materialFloats(uint material, uint row) {
  return uintBitsToFloat(readMaterials(int(material * kMaterialRows + row)));
}
inline uvec4 faceRow(int slot, int row) { return readFaces(slot * int(kFaceRows) + row); }
inline vec3 emissionAt(uint material, vec4 /*texcoords*/) {
  return vec3(materialFloats(material, kMaterialEmission));
}
inline vec2 coveredAreas;
inline uint materialFlags(uint /*material*/) { return 0u; }
inline vec4 readColorAt(int /*i*/) { return vec4(1.0f); }
inline vec4 baseColorAt(uint /*material*/, vec4 /*texcoords*/, vec4 color) { return color; }
inline float alphaAt(uint /*material*/, uint /*flags*/, float alpha) { return alpha; }
inline float emissionUnderCoat(uint /*material*/, vec4 /*texcoords*/, float /*cosine*/) { return 1.0f; }
inline vec4 interpolate(vec4 a, vec4 b, vec4 c, vec2 weights) {
  return (1.0f - weights.x - weights.y) * a + weights.x * b + weights.y * c;
}

// Lamps of these tests stand still.
struct MovingTriangle {
  Corners at;
  float part;
};
inline int slotInSegment(int slot, float /*time*/) { return slot; }
inline MovingTriangle movingTriangle(int /*slot*/, float /*time*/) { return {}; }

// clang-format off
#include "sky/sun.glsl"
#include "environment.glsl"
#include "lights/environment_light.glsl"
#include "lights.glsl"
#include "lights/light_tree.glsl"
#include "lights/sample_light.glsl"
#include "reuse/candidates.glsl"
#include "reuse/reservoir.glsl"
#include "caustics/aim.glsl"
#include "caustics/flux.glsl"
#include "caustics/form.glsl"
#include "caustics/guiding.glsl"
// clang-format on
