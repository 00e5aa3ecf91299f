// SPDX-License-Identifier: MIT
// How the shader reads buffers: one function each, readNodes() and so on, in the way that the variant says.
#pragma once

#include <string>

#include "stage/variant.h"

namespace fragtrace {

/// The scene buffers and their functions.
std::string readsText(BufferReads reads);

/// The buffer of path states, which the tracer writes as pathStates[], and readPathStates(). imageUnit:
/// through which it is read, since llvmpipe reads images five times as fast; -1: through the buffer itself.
std::string pathStatesText(int imageUnit);

}  // namespace fragtrace
