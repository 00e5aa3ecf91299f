// SPDX-License-Identifier: MIT
#include "cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "base/near_name.h"
#include "cli/help_json.h"
#include "cli/help_text.h"
#include "options/choose.h"
#include "options/parse_words.h"
#include "version_text.h"

namespace fragtrace {

namespace {

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

void addVersion(CLI::App& app) {
  app.set_version_flag("--version", std::string("fragtrace ") + kVersionText);
}

RunCommand addCommands(CLI::App& app, std::span<const CommandRow> rows) {
  app.require_subcommand(1);
  std::vector<std::pair<const CLI::App*, RunCommand>> commands;
  for (const CommandRow& row : rows) {
    CLI::App& command = *app.add_subcommand(row.name, row.sentence);
    commands.emplace_back(&command, row.add(command));
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

int runCommandLine(std::span<const CommandRow> rows, std::span<const char* const> given) {
  CLI::App app(
      "A path tracer for glTF whose tracing runs in an OpenGL shader.\n`fragtrace FILE` is short for "
      "`fragtrace view FILE`.",
      "fragtrace");
  addVersion(app);
  const auto help = std::make_shared<HelpText>();
  app.formatter(help);
  app.set_help_flag("-h,--help", "print the options of every day and exit; --help all prints all");
  const RunCommand run = addCommands(app, rows);
  std::vector<const char*> words(given.begin(), given.end());
  const HelpForm form = takeHelpForm(words);
  help->all = form == HelpForm::All;
  if (form == HelpForm::Json) {
    std::cout << helpJson(commandIn(app, words), kVersionText);
    return 0;
  }
  const auto word = [&](size_t i) {
    return i < words.size() ? std::optional<std::string>(words[i]) : std::nullopt;
  };
  checkCommand(app, word(1));
  const CLI::App* command = word(1)->starts_with('-') ? nullptr : app.get_subcommand(*word(1));
  if (command != nullptr && !commandNames(*command).empty()) checkCommand(*command, word(2));
  try {
    const auto first = words.begin() + std::ptrdiff_t(std::min(words.size(), size_t(1)));
    parseWords(app, {first, words.end()}, "; --help says more");
  } catch (const CLI::Success& success) {
    return app.exit(success, std::cout, std::cerr);
  }
  return run();
}

}  // namespace fragtrace
