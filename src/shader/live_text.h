// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace fragtrace {

/// What the constants at the top of a shader leave of its text: branches that are never taken, functions that
/// nothing calls and comments are gone; lines keep their numbers.
/// Drivers read all of a text with care, so one in which half is dead takes them a fifth longer to compile.
/// Text that it does not understand stays as it is.
std::string liveText(const std::string& text);

}  // namespace fragtrace
