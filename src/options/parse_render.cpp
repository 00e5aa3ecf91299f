// SPDX-License-Identifier: MIT
#include "options/parse_render.h"

#include <CLI/CLI.hpp>

#include "base/errors.h"
#include "options/library/option_facts.h"
#include "options/option_row.h"

namespace fragtrace {

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
       {"--rendering-backend", "--buffer-reads", "--vector-width", "--shader-folder", "--quiet"})
    addOption(app, name, raw);
}

}  // namespace fragtrace
