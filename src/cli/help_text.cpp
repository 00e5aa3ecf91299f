// SPDX-License-Identifier: MIT
#include "cli/help_text.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "base/text.h"
#include "options/help_rows.h"
#include "options/library/option_facts.h"

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

}  // namespace

std::string fullName(const CLI::App& app) {
  return (app.get_parent() == nullptr ? "" : fullName(*app.get_parent()) + " ") + app.get_name();
}

std::vector<std::string> formsOf(const CLI::Option& option) {
  std::vector<std::string> forms;
  for (const std::string& name : option.get_snames()) forms.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) forms.push_back("--" + name);
  return forms;
}

std::string rangeText(const CLI::Option& option) {
  const OptionFacts facts = factsOf(option);
  if (kindOf(option) != ValueKind::Number || !facts.least) return "";
  return facts.most ? shortText(*facts.least) + " to " + shortText(*facts.most)
                    : "from " + shortText(*facts.least) + " on";
}

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

}  // namespace fragtrace
