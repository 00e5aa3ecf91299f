// SPDX-License-Identifier: MIT
#include "cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/suggestion.h"
#include "errors.h"
#include "options/choose.h"
#include "options/option_text.h"
#include "version_text.h"

namespace fragtrace {

namespace {

std::vector<std::string> argumentsOf(std::span<const char* const> words) {
  const auto first = words.begin() + std::ptrdiff_t(std::min(words.size(), size_t(1)));
  std::vector<std::string> arguments = withNumbersSettled({first, words.end()});
  std::ranges::reverse(arguments);  // last first, as the library wants them
  return arguments;
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
  throw UsageError("'" + *word + "' is no command of " + app.get_name() +
                   (atFirst ? ", and no file: " : ": ") + joined(names));
}

/// The command that was given.
const CLI::App& chosenCommand(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return *command;
}

/// What the library calls arguments that were not expected.
std::string whatIsUnknown(const CLI::App& app) {
  const CLI::App& command = chosenCommand(app);
  const std::vector<std::string> left = app.remaining(true);
  const auto option =
      std::ranges::find_if(left, [](const std::string& word) { return word.starts_with('-'); });
  if (option == left.end()) return "'" + left.front() + "' is an argument too many; --help says more";
  std::vector<std::string> known;
  for (const CLI::Option* one : command.get_options()) known.push_back(one->get_name());
  const std::string unknown = option->substr(0, option->find('='));
  const std::string meant = suggestedOption(unknown, known);
  return unknown + " is no option of " + command.get_name() +
         (meant.empty() ? "; --help lists them" : "; did you mean " + meant + "?");
}

}  // namespace

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

std::vector<const char*> withView(std::span<const CommandRow> rows, int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (argc < 2 || argv[1][0] == '-') return words;
  const auto named = [&](const CommandRow& row) { return row.name == std::string_view(argv[1]); };
  std::error_code error;
  const bool isFile = std::filesystem::is_regular_file(argv[1], error);
  if (isFile && std::ranges::none_of(rows, named)) words.insert(words.begin() + 1, "view");
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

int runCommandLine(std::span<const CommandRow> rows, std::span<const char* const> words) {
  CLI::App app("A path tracer for glTF whose tracing runs in an OpenGL shader.", "fragtrace");
  app.set_version_flag("--version", std::string("fragtrace ") + kVersionText);
  const RunCommand run = addCommands(app, rows);
  const auto word = [&](size_t i) {
    return i < words.size() ? std::optional<std::string>(words[i]) : std::nullopt;
  };
  checkCommand(app, word(1));
  const CLI::App* command = word(1)->starts_with('-') ? nullptr : app.get_subcommand(*word(1));
  if (command != nullptr && !commandNames(*command).empty()) checkCommand(*command, word(2));
  try {
    app.parse(argumentsOf(words));
  } catch (const CLI::Success& success) {
    return app.exit(success, std::cout, std::cerr);
  } catch (const CLI::ExtrasError&) {
    throw UsageError(whatIsUnknown(app));
  } catch (const CLI::ParseError& error) {
    throw UsageError(plainText(error) + "; --help says more");
  }
  return run();
}

}  // namespace fragtrace
