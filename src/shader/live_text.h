// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace fragtrace {

/// Removes branches that the constants at the top of a shader never take, functions that nothing calls, and
/// comments. Lines keep their numbers. Drivers process all of a text: a program of which half is dead takes
/// them a fifth longer to compile. Text that this function does not understand stays as it is.
std::string liveText(const std::string& text);

}  // namespace fragtrace
