// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "scene/selection.h"

namespace fragtrace {

/// Adds the user's lamps to a document whose `up` points up, as if its file had them: a sun as a directional
/// light, an area as a mesh of two triangles that shine on one side. The document is not checked yet.
void addLights(nlohmann::json& root, std::span<const AddedLight> lights, const glm::dvec3& up);

}  // namespace fragtrace
