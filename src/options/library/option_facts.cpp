// SPDX-License-Identifier: MIT
#include "options/library/option_facts.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/split.h"
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

}  // namespace fragtrace
