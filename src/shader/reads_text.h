// SPDX-License-Identifier: MIT
// Writes the functions that read buffers, one each, readNodes() and so on, for the kind of buffer that the
// variant names.
#pragma once

#include <string>

#include "shader/variant.h"

namespace fragtrace {

/// The scene buffers and their functions.
std::string readsText(BufferReads reads);

/// The buffer of path states, which the tracer writes as pathStates[], and readPathStates(). imageUnit:
/// through which it is read, since llvmpipe reads images five times as fast; -1: through the buffer itself.
std::string pathStatesText(int imageUnit);

}  // namespace fragtrace
