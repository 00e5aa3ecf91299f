// SPDX-License-Identifier: MIT
// shaders/environment.glsl and lights.glsl compiled as C++, behind the files of glsl.h: what they read lies
// in spans here.
#pragma once

#include "glsl.h"

namespace fragtrace::glsl_variant {

inline bool kGi = true;
inline bool kEnvironment = true;
inline bool kEnvironmentSampling = true;
inline bool kSun = false;
inline bool kMapSun = false;
inline bool kPunctualLights = true;
inline bool kEmissiveTriangles = true;
inline bool kLightTree = false;
inline bool kCandidates = false;
inline bool kStoresReservoirs = false;
inline bool kNeighbours = false;
inline bool kTexcoords = false;
inline bool kLampTextures = false;
inline bool kAlpha = false;
inline bool kVertexColors = false;
inline bool kRayCones = false;

inline layout::Frame frame{};
inline std::vector<glm::vec4> casters;
inline int casterCount = 0;
inline std::span<const uint32_t> texcoords;
inline std::span<const uint32_t> materials;
inline std::span<const uint32_t> emitters;
inline std::span<const uint32_t> lights;
inline std::span<const uint32_t> environment;
inline std::span<const uint32_t> environmentInversion;

}  // namespace fragtrace::glsl_variant

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

namespace fragtrace::glsl_float {
namespace {
#include "glsl_lights_files.h"
}  // namespace
}  // namespace fragtrace::glsl_float

#define float double
namespace fragtrace::glsl_double {
namespace {
#include "glsl_lights_files.h"
}  // namespace
}  // namespace fragtrace::glsl_double
#undef float

#pragma GCC diagnostic pop
