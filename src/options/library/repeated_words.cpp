// SPDX-License-Identifier: MIT
#include "options/library/repeated_words.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "base/text.h"
#include "options/library/option_facts.h"

namespace fragtrace {

namespace {

/// The command that the words name.
const CLI::App& commandNamedIn(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    const auto grouped = command->get_subcommands([](const CLI::App*) { return true; });
    const auto next = std::ranges::find(grouped, word, [](const CLI::App* one) { return one->get_name(); });
    if (next != grouped.end()) command = *next;
  }
  return *command;
}

/// An option with its value, as words.
struct Use {
  const CLI::Option* option;
  size_t begin;
  size_t end;
};

/// The use that begins at a word; no option, if none does.
Use useAt(const CLI::App& command, const std::vector<std::string>& words, size_t i) {
  const std::string& word = words[i];
  const bool isLong = word.starts_with("--");
  const std::string name = isLong ? word.substr(0, word.find('=')) : word.substr(0, 2);
  Use use{word.starts_with('-') ? command.get_option_no_throw(name) : nullptr, i, i + 1};
  if (use.option == nullptr || word.size() > name.size()) return use;
  const char delimiter = use.option->get_delimiter();
  for (int values = 0; values < use.option->get_items_expected_min() && use.end < words.size(); ++use.end) {
    const std::string& value = words[use.end];
    if (value.size() > 1 && value[0] == '-' && !isNegativeNumber(value)) break;
    values += 1 + (delimiter == '\0' ? 0 : int(std::ranges::count(value, delimiter)));
  }
  return use;
}

}  // namespace

std::vector<std::string> keepLast(const CLI::App& app, std::vector<std::string>& words) {
  const CLI::App& command = commandNamedIn(app, words);
  std::vector<Use> uses;
  for (size_t i = 0; i < words.size(); i = uses.back().end) uses.push_back(useAt(command, words, i));
  std::vector<std::string> kept;
  std::vector<std::string> notes;
  for (auto use = uses.begin(); use != uses.end(); ++use) {
    const bool isLast = use->option == nullptr || isRepeatable(*use->option) ||
                        std::find_if(use + 1, uses.end(), [&](const Use& later) {
                          return later.option == use->option;
                        }) == uses.end();
    const auto first = words.begin() + std::ptrdiff_t(use->begin);
    const auto end = words.begin() + std::ptrdiff_t(use->end);
    if (isLast)
      kept.insert(kept.end(), first, end);
    else
      notes.push_back(CLI::detail::join(std::vector(first, end), " ") + " is left out: " +
                      use->option->get_name() + " is given again, and the last one counts");
  }
  words = std::move(kept);
  return notes;
}

}  // namespace fragtrace
