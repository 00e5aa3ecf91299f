// SPDX-License-Identifier: MIT
#include "cli/command_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "options/help_rows.h"
#include "options/library/option_facts.h"
#include "options/option_text.h"
#include "options/parse_render.h"
#include "session/statistics.h"
#include "version_text.h"

namespace fragtrace {

namespace {

constexpr size_t kColumn = 26;           // where descriptions begin
constexpr size_t kUsualWidth = 80;       // without a terminal
constexpr size_t kNarrowest = 50;        // narrower terminals break lines by themselves
constexpr const char* kOwn = "Options";  // the library's name for options without a topic

size_t terminalWidth() {
  winsize size{};
  const bool known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return std::max(known ? size_t(size.ws_col) : kUsualWidth, kNarrowest);
}

/// Appends the words of a text, in lines of that width of which all but the first are indented.
void appendWrapped(std::string& to, const std::string& text, size_t indent, size_t width) {
  std::istringstream words(text);
  size_t column = indent;
  for (std::string word; words >> word; column += word.size()) {
    if (column > indent && column + 1 + word.size() > width) {
      to += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      to += ' ';
      ++column;
    }
    to += word;
  }
  to += '\n';
}

void appendEntry(std::string& to, const std::string& term, const std::string& text, size_t width) {
  to += "  " + term;
  const size_t end = 2 + term.size();
  if (text.empty())
    to += '\n';
  else if (end + 2 > kColumn)
    to += "\n" + std::string(kColumn, ' ');
  else
    to += std::string(kColumn - end, ' ');
  if (!text.empty()) appendWrapped(to, text, kColumn, width);
}

std::string describe(const CLI::Option& option) {
  std::vector<std::string> notes;
  if (!option.get_default_str().empty()) notes.push_back("default " + option.get_default_str());
  if (const std::string range = rangeText(option); !range.empty()) notes.push_back(range);
  for (const CLI::Option* other : option.get_excludes()) notes.push_back("not with " + other->get_name());
  return option.get_description() + (notes.empty() ? "" : " (" + joined(notes, "; ") + ")");
}

std::vector<const CLI::Option*> optionsOf(const CLI::App& app, const std::string& topic) {
  std::vector<const CLI::Option*> chosen;
  std::ranges::copy_if(app.get_options(), std::back_inserter(chosen), [&](const CLI::Option* option) {
    return option->nonpositional() && option->get_group() == topic;
  });
  return chosen;
}

void appendPositionals(std::string& text, const CLI::App& app, size_t width) {
  const char* heading = "\nArguments:\n";
  for (const CLI::Option* option : app.get_options()) {
    if (option->nonpositional()) continue;
    text += std::exchange(heading, "");
    appendEntry(text, option->get_name(), option->get_description(), width);
  }
}

/// "fragtrace bench frame"
std::string fullName(const CLI::App& app) {
  return (app.get_parent() == nullptr ? "" : fullName(*app.get_parent()) + " ") + app.get_name();
}

/// The forms of an option, short ones first: "-o", "--output".
std::vector<std::string> formsOf(const CLI::Option& option) {
  std::vector<std::string> forms;
  for (const std::string& name : option.get_snames()) forms.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) forms.push_back("--" + name);
  return forms;
}

/// "fragtrace diff [options] picture reference"
std::string usageOf(const CLI::App& app) {
  std::string text = fullName(app);
  if (!app.get_subcommands([](const CLI::App*) { return true; }).empty()) return text + " COMMAND";
  text += " [options]";
  for (const CLI::Option* option : app.get_options()) {
    if (option->nonpositional()) {
      if (option->get_required()) text += " " + formsOf(*option).front() + " " + metavariableOf(*option);
      continue;
    }
    const std::string name = option->get_name() + (isRepeatable(*option) ? "..." : "");
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  return text;
}

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

/// The commands of this app, with those that they group, and all options of them.
std::string helpJson(const CLI::App& app, const char* version) {
  Json json = {{"schema", 1}, {"version", version}, {"commands", Json::array()}, {"options", Json::array()}};
  addCommand(app, json["commands"], json["options"]);
  return jsonText(json);
}

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// The library would call an unknown command an argument too many, and a missing one a subcommand.
void checkCommand(const CLI::App& app, std::optional<std::string> word) {
  const std::vector<std::string> names = commandNames(app);
  if (!word) throw UsageError(app.get_name() + " needs a command: " + joined(names) + "; --help says more");
  if (word->starts_with('-') || std::ranges::find(names, *word) != names.end()) return;
  const bool atFirst = app.get_parent() == nullptr;
  std::error_code error;
  if (atFirst && std::filesystem::is_directory(*word, error))
    throw UsageError("'" + *word +
                     "' is a folder; name the .gltf or .glb in it, or draw all: fragtrace sheet " + *word +
                     " -o sheet.png");
  throw UsageError("'" + *word + "' is no command of " + app.get_name() +
                   (atFirst ? ", and no file: " : ": ") + joined(names) + didYouMean(*word, names));
}

/// Returns what --help prints.
enum class HelpForm : uint8_t { Everyday, All, Json };

/// The form that the word after --help asks for.
HelpForm helpFormOf(std::string_view word) {
  if (word == "--json") return HelpForm::Json;
  return word == "all" ? HelpForm::All : HelpForm::Everyday;
}

/// Takes the word after --help that says its form out of the words.
HelpForm takeHelpForm(std::vector<const char*>& words) {
  for (size_t i = 1; i + 1 < words.size(); ++i) {
    const std::string_view word = words[i];
    const HelpForm form = helpFormOf(words[i + 1]);
    if ((word != "--help" && word != "-h") || form == HelpForm::Everyday) continue;
    words.erase(words.begin() + std::ptrdiff_t(i) + 1);
    return form;
  }
  return HelpForm::Everyday;
}

/// The command that the words name.
const CLI::App& commandIn(const CLI::App& app, const std::vector<const char*>& words) {
  const CLI::App* command = &app;
  for (size_t i = 1; i < words.size() && words[i][0] != '-'; ++i) {
    checkCommand(*command, words[i]);
    command = command->get_subcommand(words[i]);
  }
  return *command;
}

}  // namespace

std::string rangeText(const CLI::Option& option) {
  const OptionFacts facts = factsOf(option);
  if (kindOf(option) != ValueKind::Number || !facts.least) return "";
  return facts.most ? shortText(*facts.least) + " to " + shortText(*facts.most)
                    : "from " + shortText(*facts.least) + " on";
}

std::string HelpText::make_help(const CLI::App* app, std::string /*name*/,
                                CLI::AppFormatMode /*mode*/) const {
  const size_t width = terminalWidth();
  std::string text = app->get_description() + "\n\nUsage: ";
  appendWrapped(text, usageOf(*app), 2, width);
  appendPositionals(text, *app, width);
  size_t hidden = 0;
  std::vector<std::string> topics{kOwn};
  topics.insert(topics.end(), kHelpTopics.begin(), kHelpTopics.end());
  for (const std::string& topic : topics) {
    std::string entries;
    for (const CLI::Option* option : optionsOf(*app, topic)) {
      if (!all && !factsOf(*option).everyday) {
        ++hidden;
        continue;
      }
      const std::string value = metavariableOf(*option);
      appendEntry(entries, joined(formsOf(*option)) + (value.empty() ? "" : " " + value), describe(*option),
                  width);
    }
    if (!entries.empty()) text.append("\n").append(topic).append(":\n").append(entries);
  }
  const auto commands = app->get_subcommands([](const CLI::App*) { return true; });
  if (!commands.empty()) text += "\nCommands:\n";
  for (const CLI::App* command : commands)
    appendEntry(text, command->get_name(), command->get_description(), width);
  if (hidden > 0)
    text += "\n`" + fullName(*app) + " --help all` shows " + countText(hidden, "more option") + ".\n";
  return text;
}

void addVersion(CLI::App& app) {
  app.set_version_flag("--version", std::string("fragtrace ") + kVersionText);
}

RunCommand addCommands(CLI::App& app, std::span<const CommandRow> rows, std::string_view only) {
  app.require_subcommand(1);
  std::vector<std::pair<const CLI::App*, RunCommand>> commands;
  for (const CommandRow& row : rows) {
    CLI::App& command = *app.add_subcommand(row.name, row.sentence);
    if (only.empty() || only == row.name) commands.emplace_back(&command, row.add(command));
  }
  return [commands] {
    return std::ranges::find_if(commands, [](const auto& c) { return c.first->parsed(); })->second();
  };
}

std::vector<const char*> withCommand(std::span<const CommandRow> rows, int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  const bool isFiles = argc > 1 && argv[1] == std::string_view("--");
  if (argc < 2 || (argv[1][0] == '-' && !isFiles)) return words;
  if (argv[1] == std::string_view("help")) {
    words.erase(words.begin() + 1);
    const bool hasForm = words.size() > 1 && helpFormOf(words.back()) != HelpForm::Everyday;
    words.insert(words.end() - (hasForm ? 1 : 0), "--help");
  }
  const auto named = [&](const CommandRow& row) { return row.name == std::string_view(argv[1]); };
  std::error_code error;
  const bool isFile = std::filesystem::is_regular_file(argv[1], error);
  if (isFiles || (isFile && std::ranges::none_of(rows, named))) words.insert(words.begin() + 1, "view");
  return words;
}

bool asksForJson(std::span<const char* const> words) {
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--progress=json") return true;
    if (word == "--progress" && i + 1 < words.size() && std::string_view(words[i + 1]) == "json") return true;
  }
  return false;
}

namespace {

/// Parses the words, the program's name first, into `app`. Returns what then runs; after help or version were
/// printed, that returns 0. With `own`, the app has the options of the named command alone. Throws
/// UsageError.
RunCommand parseCommand(CLI::App& app, std::span<const CommandRow> rows, std::vector<const char*> words,
                        bool own) {
  addVersion(app);
  const auto help = std::make_shared<HelpText>();
  app.formatter(help);
  app.set_help_flag("-h,--help", "print the options of every day and exit; --help all prints all");
  const HelpForm form = takeHelpForm(words);
  const auto word = [&](size_t i) {
    return i < words.size() ? std::optional<std::string>(words[i]) : std::nullopt;
  };
  RunCommand run = addCommands(app, rows, own && form != HelpForm::Json ? word(1).value_or("") : "");
  help->all = form == HelpForm::All;
  if (form == HelpForm::Json) {
    std::cout << helpJson(commandIn(app, words), kVersionText);
    return [] { return 0; };
  }
  checkCommand(app, word(1));
  const CLI::App* command = word(1)->starts_with('-') ? nullptr : app.get_subcommand(*word(1));
  if (command != nullptr && !commandNames(*command).empty()) checkCommand(*command, word(2));
  try {
    const auto first = words.begin() + std::ptrdiff_t(std::min(words.size(), size_t(1)));
    parseWords(app, {first, words.end()}, "; --help says more");
  } catch (const CLI::Success& success) {
    const int status = app.exit(success, std::cout, std::cerr);
    return [status] { return status; };
  }
  return run;
}

}  // namespace

int runCommandLine(std::span<const CommandRow> rows, std::span<const char* const> given) {
  constexpr const char* kSentence =
      "A path tracer for glTF whose tracing runs in an OpenGL shader.\n`fragtrace FILE` is short for "
      "`fragtrace view FILE`.";
  const std::vector<const char*> words(given.begin(), given.end());
  auto app = std::make_unique<CLI::App>(kSentence, "fragtrace");
  RunCommand run;
  try {
    run = parseCommand(*app, rows, words, true);
  } catch (const UsageError&) {  // whose message names what other commands have
    app = std::make_unique<CLI::App>(kSentence, "fragtrace");
    run = parseCommand(*app, rows, words, false);
  }
  return run();
}

}  // namespace fragtrace
