// SPDX-License-Identifier: MIT
#pragma once

namespace CLI {
class App;
}

#include <string>
#include <vector>

namespace fragtrace {

/// Takes out all uses of an option but the last, unless its values add up. Returns a message about each.
std::vector<std::string> keepLast(const CLI::App& app, std::vector<std::string>& words);

}  // namespace fragtrace
