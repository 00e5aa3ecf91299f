// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "shader/constants.h"

namespace fragtrace {

/// Takes out the branches that are never taken, and the conditions of those that always are.
void dropSettled(std::vector<Token>& tokens, const ShaderConstants& constants);

}  // namespace fragtrace
