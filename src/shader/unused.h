// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "shader/tokens.h"

namespace fragtrace {

/// Takes out functions that main does not reach by any name.
void dropUnused(std::vector<Token>& tokens);

}  // namespace fragtrace
