// SPDX-License-Identifier: MIT
// What breaks glTF's rules and yet has a meaning: warned about at its place, so that nothing is drawn
// otherwise than its author meant in silence. What has none is refused by the schema and by those who read
// it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gltf/read/diagnostics.h"

namespace fragtrace {

/// Of a document that has passed the schema: empty arrays, extensions at the wrong place, versions, cameras,
/// lights, nodes. Refuses versions that are not supported.
void checkValidity(const nlohmann::json& root, Diagnostics& diagnostics);

/// The same of buffer views, accessors, images and mesh primitives.
void checkDataValidity(const nlohmann::json& root, Diagnostics& diagnostics);

}  // namespace fragtrace
