// SPDX-License-Identifier: MIT
#include "options/library/option_facts.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace fragtrace {

namespace {

/// The library keeps a name with each check. Ours are facts, as JSON.
std::string nameOf(const OptionFacts& facts) {
  nlohmann::json json;
  if (!facts.choices.empty()) json["choices"] = facts.choices;
  if (facts.open) json["open"] = true;
  if (facts.least) json["least"] = *facts.least;
  if (facts.most) json["most"] = *facts.most;
  if (!facts.metavariable.empty()) json["metavariable"] = facts.metavariable;
  if (!facts.unit.empty()) json["unit"] = facts.unit;
  if (!facts.everyday) json["everyday"] = false;
  return json.dump();
}

void addFacts(const nlohmann::json& json, OptionFacts& facts) {
  if (json.contains("choices")) {
    facts.choices = json["choices"].get<std::vector<std::string>>();
    facts.open = json.value("open", false);
  }
  if (json.contains("least")) facts.least = json["least"].get<double>();
  if (json.contains("most")) facts.most = json["most"].get<double>();
  facts.metavariable = json.value("metavariable", facts.metavariable);
  facts.unit = json.value("unit", facts.unit);
  facts.everyday = json.value("everyday", facts.everyday);
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
    if (check->get_name().starts_with('{')) addFacts(nlohmann::json::parse(check->get_name()), facts);
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
