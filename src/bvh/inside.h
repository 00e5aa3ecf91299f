// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "bvh/bvh.h"
#include "scene/scene.h"

namespace fragtrace {

/// The material of the solid that a point of local space lies in: of the first whose boundary a ray leaves
/// without having entered. None where it lies in no solid, or the scene has no tree.
std::optional<uint32_t> solidAround(const Scene& scene, const Bvh& bvh, const glm::dvec3& point);

}  // namespace fragtrace
