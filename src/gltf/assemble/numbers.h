// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>

#include "gltf/check/schema.h"
#include "gltf/read/diagnostics.h"
#include "scene/parts.h"

namespace fragtrace {

// Numbers in the JSON of a document that replace the file's: those of an animation, or the user's.

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

// Values of --set that name materials, as "Wood*:roughness", instead of a place.

/// Returns true if the value is of materials by their name.
bool namesMaterials(const SetNumber& set);

/// Returns true if the text is what the pattern says: * stands for any letters, ? for one, and \ quotes the
/// next one.
bool matchesPattern(std::string_view pattern, std::string_view text);

/// The values with places in that document: one that names materials becomes one for each of them. Throws
/// UsageError where no material has the name, or materials have no such value.
std::vector<SetNumber> placedValues(const nlohmann::json& root, std::span<const SetNumber> set);

/// The extension that holds a place of a material; empty: none does.
std::string extensionIn(std::string_view pointer);

/// Adds the user's lamps to a document whose `up` points up, as if its file had them: a sun as a directional
/// light, an area as a mesh of two triangles that shine on one side. The document is not checked yet.
void addLights(nlohmann::json& root, std::span<const AddedLight> lights, const glm::dvec3& up);

}  // namespace fragtrace
