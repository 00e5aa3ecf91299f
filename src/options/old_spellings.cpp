// SPDX-License-Identifier: MIT
#include "options/old_spellings.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "process/report.h"

namespace fragtrace {

namespace {

class WithoutOldSpellings : public CLI::Formatter {
 public:
  std::string make_group(std::string group, bool isPositional,
                         std::vector<const CLI::Option*> options) const override {
    return group == kOldSpellings ? "" : CLI::Formatter::make_group(group, isPositional, options);
  }
};

}  // namespace

std::vector<std::string> oldSpellingsOf(const CLI::App& command) {
  std::vector<std::string> lines;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const bool isVisits = option->get_name() == "--debug-view" && option->results().back() == "visits";
    if (!isVisits && option->get_group() != kOldSpellings) continue;
    lines.push_back(option->get_name() + (isVisits
                                              ? " visits is an old spelling (--enable bvh-heatmap)"
                                              : " is an old spelling (" + option->get_description() + ")"));
  }
  return lines;
}

void sayOldSpellings(const CLI::App& command, const std::vector<std::string>& said) {
  const CLI::Option* quiet = command.get_option_no_throw("--quiet");
  if (quiet != nullptr && quiet->count() > 0) return;
  for (const std::string& line : oldSpellingsOf(command)) {
    if (std::ranges::find(said, line) == said.end()) reportMessage("note: " + line);
  }
}

void hideOldSpellings(CLI::App& app) { app.formatter(std::make_shared<WithoutOldSpellings>()); }

}  // namespace fragtrace
