// SPDX-License-Identifier: MIT
// The places of things in the window, for scripts that click on them (docs/viewer.md).
#pragma once

#include <array>
#include <map>
#include <string>

namespace fragtrace {

/// Left, top, width and height by name, in pixels of the window.
using Places = std::map<std::string, std::array<float, 4>>;

/// Adds the window of Dear ImGui that is being made.
void addWindowPlace(Places& places, const std::string& name);

/// Adds the item of Dear ImGui that was made last, and returns what that returned.
bool placed(Places& places, const std::string& name, bool result = true);

}  // namespace fragtrace
