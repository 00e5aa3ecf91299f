// SPDX-License-Identifier: MIT
// Numbers and words set in the text of a JSON document, of which all other bytes stay.
#pragma once

#include <span>
#include <string>

#include "scene/selection.h"

namespace fragtrace {

/// The text with these values at their places; members are inserted where they are missing, and so are the
/// objects that hold them; an extension of a material that is new is listed among those that are used. A
/// number stays as it is written where it is the same as a float. The text must be JSON. Throws
/// std::runtime_error if a place is below something that is no object and has no such element.
std::string withNumbers(std::string text, std::span<const SetNumber> set);

}  // namespace fragtrace
