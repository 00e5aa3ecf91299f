// SPDX-License-Identifier: MIT
// `help --json`: the table of options for programs (docs/options-json.md).
#pragma once

namespace CLI {
class App;
}

#include <string>

namespace fragtrace {

/// The commands of this app, with those that they group, and all options of them.
std::string helpJson(const CLI::App& app, const char* version);

}  // namespace fragtrace
