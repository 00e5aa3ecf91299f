// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "options/command.h"

namespace fragtrace {

/// Runs the command that the arguments ask for, or prints help or version, and returns the exit status.
/// Throws UsageError, and what the command does.
int runCommandLine(int argc, const char* const* argv);

/// Adds the commands to an app that has nothing but commands; the result runs the one that was parsed.
RunCommand addCommands(CLI::App& app, std::span<const CommandRow> rows);

}  // namespace fragtrace
