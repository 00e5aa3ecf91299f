// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/errors.h"
#include "base/text.h"
#include "scene/parts.h"
#include "shader/stage.h"

namespace fragtrace {

// Options whose value is one of some names.

/// "'x' is none of a, b, c"
template <typename Names>
std::string whyNoneOf(const std::string& name, const Names& names) {
  return "'" + name + "' is none of " + joined(names);
}

/// The value of a name in a list of names whose order is that of the values. The case of letters does not
/// count. Throws UsageError.
template <typename Value, typename Names>
Value choose(const char* option, const std::string& name, const Names& names) {
  int index = 0;
  for (const auto& candidate : names) {
    if (isSameButForCase(name, candidate)) return Value(index);
    ++index;
  }
  throw UsageError(std::string(option) + ": " + whyNoneOf(name, names));
}

// Options as text that a shell takes, and such text as words.

/// The fewest digits, from 15 on, that the command line reads as the same number.
std::string exactText(double value);

/// The word, in quotes where a POSIX shell would not take it as it stands.
std::string quoted(const std::string& word);

/// Appends the option and its value, quoted.
void appendOption(std::string& text, const char* option, const std::string& value);

/// The words that a POSIX shell makes of a text by quotes, backslashes and continued lines; it expands
/// nothing. Throws UsageError for a quote without its end.
std::vector<std::string> splitWords(const std::string& text);

// Names of stages, as options spell them.

/// Returns the names in the order of stageRows(). `cumulativeOnly`: only those that --stage takes.
std::vector<std::string> stageNames(bool cumulativeOnly);

/// Throws UsageError.
Stage stageNamed(const char* option, const std::string& name);

}  // namespace fragtrace
