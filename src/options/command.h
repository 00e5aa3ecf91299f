// SPDX-License-Identifier: MIT
// A command: one row of a table.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace fragtrace {

/// Settles the options of a command that was parsed, and runs it. Returns the exit status, and throws what
/// main.cpp maps to one.
using RunCommand = std::function<int()>;

struct CommandRow {
  const char* name;
  const char* sentence;              ///< the sentence in --help
  RunCommand (*add)(CLI::App& app);  ///< declares the command's options
};

}  // namespace fragtrace
