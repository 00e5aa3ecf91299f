// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "options/command.h"

namespace fragtrace {

/// Whether the words, not parsed yet, ask for JSON on stderr, which an error in them is told by, too.
bool asksForJson(std::span<const char* const> words);

/// Runs the command that the arguments ask for, or prints help or version, and returns the exit status.
/// Throws UsageError, and what the command does.
int runCommandLine(int argc, const char* const* argv);

/// Adds the commands to an app that has nothing but commands; the result runs the one that was parsed.
RunCommand addCommands(CLI::App& app, std::span<const CommandRow> rows);

}  // namespace fragtrace
