// SPDX-License-Identifier: MIT
// The objects of a document that the chosen scene uses, followed by the references of the schema.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "gltf/check/schema.h"
#include "scene/parts.h"

namespace fragtrace {

/// The place of the object that holds a place: an element of one of the root's arrays, "/meshes/0" of
/// "/meshes/0/primitives/1", or of an extension's; "" for what is the root's own.
std::string_view ownerOf(std::string_view place);

using Owners = std::set<std::string, std::less<>>;

/// The owners that are reached from the selected scene; animations only if a time is asked for, and materials
/// of variants only if one is. The document need not have passed the schema.
Owners usedObjects(const nlohmann::json& root, std::span<const Rule> rules, const SceneSelection& selection);

}  // namespace fragtrace
