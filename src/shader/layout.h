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

// The bindings of scene buffers; src/shader/assemble.cpp writes the functions that read them.
constexpr uint kNodesBinding = 0;      ///< kNodeRows uvec4 per node; behind them kInstanceRows per instance
constexpr uint kLeavesBinding = 1;     ///< 5 uvec4 per leaf: two primitives, structure of arrays
constexpr uint kFacesBinding = 2;      ///< kFaceRows uvec4 per leaf slot; behind them 1 per slot: kCreases
constexpr uint kNormalsBinding = 3;    ///< 1 vec4 per vertex
constexpr uint kTexcoordsBinding = 4;  ///< 1 vec4 per vertex: TEXCOORD_0, TEXCOORD_1
constexpr uint kTangentsBinding = 5;   ///< 1 vec4 per vertex
constexpr uint kColorsBinding = 6;     ///< 1 vec4 per vertex
constexpr uint kMaterialsBinding = 7;  ///< kMaterialRows uvec4 per material
/// The grid of densities: its table, 1 uvec2 per brick (brickEntry of media/volume.glsl), and the bricks:
/// each has kBrickTexels uvec2s of 4 densities, then, if the grid emits, 1 of radiance per voxel.
constexpr uint kBricksBinding = 8;
constexpr uint kEmittersBinding = 9;  ///< kEmitterRows uvec4 per emitter
constexpr uint kLightsBinding = 10;   ///< kLightRows vec4 per punctual light
/// 1 uvec4 per two texels (pack/pack_environment.h): radiance, pdf over the area of the map (mean 1). Those
/// of the backdrop follow, if camera rays see one instead of the map, and before gi the environment's light:
/// factors of the irradiance; width, height and first row of each level of lobes; the levels.
constexpr uint kEnvironmentBinding = 11;
/// 1 uvec4 per step: of the rows, then of each row (pack/pack_environment.h).
constexpr uint kEnvironmentInversionBinding = 12;
static_assert(kEnvironmentInversionBinding + 1 == kSceneBufferCount);

/// The first image unit of scene buffers that are read as images; the film has those before it.
constexpr uint kSceneImageBase = 3;
/// Buffers of texels; their image units are behind those of the scene buffers.
constexpr uint kMostTexelBuffers = 8;
constexpr uint kTexelImageBase = kSceneImageBase + kSceneBufferCount;

/// Texture slots of a material that the host asks for by name, in the order of kTextureRefs (scene/scene.h).
enum Slot : uint {
  kSlotBaseColor,
  kSlotMetallicRoughness,
  kSlotNormal,
  kSlotEmission,
  kSlotTransmission,
  kSlotSpecular,
  kSlotSpecularColor,
  kSlotClearcoat,
  kSlotClearcoatNormal = 9
};

constexpr float kLightPoint = 0.0f;  ///< a type of light that shaders need not know

static_assert(sizeof(Frame) == 18 * 16);
static_assert(offsetof(Frame, sceneExtent) == 4 * 16);
static_assert(offsetof(Frame, pictureSize) == 8 * 16);
static_assert(sizeof(Progress) == 16);
static_assert(sizeof(Shutter) == (1 + 4 * kMostCameraSegments) * 16);
static_assert(sizeof(Fog) == 3 * 16);
static_assert(sizeof(Volume) == 6 * 16);

}  // namespace fragtrace::layout
