// SPDX-License-Identifier: MIT
// The traversal stack of the shader, in named vectors of four entries: a private array is what costs most on
// llvmpipe. GLSL has no loop over names, so the text is written from their number.
#pragma once

#include <string>

namespace fragtrace {

/// The text of `struct Stack` with so many vectors e0, e1, ..., where e0.x is the top, emptyStack() and
/// stepStack(). kStackSize is the number of entries: a multiple of four and at least eight. The tree is no
/// deeper, so nothing is ever lost at the bottom.
std::string stackText(int vectors);

/// saveStack() and loadStack(): a row of the buffer of path states a vector.
std::string stackRowsText(int vectors);

}  // namespace fragtrace
