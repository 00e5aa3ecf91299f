// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

/// The option that an unknown one probably means: what other programs call it, the same beginning, or similar
/// letters; empty if none is near. Names have their dashes.
std::string suggestedOption(const std::string& unknown, const std::vector<std::string>& known);

/// The most similar name; empty if more than a third of the letters differ.
std::string nearestName(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace fragtrace
