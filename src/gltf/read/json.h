// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "gltf/read/diagnostics.h"
#include "image/limits.h"

namespace fragtrace {

/// Parses JSON whose nesting and size in memory are limited first. Throws InputError with line and column.
nlohmann::json parseJson(std::string_view text, MemoryBudget& memory, Diagnostics& diagnostics);

}  // namespace fragtrace
