// SPDX-License-Identifier: MIT
#include "options/parse_words.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <system_error>
#include <utility>

#include "base/errors.h"
#include "base/report.h"
#include "image/image.h"
#include "options/library/repeated_words.h"

namespace fragtrace {

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

}  // namespace

std::string optionMeant(const std::string& unknown, const CLI::App& command) {
  std::vector<std::string> known;
  for (const CLI::Option* one : command.get_options()) known.push_back(one->get_name());
  return suggestedOption(unknown, known);
}

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

}  // namespace fragtrace
