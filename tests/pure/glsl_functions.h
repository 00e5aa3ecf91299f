// SPDX-License-Identifier: MIT
// GLSL's types and built-in functions, as far as the pure shader files use them. No include guard: glsl.h
// includes this once a precision, with float defined as double the second time; vec2, vec3 and vec4 are
// already named.

using uint = uint32_t;
using glm::bitfieldReverse;
using glm::bvec2;
using glm::bvec3;
using glm::bvec4;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::uvec3;
using glm::uvec4;

// Scalars; for vectors argument-dependent lookup finds GLM's functions. min, max and clamp are the
// specification's.
inline float abs(float x) { return std::fabs(x); }
inline float sqrt(float x) { return std::sqrt(x); }
inline float floor(float x) { return std::floor(x); }
inline float fract(float x) { return x - std::floor(x); }
inline float exp(float x) { return std::exp(x); }
inline float log(float x) { return std::log(x); }
inline float acos(float x) { return std::acos(x); }
inline float atan(float y, float x) { return std::atan2(y, x); }
inline float cos(float x) { return std::cos(x); }
inline float sin(float x) { return std::sin(x); }
inline float pow(float x, float y) { return std::pow(x, y); }
inline float min(float a, float b) { return b < a ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
inline float clamp(float x, float low, float high) { return min(max(x, low), high); }
inline float mix(float a, float b, float t) { return a * (1 - t) + b * t; }
inline float mix(float a, float b, bool second) { return second ? b : a; }
inline int mix(int a, int b, bool second) { return second ? b : a; }
inline uint mix(uint a, uint b, bool second) { return second ? b : a; }
inline int min(int a, int b) { return b < a ? b : a; }
inline int max(int a, int b) { return a < b ? b : a; }
inline int clamp(int x, int low, int high) { return min(max(x, low), high); }

inline float uintBitsToFloat(uint x) { return glm::uintBitsToFloat(x); }
inline vec3 uintBitsToFloat(uvec3 v) { return vec3(glm::uintBitsToFloat(v)); }
inline vec4 uintBitsToFloat(uvec4 v) { return vec4(glm::uintBitsToFloat(v)); }
inline void umulExtended(uint a, uint b, uint& high, uint& low) {
  const uint64_t product = uint64_t(a) * b;
  high = uint(product >> 32);
  low = uint(product);
}

// Functions of shaders/work/none.glsl.
inline void countNodeSteps(uint) {}
inline void countBoxesTested(uint) {}
inline void countPrimitivesTested(uint) {}
inline void countSurfacesPassed(uint) {}
inline void countBsdfEvaluations(uint) {}
inline void countVolumeWalks(uint) {}
inline void countVolumeSteps(uint) {}

inline uvec4 readNodes(int index) { return glsl_variant::rowOf(glsl_variant::nodes, index); }
inline uvec4 readLeaves(int index) { return glsl_variant::rowOf(glsl_variant::leaves, index); }
inline uvec4 readFaces(int index) { return glsl_variant::rowOf(glsl_variant::faces, index); }

// shaders/energy.glsl reads the same table from a buffer.
inline float ggxLoss(float cosine, float alpha) { return ggxEnergyTable().loss.at(cosine, alpha); }
inline float ggxAverageLoss(float alpha) { return ggxEnergyTable().averageAt(alpha); }
inline float energyTableAt(int, float cosine, float alpha) {  // only sheen's is read
  return sheenAlbedoTable().at(cosine, alpha);
}
