// SPDX-License-Identifier: MIT
// Numbers set in the text of a JSON document, of which all other bytes stay.
#pragma once

#include <span>
#include <string>

#include "scene/selection.h"

namespace fragtrace {

/// The text with these numbers at their places; members are inserted where they are missing, and so are the
/// objects that hold them. A number stays as it is written where it is the same as a float. The text must be
/// JSON. Throws std::runtime_error if a place is below something that is no object and has no such element.
std::string withNumbers(std::string text, std::span<const SetNumber> set);

}  // namespace fragtrace
