// SPDX-License-Identifier: MIT
// shaders/layout.glsl seen from C++: the same constants and structs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace fragtrace::layout {

using uint = uint32_t;
using glm::ivec2;
using glm::ivec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

#include "layout.glsl"
#include "work/kinds.glsl"

static_assert(sizeof(Frame) == 18 * 16);
static_assert(offsetof(Frame, sceneExtent) == 4 * 16);
static_assert(offsetof(Frame, pictureSize) == 8 * 16);
static_assert(sizeof(Progress) == 16);
static_assert(sizeof(Shutter) == (1 + 4 * kMostCameraSegments) * 16);
static_assert(sizeof(Fog) == 3 * 16);
static_assert(sizeof(Volume) == 6 * 16);

}  // namespace fragtrace::layout
