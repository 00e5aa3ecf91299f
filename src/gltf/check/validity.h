// SPDX-License-Identifier: MIT
// Checks what a document says of itself. What only glTF's rules forbid and no picture shows is left to
// Khronos' validator (docs/gltf.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gltf/read/diagnostics.h"

namespace fragtrace {

/// Refuses versions but 2.x, before their schema is looked at. Says nothing of an asset without a version.
void checkVersion(const nlohmann::json& root, const Diagnostics& diagnostics);

/// Refuses a document that has passed the schema and asks for a higher version than 2.0.
void checkLeastVersion(const nlohmann::json& root, const Diagnostics& diagnostics);

/// Warns of extensions at places where they are ignored.
void checkPlacesOfExtensions(const nlohmann::json& root, Diagnostics& diagnostics);

}  // namespace fragtrace
