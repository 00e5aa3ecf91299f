// SPDX-License-Identifier: MIT
// Checks what a document says of itself before its schema is looked at. What only glTF's rules forbid and no
// picture shows is left to Khronos' validator (docs/gltf.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gltf/read/diagnostics.h"

namespace fragtrace {

/// Walks over all members outside of extras: takes out those that are null, unless their objects cannot do
/// without, and warns of extensions at places where they are ignored.
void checkMembers(nlohmann::json& root, Diagnostics& diagnostics);

/// Refuses versions but 2.x, and documents that ask for a higher version than 2.0. Numbers become texts. Says
/// nothing of an asset without a version.
void checkVersions(nlohmann::json& root, Diagnostics& diagnostics);

}  // namespace fragtrace
