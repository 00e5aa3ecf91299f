// SPDX-License-Identifier: MIT
#include "cli/help_json.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/help_text.h"
#include "options/library/option_facts.h"
#include "session/scene_json.h"

namespace fragtrace {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kKindNames{"flag", "integer", "number", "choice", "text", "file", "folder"};

Json boundOf(const std::optional<double>& bound, ValueKind kind) {
  if (!bound) return nullptr;
  return kind == ValueKind::Integer ? Json(std::llround(*bound)) : Json(*bound);
}

/// The extensions of files that the text names, without dots.
std::vector<std::string> extensionsIn(const std::string& text) {
  std::vector<std::string> found;
  for (size_t at = text.find('.'); at != std::string::npos; at = text.find('.', at + 1)) {
    const size_t end = std::min(text.find_first_not_of("abcdefghijklmnopqrstuvwxyz", at + 1), text.size());
    const std::string name = text.substr(at + 1, end - at - 1);
    const bool apart = at == 0 || std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0;
    if (apart && name.size() >= 3 && name.size() <= 4 && std::ranges::find(found, name) == found.end())
      found.push_back(name);
  }
  if (found.empty() && text.find("JSON") != std::string::npos) found.emplace_back("json");
  return found;
}

Json optionJson(const CLI::Option& option) {
  const OptionFacts facts = factsOf(option);
  const ValueKind kind = kindOf(option);
  const bool several = isRepeatable(option);
  Json json;
  json["name"] = option.nonpositional() ? option.get_lnames().front() : option.get_name();
  json["forms"] = formsOf(option);
  json["metavariable"] = metavariableOf(option);
  json["type"] = kKindNames[size_t(kind)];
  json["choices"] = facts.choices;
  json["other_values"] = facts.choices.empty() || facts.open;
  json["default"] = option.get_default_str().empty() ? Json(nullptr) : Json(option.get_default_str());
  json["range"] = nullptr;
  if (facts.least || facts.most) json["range"] = {boundOf(facts.least, kind), boundOf(facts.most, kind)};
  json["units"] = facts.unit.empty() ? Json(nullptr) : Json(facts.unit);
  json["group"] = option.nonpositional() ? option.get_group() : "Arguments";
  json["everyday"] = facts.everyday;
  json["values"] = {option.get_items_expected_min(), option.get_items_expected_max()};
  if (several) json["values"] = {1, nullptr};
  json["separator"] =
      option.get_delimiter() == '\0' ? Json(nullptr) : Json(std::string(1, option.get_delimiter()));
  json["repeatable"] = several;
  json["required"] = option.get_required();
  json["excludes"] = Json::array();
  for (const CLI::Option* other : option.get_excludes()) json["excludes"].push_back(other->get_name());
  json["extensions"] = Json::array();
  if (kind == ValueKind::File) json["extensions"] = extensionsIn(option.get_description());
  json["text"] = option.get_description();
  return json;
}

void addCommand(const CLI::App& app, Json& commands, Json& options) {
  const std::vector<const CLI::App*> own = app.get_subcommands([](const CLI::App*) { return true; });
  const std::string whole = fullName(app);
  const std::string name = app.get_parent() == nullptr ? "" : whole.substr(whole.find(' ') + 1);
  Json grouped = Json::array();
  for (const CLI::App* command : own) grouped.push_back(command->get_name());
  commands.push_back(
      {{"name", name}, {"text", app.get_description()}, {"usage", usageOf(app)}, {"commands", grouped}});
  for (const CLI::Option* option : app.get_options()) {
    Json json = optionJson(*option);
    const auto same = std::ranges::find_if(options, [&](Json known) {
      known.erase("commands");
      return known == json;
    });
    if (same != options.end()) {
      (*same)["commands"].push_back(name);
    } else {
      json["commands"] = {name};
      options.push_back(std::move(json));
    }
  }
  for (const CLI::App* command : own) addCommand(*command, commands, options);
}

}  // namespace

std::string helpJson(const CLI::App& app, const char* version) {
  Json json = {{"schema", 1}, {"version", version}, {"commands", Json::array()}, {"options", Json::array()}};
  addCommand(app, json["commands"], json["options"]);
  return jsonText(json);
}

}  // namespace fragtrace
