// SPDX-License-Identifier: MIT
// Supplies members that an object cannot do without, where the rest of the document tells what they are.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "gltf/read/diagnostics.h"

namespace fragtrace {

/// Stands for a length of a buffer or a view that reaches to the end of its data, until these are there. It
/// is the largest length that the schema allows.
inline constexpr uint64_t kToTheEnd = uint64_t(1) << 53;

/// Puts in members that are missing or null, with a warning each. The document need not have passed the
/// schema.
void supplyMembers(nlohmann::json& root, Diagnostics& diagnostics);

}  // namespace fragtrace
