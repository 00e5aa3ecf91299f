// SPDX-License-Identifier: MIT
// Mends a document that has passed the schema: values of it that have one obvious reading are read so, and
// objects that have none are emptied (see Diagnostics). Each is a function in one table.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gltf/check/schema.h"

namespace fragtrace {

void mendValues(nlohmann::json& root, const IsUsed& isUsed, Diagnostics& diagnostics);

}  // namespace fragtrace
