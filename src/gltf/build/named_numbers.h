// SPDX-License-Identifier: MIT
// Values of --set that name materials, as "Wood*:roughness", instead of a place.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/selection.h"

namespace fragtrace {

/// Returns true if the value is of materials by their name.
bool namesMaterials(const SetNumber& set);

/// Returns true if the text is what the pattern says: * stands for any letters, ? for one, and \ quotes the
/// next one.
bool matchesPattern(std::string_view pattern, std::string_view text);

/// The values with places in that document: one that names materials becomes one for each of them. Throws
/// UsageError where no material has the name, or materials have no such value.
std::vector<SetNumber> placedValues(const nlohmann::json& root, std::span<const SetNumber> set);

/// Returns true if a texture stands at that place of a material, or may stand there.
bool isTextureAt(std::string_view pointer);

/// Returns true if the user says a material's colour itself, at that place, where a texture is that it
/// multiplies.
bool tintsTexture(const nlohmann::json& root, const SetNumber& set, const std::string& place);

/// The extension that holds a place of a material; empty: none does.
std::string extensionIn(std::string_view pointer);

}  // namespace fragtrace
