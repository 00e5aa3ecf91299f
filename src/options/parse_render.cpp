// SPDX-License-Identifier: MIT
#include "options/parse_render.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/report.h"
#include "base/text.h"
#include "image/files/whole_file.h"
#include "image/image.h"
#include "options/library/option_facts.h"
#include "options/numbers.h"
#include "options/option_row.h"
#include "options/row_makers.h"

namespace fragtrace {

namespace {

constexpr double kMostMetres = 1e9;
constexpr double kMostStrength = 1e9;
const std::vector<std::string> kOfSun{"from", "strength", "color"};
const std::vector<std::string> kOfArea{"at", "to", "size", "power", "color"};

[[noreturn]] void refuse(const std::string& what) { throw UsageError("--add-light: " + what); }

/// The numbers of NAME=VALUES: `least` to `most` of them, each within the bound.
std::vector<double> valuesOf(const std::string& name, const std::string& text, size_t least, size_t most,
                             double bound) {
  std::vector<double> values;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::optional<double> value = numberIn(part);
    if (!value || !(std::abs(*value) <= bound))
      refuse(formatted("%s: '%s' is no number from %g to %g", name.c_str(), part.c_str(), -bound, bound));
    values.push_back(*value);
  }
  if (values.size() < least || values.size() > most)
    refuse(name + " takes " + countText(most, "number") + ", not " + std::to_string(values.size()));
  return values;
}

double positive(const std::string& name, double value) {
  if (!(value > 0.0)) refuse(name + ": is not above 0");
  return value;
}

void take(const std::string& name, const std::string& text, AddedLight& light) {
  const auto values = [&](size_t count, double bound) { return valuesOf(name, text, count, count, bound); };
  const auto vector = [&](double bound) {
    const std::vector<double> v = values(3, bound);
    return glm::dvec3(v[0], v[1], v[2]);
  };
  if (name == "from") {
    const std::vector<double> v = values(2, 360.0);
    if (std::abs(v[1]) > 90.0) refuse("from: the elevation is not between -90 and 90 degrees");
    light.from = {v[0], v[1]};
  } else if (name == "at") {
    light.at = vector(kMostMetres);
  } else if (name == "to") {
    light.target = vector(kMostMetres);
  } else if (name == "size") {
    const std::vector<double> v = valuesOf(name, text, 1, 2, kMostMetres);
    light.size = {positive(name, v.front()), positive(name, v.back())};
  } else if (name == "color") {
    light.color = colorIn("--add-light: color", text, kMostStrength);
    if (light.color == glm::dvec3(0.0)) refuse("color: is black");
  } else {
    light.strength = positive(name, values(1, kMostStrength)[0]);
  }
}

}  // namespace

AddedLight addedLightIn(const std::string& text) {
  std::istringstream words(text);
  std::string kind;
  words >> kind;
  if (kind != "sun" && kind != "area") refuse("'" + kind + "' is none of area, sun");
  AddedLight light{.isSun = kind == "sun"};
  if (!light.isSun) light.strength = kAreaPower;
  const std::vector<std::string>& known = light.isSun ? kOfSun : kOfArea;
  std::vector<std::string> given;
  for (std::string word; words >> word;) {
    const size_t equals = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, equals);
    if (std::ranges::find(known, name) == known.end())
      refuse(formatted("'%s' is none of %s of %s%s", name.c_str(), joined(known).c_str(), kind.c_str(),
                       didYouMean(name, known).c_str()));
    if (equals + 1 >= word.size())
      refuse(formatted("%s: its value is missing, as in %s=1", name.c_str(), name.c_str()));
    take(name, word.substr(equals + 1), light);
    given.push_back(name);
  }
  if (!light.isSun && std::ranges::find(given, "at") == given.end())
    refuse("area: its place is missing, as in \"area at=0,2,1\"");
  if (!light.isSun && light.target == light.at) refuse("to: is the place of the light itself");
  return light;
}

std::string textOf(const AddedLight& light) {
  const auto vector = [](const glm::dvec3& v) { return numbersText(v.x, v.y, v.z); };
  std::string text = light.isSun ? "sun from=" + numbersText(light.from.x, light.from.y) +
                                       " strength=" + exactText(light.strength)
                                 : "area at=" + vector(light.at);
  if (light.target) text += " to=" + vector(*light.target);
  if (!light.isSun)
    text += " size=" + numbersText(light.size.x, light.size.y) + " power=" + exactText(light.strength);
  if (light.color != glm::dvec3(1.0)) text += " color=" + vector(light.color);
  return text;
}

namespace {

constexpr const char* kEndOfOptions = "--";  // by POSIX, all words after it are files

/// The command that was given.
const CLI::App& chosenCommand(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return *command;
}

/// Throws UsageError for a value that is there and empty, which the library takes for none, or for the next
/// word: a variable of a script that is not set.
void checkValues(const std::vector<std::string>& words) {
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    // The library would take the = for the first letter of the value.
    if (word.size() > 3 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) &&
        word[2] == '=')
      throw UsageError(word.substr(0, 2) + ": no = goes between it and its value: " + word.substr(0, 2) +
                       " " + word.substr(3));
    const bool joined = word.starts_with("--") && word.find('=') == word.size() - 1;
    if (!joined && !word.empty()) continue;
    const std::string option = joined ? word.substr(0, word.size() - 1) : i > 0 ? words[i - 1] : "";
    throw UsageError(option.starts_with('-') ? option + ": its value is empty" : "an argument is empty");
  }
}

/// The library would take a switch with any word for true or false.
void refuseValuesOfSwitches(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() == 0) option->disable_flag_override();
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    refuseValuesOfSwitches(*command);
}

bool isVerbose(const CLI::App& app) {
  const CLI::Option* verbose = chosenCommand(app).get_option_no_throw("--verbose");
  return verbose != nullptr && verbose->count() > 0;
}

/// Finds the first of the other commands that has the option.
std::string commandWith(const std::string& option, const CLI::App& command) {
  const CLI::App& group = command.get_parent() == nullptr ? command : *command.get_parent();
  for (const CLI::App* other : group.get_subcommands([](const CLI::App*) { return true; })) {
    if (other->get_option_no_throw(option) != nullptr) return other->get_name();
  }
  return "";
}

/// The option of the command that an unknown one ("--widht") most likely stands for; empty if none is near.
std::string optionMeant(const std::string& unknown, const CLI::App& command) {
  std::vector<std::string> known;
  for (const CLI::Option* one : command.get_options()) known.push_back(one->get_name());
  return suggestedOption(unknown, known);
}

/// Names the arguments that the library did not expect.
std::string whatIsUnknown(const CLI::App& app, const std::vector<std::string>& left) {
  const CLI::App& command = chosenCommand(app);
  const auto end = std::ranges::find(left, kEndOfOptions);
  if (end != left.end() && left.size() > 1)
    return "'" + (end == left.begin() ? left[1] : left[0]) + "' is an argument too many: words after " +
           kEndOfOptions + " are files, and options stand before it";
  const auto option =
      std::ranges::find_if(left, [](const std::string& word) { return word.starts_with('-'); });
  if (option == left.end()) {
    const bool writes =
        isWritableImageName(left.front()) && command.get_option_no_throw("--output") != nullptr;
    return "'" + left.front() + "' is an argument too many" +
           (writes ? "; did you mean -o " + left.front() + "?" : "");
  }
  const std::string unknown = option->substr(0, option->find('='));
  if (command.get_option_no_throw(unknown) != nullptr)
    return unknown + " stands before the command; options of " + command.get_name() + " stand behind it";
  const std::string text = unknown + " is no option of " + command.get_name();
  const std::string meant = optionMeant(unknown, command);
  const std::string other = commandWith(unknown, command);
  std::error_code error;
  if (std::filesystem::exists(*option, error)) return text + "; a file of that name is ./" + *option;
  if (!meant.empty()) return text + "; did you mean " + meant + "?";
  return text + (other.empty() ? "" : "; did you mean the command " + other + "?");
}

/// "3", "2 or 3", "2 to 4"
std::string rangeText(int least, int most) {
  if (least == most) return std::to_string(most);
  return std::to_string(least) + (most == least + 1 ? " or " : " to ") + std::to_string(most);
}

/// Says an error of the option library about a command, or about one that it groups.
std::string plainText(const CLI::ParseError& error, const CLI::App& app) {
  static const std::regex kCount("(.*): At (?:Most|least) \\d+ required but received (\\d+)",
                                 std::regex::icase);
  static const std::pair<std::regex, const char*> kWordings[] = {
      {std::regex("(.*): \\d+ required .* missing"), "$1: its value is missing"},
      {std::regex("-*(\\S+) was given a disallowed flag override"), "--$1: takes no value"},
      {std::regex("Could not convert: (\\S+) = (.*)"), "$1: '$2' is no value of this option"},
      {std::regex("(\\S+) excludes (\\S+)"), "$1: does not go with $2"},
  };
  std::string text = error.what();
  std::smatch found;
  if (std::regex_match(text, found, kCount)) {
    const CLI::Option* option = chosenCommand(app).get_option_no_throw(found[1]);
    const int most = option == nullptr ? 1 : option->get_items_expected_max();
    const int least = option == nullptr ? 1 : option->get_items_expected_min();
    return found[1].str() + ": takes " + (most == 1 ? "one value" : rangeText(least, most) + " values") +
           ", not " + found[2].str();
  }
  for (const auto& [pattern, wording] : kWordings) {
    if (std::regex_match(text, pattern)) return std::regex_replace(text, pattern, wording);
  }
  return text;
}

}  // namespace

std::string withNumberSettled(std::string argument, std::string_view before) {
  if (argument.starts_with("-.") && argument.size() > 2 &&
      std::isdigit(static_cast<unsigned char>(argument[2]))) {
    argument.insert(1, "0");
  }
  constexpr std::string_view kResolution = "--resolution=";
  constexpr const char* kDigits = "0123456789";
  const bool joined = argument.starts_with(kResolution);
  if (!joined && before != kResolution.substr(0, kResolution.size() - 1)) return argument;
  const size_t start = joined ? kResolution.size() : 0;
  const size_t middle = argument.find_first_not_of(kDigits, start);
  const bool isSize = middle != std::string::npos && middle > start && argument[middle] == 'x' &&
                      middle + 1 < argument.size() &&
                      argument.find_first_not_of(kDigits, middle + 1) == std::string::npos;
  if (isSize) argument[middle] = ',';
  return argument;
}

void parseWords(CLI::App& app, std::vector<std::string> words, const char* more) {
  const std::vector<std::string> files(std::ranges::find(words, kEndOfOptions), words.end());
  if (std::ranges::find(files, "") != files.end()) throw UsageError("an argument is empty");
  words.resize(words.size() - files.size());
  // The last one comes first, so that the word before is still as it was given.
  for (size_t i = words.size(); i-- > 0;)
    words[i] = withNumberSettled(words[i], i > 0 ? std::string_view(words[i - 1]) : std::string_view());
  checkValues(words);
  const std::vector<std::string> repeated = keepLast(app, words);
  words.insert(words.end(), files.begin(), files.end());
  refuseValuesOfSwitches(app);
  std::ranges::reverse(words);  // last first, as the library wants them
  try {
    app.parse(words);
  } catch (const CLI::Success&) {
    throw;
  } catch (const CLI::ParseError& error) {
    // A word that is not known counts more than what is missing: it may be that, misspelled.
    std::vector<std::string> left = app.remaining(true);
    if (left == std::vector<std::string>{kEndOfOptions}) left.clear();
    const bool isAboutWords = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
                              dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (isAboutWords && !left.empty() && *more == '\0')
      throw UsageError("not understood: " + CLI::detail::join(left, " "));
    const std::string text = isAboutWords && !left.empty() ? whatIsUnknown(app, left) : plainText(error, app);
    throw UsageError(text + (text.ends_with('?') ? "" : more));
  }
  if (!isVerbose(app)) return;
  for (const std::string& note : repeated) reportMessage(note);
}

namespace {

struct OtherName {
  std::string_view other;
  std::string_view ours;
};

/// Names of options in other renderers. Ours have a form where a value would not do as it stands.
constexpr auto kOtherNames = std::to_array<OtherName>({
    {"--samples", "--spp"},
    {"--samples-per-pixel", "--spp"},
    {"--raytracing-samples", "--spp"},
    {"--raytracing-denoise", "--denoise"},
    {"--camera-orthographic", "--camera-parallel-scale"},
    {"--camera-direction", "--camera-orbit AZIMUTH,ELEVATION"},
    {"--roughness", "--set \"*:roughness=VALUE\""},
    {"--metallic", "--set \"*:metallic=VALUE\""},
    {"--size", "--resolution WIDTHxHEIGHT"},
    {"--width", "--resolution WIDTHxHEIGHT"},
    {"--height", "--resolution WIDTHxHEIGHT"},
    {"--depth", "--bounces"},
    {"--max-depth", "--bounces"},
    {"--max-bounces", "--bounces"},
    {"--env", "--hdri-file"},
    {"--environment", "--hdri-file"},
    {"--envmap", "--hdri-file"},
    {"--hdri", "--hdri-file"},
    {"--fov", "--camera-view-angle"},
    {"--background", "--background-color"},
    {"--bg-color", "--background-color"},
    {"--transparent", "--no-background"},
    {"--film-transparent", "--no-background"},
    {"--integrator", "--stage gi"},
    {"--tonemap", "--tone-map"},
    {"--up-axis", "--up"},
    {"--frame", "--frames A:B"},
    {"--frame-rate", "--fps"},
    {"--framerate", "--fps"},
    {"--help-all", "--help all"},
    {"-v", "--version"},
    {"-V", "--version"},
    {"-v", "--verbose"},
    {"-q", "--quiet"},
});

}  // namespace

std::string suggestedOption(const std::string& unknown, const std::vector<std::string>& known) {
  const auto isKnown = [&](std::string_view name) { return std::ranges::find(known, name) != known.end(); };
  for (const OtherName& name : kOtherNames) {
    const std::string_view ours = name.ours.substr(0, name.ours.find(' '));
    if (name.other == unknown && isKnown(ours)) return std::string(name.ours);
  }
  constexpr size_t kDashes = 2;
  for (const std::string& name : known) {
    if (unknown.size() > kDashes && name.starts_with(unknown)) return name;
  }
  return nearestName(unknown, known);
}

namespace {

CLI::Option* declare(CLI::App& app, const OptionRow& row, RawRender& raw) {
  row.add(app, row, raw);
  CLI::Option* option = app.get_option(row.name);
  const OptionHelp& shown = row.shown;
  const auto text = [](const char* word) { return std::string(word == nullptr ? "" : word); };
  option->check(withFacts({.choices = row.choices,
                           .open = row.open,
                           .metavariable = text(shown.metavariable),
                           .unit = text(shown.unit),
                           .everyday = shown.everyday}));
  if (row.name[0] == '-') option->group(shown.topic);
  return option;
}

}  // namespace

CLI::Option* addOption(CLI::App& app, const char* name, RawRender& raw) {
  return declare(app, rowOf(name), raw);
}

CLI::Option* addOption(CLI::App& app, const char* name, RawRender& raw, const std::string& help) {
  return addOption(app, name, raw)->description(help);
}

void addOptions(CLI::App& app, OptionGroup group, RawRender& raw) {
  for (const OptionRow& row : optionRows()) {
    if (row.traits.group == group) declare(app, row, raw);
  }
}

void addDeviceOptions(CLI::App& app, RawRender& raw) {
  for (const char* name :
       {"--rendering-backend", "--device", "--buffer-reads", "--vector-width", "--shader-folder", "--quiet"})
    addOption(app, name, raw);
}

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

/// Each says who lights the scene.
constexpr std::initializer_list<const char*> kLighting = {
    "hdri-file", "studio", "studio-look", "sky", "default-light", "no-default-light", "shop"};

/// Gives the command all options of the file that its command line has not given, nor one that excludes them.
/// Those of a file of defaults do not meet others, switches included. Returns their names.
std::set<std::string> applyFile(const std::filesystem::path& path, CLI::App& command,
                                bool isDefaults = false) {
  const Json json = parseFile(path);
  std::set<const CLI::Option*> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() > 0) given.insert(option);
  }
  const auto isGiven = [&](const char* name) {
    return given.contains(command.get_option_no_throw(std::string("--") + name));
  };
  const bool isLit = isDefaults && std::ranges::any_of(kLighting, isGiven);
  std::set<std::string> taken;
  for (const auto& [name, value] : json.items()) {
    if (name == "$schema") continue;  // where editors find what the file may hold
    const std::string place = placeOf(path, name);
    CLI::Option* option = name.empty() || name[0] == '-' ? nullptr : command.get_option_no_throw("--" + name);
    if (option == nullptr || name == "config" || name == "help" || name == "version")
      throw InputError(place + ": is no option of " + command.get_name() + memberMeant(name, command));
    // Switches of the command line count more one by one, not as a list.
    const bool isSwitch = !isDefaults && (name == "enable" || name == "disable");
    bool overruled = (given.contains(option) && !isSwitch) ||
                     (isLit && std::ranges::find(kLighting, name) != kLighting.end());
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

namespace {

int runFiles(RawRender& raw, const std::filesystem::path& config, const std::filesystem::path& defaults,
             CLI::App& command, const std::function<int(const RenderOptions&)>& run) {
  const auto noteGiven = [&] {
    for (const CLI::Option* option : command.get_options()) {
      if (option->count() > 0) raw.given.insert(option->get_name());
    }
  };
  if (config.empty() && defaults.empty()) {
    noteGiven();
    return run(finishRender(raw));
  }
  std::vector<std::string> enable = std::exchange(raw.enable, {});
  std::vector<std::string> disable = std::exchange(raw.disable, {});
  std::map<std::string, std::filesystem::path> taken;
  if (!config.empty()) {
    for (const std::string& name : applyFile(config, command)) taken[name] = config;
  }
  if (!defaults.empty()) {
    for (const std::string& name : applyFile(defaults, command, true)) taken.emplace(name, defaults);
  }
  raw.fileEnable = std::exchange(raw.enable, std::move(enable));
  raw.fileDisable = std::exchange(raw.disable, std::move(disable));
  noteGiven();
  try {
    return run(finishRender(raw));
  } catch (const UsageError& error) {
    // Messages about options begin with the option's name: "--region: ..." or "--output -: ...".
    const std::string text = error.what();
    for (const auto& [name, file] : taken) {
      const std::string option = "--" + name;
      if (text.starts_with(option + ": ") || text.starts_with(option + " "))
        throw InputError(placeOf(file, name) + afterName(text, name));
    }
    throw;
  }
}

}  // namespace

int runConfigured(RawRender& raw, const std::filesystem::path& config, CLI::App& command,
                  const std::function<int(const RenderOptions&)>& run) {
  return runFiles(raw, config, {}, command, run);
}

RenderOptions finishConfigured(RawRender& raw, const std::filesystem::path& config, CLI::App& command,
                               const std::filesystem::path& defaults) {
  RenderOptions finished;
  runFiles(raw, config, defaults, command, [&](const RenderOptions& options) {
    finished = options;
    return 0;
  });
  return finished;
}

}  // namespace fragtrace
