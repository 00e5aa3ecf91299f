// SPDX-License-Identifier: MIT
#include "options/library/option_facts.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include "base/text.h"

namespace fragtrace {

namespace {

/// The library keeps a name with each check. Ours are facts, a line each, after this one.
constexpr std::string_view kFacts = "facts";

std::string nameOf(const OptionFacts& facts) {
  std::string name(kFacts);
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) name.append("\n").append(key).append(" ").append(value);
  };
  for (const std::string& choice : facts.choices) add("choice", choice);
  if (facts.open) add("open", "1");
  if (facts.least) add("least", formatted("%.17g", *facts.least));
  if (facts.most) add("most", formatted("%.17g", *facts.most));
  add("metavariable", facts.metavariable);
  add("unit", facts.unit);
  if (!facts.everyday) add("rare", "1");
  return name;
}

void addFacts(const std::string& name, OptionFacts& facts) {
  std::vector<std::string> choices;
  bool open = false;
  for (const std::string_view line : splitText(name, '\n')) {
    const size_t space = std::min(line.find(' '), line.size());
    const std::string_view key = line.substr(0, space);
    const std::string value(line.substr(std::min(space + 1, line.size())));
    if (key == "choice") choices.push_back(value);
    if (key == "open") open = true;
    if (key == "least") facts.least = numberOfAll<double>(value);
    if (key == "most") facts.most = numberOfAll<double>(value);
    if (key == "metavariable") facts.metavariable = value;
    if (key == "unit") facts.unit = value;
    if (key == "rare") facts.everyday = false;
  }
  if (choices.empty()) return;
  facts.choices = std::move(choices);
  facts.open = open;
}

constexpr int kUnlimited = 1 << 20;  // the library has several numbers for this

}  // namespace

CLI::Validator withFacts(const OptionFacts& facts, std::function<std::string(std::string&)> check) {
  if (!check) check = [](const std::string&) { return std::string(); };
  return {std::move(check), "", nameOf(facts)};
}

OptionFacts factsOf(const CLI::Option& declared) {
  auto& option = const_cast<CLI::Option&>(declared);  // the library reads checks of changeable options alone
  OptionFacts facts;
  for (int i = 0;; ++i) {
    const CLI::Validator* check = nullptr;
    try {
      check = option.get_validator(i);
    } catch (const CLI::OptionNotFound&) {
      return facts;  // the library does not say how many there are
    }
    if (check->get_name().starts_with(kFacts)) addFacts(check->get_name(), facts);
  }
}

ValueKind kindOf(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return ValueKind::Flag;
  const std::string type = option.get_type_name();
  if (type.starts_with("FILE")) return ValueKind::File;
  if (type == "FOLDER") return ValueKind::Folder;
  if (!factsOf(option).choices.empty()) return ValueKind::Choice;
  if (type == "INT" || type == "UINT") return ValueKind::Integer;
  return type == "FLOAT" ? ValueKind::Number : ValueKind::Text;
}

std::string metavariableOf(const CLI::Option& option) {
  const ValueKind kind = kindOf(option);
  if (kind == ValueKind::Flag) return "";
  const OptionFacts facts = factsOf(option);
  if (!facts.metavariable.empty()) return facts.metavariable;
  std::string word = option.get_type_name();
  if (kind == ValueKind::Integer) word = "N";
  if (kind == ValueKind::Number) word = "X";
  if (kind == ValueKind::Choice) word = facts.open ? "VALUE" : "NAME";
  if (option.get_items_expected_max() >= kUnlimited && option.get_delimiter() != '\0') return word + ",...";
  std::string all = word;
  for (int i = 1; i < std::min(option.get_items_expected_max(), 8); ++i) all += "," + word;
  return option.get_items_expected_max() >= kUnlimited ? word : all;
}

bool isRepeatable(const CLI::Option& option) { return option.get_items_expected_max() >= kUnlimited; }

namespace {

/// The command that the words name.
const CLI::App& commandNamedIn(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    const auto grouped = command->get_subcommands([](const CLI::App*) { return true; });
    const auto next = std::ranges::find(grouped, word, [](const CLI::App* one) { return one->get_name(); });
    if (next != grouped.end()) command = *next;
  }
  return *command;
}

/// An option with its value, as words.
struct Use {
  const CLI::Option* option;
  size_t begin;
  size_t end;
};

/// The use that begins at a word; no option, if none does.
Use useAt(const CLI::App& command, const std::vector<std::string>& words, size_t i) {
  const std::string& word = words[i];
  const bool isLong = word.starts_with("--");
  const std::string name = isLong ? word.substr(0, word.find('=')) : word.substr(0, 2);
  Use use{word.starts_with('-') ? command.get_option_no_throw(name) : nullptr, i, i + 1};
  if (use.option == nullptr || word.size() > name.size()) return use;
  const char delimiter = use.option->get_delimiter();
  for (int values = 0; values < use.option->get_items_expected_min() && use.end < words.size(); ++use.end) {
    const std::string& value = words[use.end];
    if (value.size() > 1 && value[0] == '-' && !isNegativeNumber(value)) break;
    values += 1 + (delimiter == '\0' ? 0 : int(std::ranges::count(value, delimiter)));
  }
  return use;
}

}  // namespace

std::vector<std::string> keepLast(const CLI::App& app, std::vector<std::string>& words) {
  const CLI::App& command = commandNamedIn(app, words);
  std::vector<Use> uses;
  for (size_t i = 0; i < words.size(); i = uses.back().end) uses.push_back(useAt(command, words, i));
  std::vector<std::string> kept;
  std::vector<std::string> notes;
  for (auto use = uses.begin(); use != uses.end(); ++use) {
    const bool isLast = use->option == nullptr || isRepeatable(*use->option) ||
                        std::find_if(use + 1, uses.end(), [&](const Use& later) {
                          return later.option == use->option;
                        }) == uses.end();
    const auto first = words.begin() + std::ptrdiff_t(use->begin);
    const auto end = words.begin() + std::ptrdiff_t(use->end);
    if (isLast)
      kept.insert(kept.end(), first, end);
    else
      notes.push_back(CLI::detail::join(std::vector(first, end), " ") + " is left out: " +
                      use->option->get_name() + " is given again, and the last one counts");
  }
  words = std::move(kept);
  return notes;
}

}  // namespace fragtrace
