// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

/// The option that somebody meant who wrote one that is not there, by what other programs call it, its
/// beginning, or its letters; empty when none is near. Names stand with their dashes.
std::string suggestedOption(const std::string& unknown, const std::vector<std::string>& known);

/// The nearest name by its letters, of which a third may be wrong; empty when none is near.
std::string nearestName(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace fragtrace
