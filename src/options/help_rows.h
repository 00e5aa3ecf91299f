// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "options/option_row.h"

namespace fragtrace {

/// The topics, in the order of help.
inline constexpr std::array kHelpTopics{"Scene", "Camera", "Light", "Look", "Quality", "Output", "Device"};

/// Where the option stands; `topic` is that of its part of the table.
OptionHelp helpOf(std::string_view name, const char* topic);

/// The names of all rows, each of which is an option.
std::vector<std::string_view> namesOfHelpRows();

}  // namespace fragtrace
