// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "shader/tokens.h"

namespace fragtrace {

/// Takes out functions that main does not reach by any name, and members of structs that nothing names.
/// Structs that are made from all of their members at once, or lie in buffers, keep them.
void dropUnused(std::vector<Token>& tokens);

}  // namespace fragtrace
