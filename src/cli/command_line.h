// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "options/command.h"

namespace fragtrace {

/// Returns true if the words, not parsed yet, ask for JSON on stderr. Errors in them are then JSON, too.
bool asksForJson(std::span<const char* const> words);

/// The words as a command: a first word that is a file is to be viewed (one with the name of a command is
/// ./NAME), and `help COMMAND` is `COMMAND --help`.
std::vector<const char*> withCommand(std::span<const CommandRow> rows, int argc, const char* const* argv);

/// Runs the command of these rows that the words ask for, the program's name first, or prints help or
/// version, and returns the exit status. Throws UsageError, and what the command does.
int runCommandLine(std::span<const CommandRow> rows, std::span<const char* const> words);

/// Declares --version, which prints the program's version.
void addVersion(CLI::App& app);

/// Adds the commands to an app that has nothing but commands; the result runs the one that was parsed.
RunCommand addCommands(CLI::App& app, std::span<const CommandRow> rows);

}  // namespace fragtrace
