// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <nlohmann/json_fwd.hpp>

#include "gltf/check/schema.h"
#include "gltf/read/diagnostics.h"

namespace fragtrace {

// Mends a document that has passed the schema: values of it that have one obvious reading are read so, and
// objects that have none are emptied (see Diagnostics). Each is a function in one table.

void mendValues(nlohmann::json& root, const IsUsed& isUsed, Diagnostics& diagnostics);

// Supplies members that an object cannot do without, where the rest of the document tells what they are.

/// Stands for a length of a buffer or a view that reaches to the end of its data, until these are there. It
/// is the largest length that the schema allows.
inline constexpr uint64_t kToTheEnd = uint64_t(1) << 53;

/// Puts in members that are missing or null, with a warning each. The document need not have passed the
/// schema.
void supplyMembers(nlohmann::json& root, Diagnostics& diagnostics);

// Checks what a document says of itself before its schema is looked at. What only glTF's rules forbid and no
// picture shows is left to Khronos' validator (docs/gltf.md).

/// Refuses versions but 2.x, and documents that ask for a higher version than 2.0. Numbers become texts. Says
/// nothing of an asset without a version.
void checkVersions(nlohmann::json& root, Diagnostics& diagnostics);

}  // namespace fragtrace
