// SPDX-License-Identifier: MIT
#include "options/config_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "base/errors.h"
#include "base/text.h"
#include "image/files/whole_file.h"
#include "options/parse_words.h"

namespace fragtrace {

namespace {

using Json = nlohmann::ordered_json;

/// Names a member of the file in an error, as a JSON pointer (RFC 6901).
std::string placeOf(const std::filesystem::path& path, const std::string& name) {
  return path.string() + ": " + (Json::json_pointer() / name).to_string();
}

/// Throws InputError with line and column, also where a name stands twice.
Json parseFile(const std::filesystem::path& path) {
  const std::vector<uint8_t> bytes = readWholeFile(path);
  std::set<std::string> names;
  const auto watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::key && depth == 1) {
      const auto name = parsed.get<std::string>();
      if (!names.insert(name).second) throw InputError(placeOf(path, name) + ": stands there twice");
    }
    return true;
  };
  Json json;
  try {
    json = Json::parse(bytes, watch);
  } catch (const Json::exception& error) {
    // The message is "[json.exception...] parse error at line 1, column 2: ...". For numbers that are too
    // large it names no place.
    const std::string text = error.what();
    const size_t line = text.find("at line");
    throw InputError(path.string() + ": " +
                     text.substr(line == std::string::npos ? text.find(' ') + 1 : line));
  }
  if (!json.is_object()) throw InputError(path.string() + ": is no JSON object of option names");
  return json;
}

/// A value as the command line would spell it.
std::string spelled(const Json& value, const std::string& place) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_integer()) return value.dump();
  if (value.is_number()) return formatted("%.17g", value.get<double>());  // 17 digits name a double
  throw InputError(place + ": is neither a number nor a string");
}

std::vector<std::string> spelledValues(const Json& value, const std::string& place) {
  if (!value.is_array()) return {spelled(value, place)};
  std::vector<std::string> values;
  for (const Json& element : value)
    values.push_back(spelled(element, place + "/" + std::to_string(values.size())));
  return values;
}

/// An error that begins with the option's name, without it.
std::string afterName(const std::string& error, const std::string& name) {
  const std::string option = "--" + name;
  return error.starts_with(option + ": ") ? error.substr(option.size()) : ": " + error;
}

/// A hint at the member that a name may stand for: "; did you mean resolution?"
std::string memberMeant(std::string name, const CLI::App& command) {
  std::ranges::replace(name, '_', '-');
  name.erase(0, std::min(name.find_first_not_of('-'), name.size()));
  const std::string option = "--" + name;
  const bool isKnown = command.get_option_no_throw(option) != nullptr;
  if (name == "config" || name == "help" || name == "version") return "";
  const std::string meant = isKnown ? option : optionMeant(option, command);
  return meant.empty() ? "" : "; did you mean " + meant.substr(2) + "?";
}

/// Gives the command all options of the file that its command line has not given, nor one that excludes them.
/// Returns their names.
std::set<std::string> applyFile(const std::filesystem::path& path, CLI::App& command) {
  const Json json = parseFile(path);
  std::set<const CLI::Option*> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() > 0) given.insert(option);
  }
  std::set<std::string> taken;
  for (const auto& [name, value] : json.items()) {
    if (name == "$schema") continue;  // where editors find what the file may hold
    const std::string place = placeOf(path, name);
    CLI::Option* option = name.empty() || name[0] == '-' ? nullptr : command.get_option_no_throw("--" + name);
    if (option == nullptr || name == "config" || name == "help" || name == "version")
      throw InputError(place + ": is no option of " + command.get_name() + memberMeant(name, command));
    // Switches of the command line count more one by one, not as a list.
    const bool isSwitch = name == "enable" || name == "disable";
    bool overruled = given.contains(option) && !isSwitch;
    for (const CLI::Option* excluded : option->get_excludes()) {
      overruled = overruled || given.contains(excluded);
      if (!overruled && excluded->count() > 0)
        throw InputError(place + ": does not go with " + excluded->get_name());
    }
    const bool isFlag = option->get_expected_max() == 0;
    if (isFlag && !value.is_boolean()) throw InputError(place + ": is neither true nor false");
    if (!isFlag && value.is_array() && value.empty()) throw InputError(place + ": is empty");
    std::vector<std::string> values = isFlag ? std::vector<std::string>{"true"} : spelledValues(value, place);
    // An option that takes one word, such as "up", gets a list of numbers as one word with commas.
    if (option->get_type_name() == "TEXT" && option->get_items_expected_max() == 1 && value.is_array() &&
        std::ranges::all_of(value, &Json::is_number))
      values = {joined(values, ",")};
    if (name == "resolution") {
      for (std::string& size : values) size = withNumberSettled(size, "--resolution");
    }
    if (std::ranges::find(values, "") != values.end()) throw InputError(place + ": its value is empty");
    if (overruled || (isFlag && !value.get<bool>())) continue;
    try {
      if (isSwitch) option->clear();
      option->add_result(values);
      option->run_callback();
    } catch (const CLI::ParseError& error) {
      throw InputError(place + afterName(plainText(error, command), name));
    } catch (const UsageError& error) {
      throw InputError(place + afterName(error.what(), name));
    }
    taken.insert(name);
  }
  return taken;
}

}  // namespace

void addConfigOption(CLI::App& app, std::string& file) {
  app.add_option("--config", file, "JSON file of options by their long names; the command line overrides it")
      ->type_name("FILE");
}

int runConfigured(RawRender& raw, const std::filesystem::path& config, CLI::App& command,
                  const std::function<int(const RenderOptions&)>& run) {
  const auto noteGiven = [&] {
    for (const CLI::Option* option : command.get_options()) {
      if (option->count() > 0) raw.given.insert(option->get_name());
    }
  };
  if (config.empty()) {
    noteGiven();
    return run(finishRender(raw));
  }
  std::vector<std::string> enable = std::exchange(raw.enable, {});
  std::vector<std::string> disable = std::exchange(raw.disable, {});
  const std::set<std::string> taken = applyFile(config, command);
  raw.fileEnable = std::exchange(raw.enable, std::move(enable));
  raw.fileDisable = std::exchange(raw.disable, std::move(disable));
  noteGiven();
  try {
    return run(finishRender(raw));
  } catch (const UsageError& error) {
    // Messages about options begin with the option's name: "--region: ..." or "--output -: ...".
    const std::string text = error.what();
    for (const std::string& name : taken) {
      const std::string option = "--" + name;
      if (text.starts_with(option + ": ") || text.starts_with(option + " "))
        throw InputError(placeOf(config, name) + afterName(text, name));
    }
    throw;
  }
}

RenderOptions finishConfigured(RawRender& raw, const std::filesystem::path& config, CLI::App& command) {
  RenderOptions finished;
  runConfigured(raw, config, command, [&](const RenderOptions& options) {
    finished = options;
    return 0;
  });
  return finished;
}

}  // namespace fragtrace
