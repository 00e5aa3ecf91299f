// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "options/command.h"

namespace fragtrace {

/// Whether the words, not parsed yet, ask for JSON on stderr, which an error in them is told by, too.
bool asksForJson(std::span<const char* const> words);

/// A first word that is no command but a file is to be viewed; a file with the name of a command is ./NAME.
std::vector<const char*> withView(std::span<const CommandRow> rows, int argc, const char* const* argv);

/// Runs the command of these rows that the words ask for, the program's name first, or prints help or
/// version, and returns the exit status. Throws UsageError, and what the command does.
int runCommandLine(std::span<const CommandRow> rows, std::span<const char* const> words);

/// Adds the commands to an app that has nothing but commands; the result runs the one that was parsed.
RunCommand addCommands(CLI::App& app, std::span<const CommandRow> rows);

}  // namespace fragtrace
