// SPDX-License-Identifier: MIT
// Numbers in the JSON of a document that stand in place of the file's: those of an animation, or the user's.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gltf/check/schema.h"
#include "gltf/read/diagnostics.h"
#include "scene/selection.h"

namespace fragtrace {

/// Says what is wrong with a colour above 1, of a material's emission or of a light, that glTF does not
/// allow; null: it is none.
const char* whatIsBright(const SetNumber& set);

/// The rule for the value at a JSON pointer, if the loader reads numbers there and the document has the
/// object or the array that holds them.
std::optional<NumberRule> numberRuleIn(const nlohmann::json& root, const std::string& pointer);

/// Makes translation, rotation and scale of a node's matrix, if a pointer is to one of them. Returns false
/// where there is nothing to do.
bool decomposeMatrixAt(nlohmann::json& root, const std::string& pointer);

/// Writes as many values as the rule says, which is of that place.
void writeNumbers(nlohmann::json& root, const std::string& pointer, const NumberRule& rule,
                  const std::vector<double>& values);

/// Throws UsageError for a place without numbers, and for too few or too many.
void checkNumbers(const nlohmann::json& root, std::span<const SetNumber> set);

/// Checks and writes the user's numbers; warns of colours that glTF does not allow. Errors that the loader
/// then finds there are reported as errors of --set.
void writeNumbers(nlohmann::json& root, const std::vector<SetNumber>& set, Diagnostics& diagnostics);

}  // namespace fragtrace
