// SPDX-License-Identifier: MIT
// The shader's pure files compiled as C++, twice: glsl_float is what the GPU runs, glsl_double the same
// algorithm in double precision, the oracle. tests/gpu_arithmetic compiles them once more, with a GPU's
// liberties.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <stdexcept>

#include "pack/energy_tables.h"
#include "shader/layout.h"

/// The constants of the shader's prelude and the content of its buffers. Here they are variables, so that one
/// test can run all variants.
namespace fragtrace::glsl_variant {

inline bool kTriangles = true;
inline bool kSpheres = true;
inline bool kCulling = true;
inline bool kCountVisits = true;
inline bool kIterative = false;
inline bool kFrontToBack = true;
inline bool kSpecular = true;
inline bool kMetals = true;
inline bool kTransmission = true;
inline bool kAnisotropy = false;
inline bool kIridescence = false;
inline bool kGlassSpecular = false;
inline bool kDiffuseTransmission = false;
inline bool kSheen = false;
inline bool kClearcoat = false;
inline bool kNormalMaps = true;
inline bool kSchlick = false;
inline bool kCompensation = false;
inline bool kWeights = true;
inline bool kWatertight = true;
inline bool kSobol = true;
inline bool kVertexNormals = false;
inline bool kInstances = false;
inline bool kCreases = false;
inline bool kSlivers = false;
inline bool kCoincident = false;
inline bool kPassing = false;
inline bool kTestsAlpha = false;
inline bool kMatchedGlass = false;
inline bool kThinScattering = false;
inline bool kCaustics = false;
inline bool kLightPaths = false;
inline bool kRoughGlass = true;
inline bool kShadowCatcher = false;
inline bool kTransparentGlass = false;
inline bool kMoving = false;
inline int kStackSize = 32;

inline std::span<const uint32_t> nodes;
inline std::span<const uint32_t> leaves;
inline std::span<const uint32_t> faces;

/// One row of four words. Throws where the shader would read outside of its buffer.
inline glm::uvec4 rowOf(std::span<const uint32_t> words, int index) {
  const size_t first = size_t(index) * 4;
  if (index < 0 || first + 4 > words.size()) throw std::out_of_range("the shader reads outside of a buffer");
  return {words[first], words[first + 1], words[first + 2], words[first + 3]};
}

/// Gives a variable above another value until the end of the scope.
template <typename T>
class With {
 public:
  With(T& variable, const T& value) : variable_(variable), before_(variable) { variable_ = value; }
  With(const With&) = delete;
  With& operator=(const With&) = delete;
  ~With() { variable_ = before_; }

 private:
  T& variable_;
  T before_;
};

}  // namespace fragtrace::glsl_variant

// Shader functions are not inline: each test file has its own, and uses some of them.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"

#ifndef FRAGTRACE_GPU_ARITHMETIC  // whose copies of shaders have none
#define precise
#endif

namespace fragtrace::glsl_float {
namespace {
using namespace layout;        // NOLINT: as the shader includes it
using namespace glsl_variant;  // NOLINT: as the prelude defines it
using glm::uvec2;
using glm::vec2;
using glm::vec3;
using glm::vec4;
#include "glsl_functions.h"
#include "slab.glsl"
inline uint floatBitsToUint(float x) { return std::bit_cast<uint>(x); }
// The rest is as for doubles.
#include "glsl_files.h"
// The film is of floats.
#include "film_pixel.glsl"
}  // namespace
}  // namespace fragtrace::glsl_float

#define float double
namespace fragtrace::glsl_double {
namespace {
using namespace layout;        // NOLINT: as above
using namespace glsl_variant;  // NOLINT
using glm::uvec2;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
#include "glsl_functions.h"
inline vec4 slabMin(vec4 a, vec4 b) { return min(a, b); }
inline vec4 slabMax(vec4 a, vec4 b) { return max(a, b); }
inline bvec4 slabHits(vec4 near, vec4 far) { return lessThanEqual(near, far + 1e-14 * abs(far)); }
inline ivec4 slabOrder(vec4 near) { return glm::floatBitsToInt(glm::vec4(near)); }
#include "glsl_files.h"
}  // namespace
}  // namespace fragtrace::glsl_double
#undef float

#undef precise
#pragma GCC diagnostic pop
