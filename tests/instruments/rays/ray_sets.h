// SPDX-License-Identifier: MIT
// The rays on which traversal alone is measured: primary, diffuse and shadow rays of a scene.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "bvh/exact_tracer.h"
#include "scene/camera.h"
#include "scene/local_space.h"

namespace fragtrace {

enum class RayKind : uint8_t { Primary, Diffuse, Shadow };
inline constexpr std::array<std::string_view, 3> kRayKindNames{"primary", "diffuse", "shadow"};

/// One ray through the middle of each pixel, in local space, rows from the bottom.
std::vector<Ray> primaryRays(const Camera& camera, const LocalSpace& space, glm::ivec2 size);

/// One ray from each point that the primary rays hit, in directions whose density goes with the cosine to the
/// geometric normal. Where nothing was hit there is no ray.
std::vector<Ray> diffuseRays(const ExactTracer& tracer, std::span<const Ray> primary,
                             std::span<const ExactHit> hits, uint32_t seed);

/// One ray from each point that the primary rays hit to a point on an emissive triangle, uniform over their
/// area; in a scene without any, to a point of its box. The ray ends just before that point. There is no ray
/// to a point behind the surface.
std::vector<Ray> shadowRays(const ExactTracer& tracer, const Scene& scene, std::span<const Ray> primary,
                            std::span<const ExactHit> hits, uint32_t seed);

/// Rays that are there.
size_t countRays(std::span<const Ray> rays);

}  // namespace fragtrace
