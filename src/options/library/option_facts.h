// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace CLI {
class App;
}

namespace fragtrace {

// What help says of an option beyond its sentence, kept with the option as the library declares it.

struct OptionFacts {
  std::vector<std::string> choices{};  ///< the names that a value may be
  bool open = false;                   ///< a value may be something else than a choice, too
  std::optional<double> least{};
  std::optional<double> most{};
  std::string metavariable{};  ///< what stands for the value; empty: a word for its type
  std::string unit{};
  bool everyday = true;  ///< --help shows it, else --help all alone
};

/// A check that has these facts with it; without a function it accepts everything. Those of a later check of
/// an option replace what earlier ones say.
CLI::Validator withFacts(const OptionFacts& facts, std::function<std::string(std::string&)> check = {});

/// Does the same of names alone, which the option checks by itself.
template <typename Names>
CLI::Validator withChoices(const Names& names, bool open = false) {
  return withFacts({.choices = std::vector<std::string>(names.begin(), names.end()), .open = open});
}

OptionFacts factsOf(const CLI::Option& option);

/// What the values of an option are.
enum class ValueKind : uint8_t { Flag, Integer, Number, Choice, Text, File, Folder };

ValueKind kindOf(const CLI::Option& option);

/// The word that stands for the option's value in help; empty for a flag.
std::string metavariableOf(const CLI::Option& option);

/// Returns true if the option may be given several times, and its values add up.
bool isRepeatable(const CLI::Option& option);

/// Takes out all uses of an option but the last, unless its values add up. Returns a message about each.
std::vector<std::string> keepLast(const CLI::App& app, std::vector<std::string>& words);

}  // namespace fragtrace
