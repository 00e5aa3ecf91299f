// SPDX-License-Identifier: MIT
// Types and references of a glTF document, checked before tinygltf sees it: tinygltf drops members of a wrong
// type without a word, and does not check an index before it uses it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gltf/diagnostics.h"

namespace fragtrace {

/// Throws InputError with the place of the first member that is read by the loader and has the wrong type, is
/// missing though required, or refers to something that is not there. Whole numbers written as 1.0 become
/// integers.
void checkSchema(nlohmann::json& root, const Diagnostics& diagnostics);

}  // namespace fragtrace
