// SPDX-License-Identifier: MIT
// The traversal stack of the shader, in named vectors of four entries: a private array is what costs most on
// llvmpipe. GLSL has no loop over names, so the text is written from their number.
#pragma once

#include <string>

namespace fragtrace {

/// Returns the text of emptyStack(), stepStack() and `struct Stack`, which has as many members as `vectors`:
/// e0, e1 and so on. e0.x is the top of the stack. kStackSize is the number of entries, a multiple of four
/// and at least eight. A walk of the tree needs no more than that, so no entry is lost at the bottom.
std::string stackText(int vectors);

/// Returns the text of saveStack() and loadStack(). Each vector takes a row of the buffer of path states.
std::string stackRowsText(int vectors);

}  // namespace fragtrace
