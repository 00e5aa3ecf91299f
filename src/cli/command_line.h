// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace fragtrace {

// A command: one row of a table.

/// Settles the options of a command that was parsed, and runs it. Returns the exit status, and throws what
/// main.cpp maps to one.
using RunCommand = std::function<int()>;

struct CommandRow {
  const char* name;
  const char* sentence;              ///< the sentence in --help
  RunCommand (*add)(CLI::App& app);  ///< declares the command's options
};

// The text of --help.

/// "0.01 to 1e+07", of a number that has a range; else empty.
std::string rangeText(const CLI::Option& option);

/// Writes help by topic, wrapped to the width of the terminal.
class HelpText : public CLI::FormatterBase {
 public:
  /// Shows all options, not the everyday ones alone.
  bool all = false;

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

// `help --json`: the table of options for programs (docs/options-json.md).

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

/// Adds the commands to an app that has nothing but commands; the result runs the one that was parsed. With
/// the name of one, only that one's options are declared.
RunCommand addCommands(CLI::App& app, std::span<const CommandRow> rows, std::string_view only = {});

}  // namespace fragtrace
