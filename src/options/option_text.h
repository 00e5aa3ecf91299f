// SPDX-License-Identifier: MIT
// Options as text that a shell takes, and such text as words.
#pragma once

#include <string>
#include <vector>

namespace fragtrace {

/// The fewest digits, from 15 on, that the command line reads as the same number.
std::string exactText(double value);

/// The word, in quotes where a POSIX shell would not take it as it stands.
std::string quoted(const std::string& word);

/// Appends the option and its value, quoted.
void appendOption(std::string& text, const char* option, const std::string& value);

/// The words that a POSIX shell makes of a text by quotes, backslashes and continued lines; it expands
/// nothing. Throws UsageError for a quote without its end.
std::vector<std::string> splitWords(const std::string& text);

}  // namespace fragtrace
