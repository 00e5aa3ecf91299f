// SPDX-License-Identifier: MIT
// Warns about violations of glTF's rules that still have a meaning, at their place, so that nothing is
// silently drawn in another way than its author meant. Violations without a meaning are refused by the schema
// and by the code that reads them.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gltf/read/diagnostics.h"

namespace fragtrace {

/// Checks a document that has passed the schema: empty arrays, extensions at the wrong place, versions,
/// cameras, lights, nodes. Refuses versions that are not supported.
void checkValidity(const nlohmann::json& root, Diagnostics& diagnostics);

/// Refuses versions but 2.x, before their schema is looked at. Says nothing of an asset without a version.
void checkVersion(const nlohmann::json& root, const Diagnostics& diagnostics);

/// Checks the same for buffer views, accessors, images and mesh primitives.
void checkDataValidity(const nlohmann::json& root, Diagnostics& diagnostics);

}  // namespace fragtrace
