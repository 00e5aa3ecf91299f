// SPDX-License-Identifier: MIT
// The text of --help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace fragtrace {

/// "fragtrace bench frame"
std::string fullName(const CLI::App& app);

/// "fragtrace diff [options] picture reference"
std::string usageOf(const CLI::App& app);

/// The forms of an option, short ones first: "-o", "--output".
std::vector<std::string> formsOf(const CLI::Option& option);

/// "0.01 to 1e+07", of a number that has a range; else empty.
std::string rangeText(const CLI::Option& option);

/// Writes help by topic, wrapped to the width of the terminal.
class HelpText : public CLI::FormatterBase {
 public:
  /// Shows all options, not the everyday ones alone.
  bool all = false;

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace fragtrace
