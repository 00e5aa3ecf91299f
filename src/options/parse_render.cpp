// SPDX-License-Identifier: MIT
#include "options/parse_render.h"

#include <CLI/CLI.hpp>

#include "base/errors.h"
#include "options/option_row.h"

namespace fragtrace {

CLI::Option* addOption(CLI::App& app, const char* name, RawRender& raw) {
  const OptionRow& row = rowOf(name);
  row.add(app, row, raw);
  return app.get_option(name);
}

CLI::Option* addOption(CLI::App& app, const char* name, RawRender& raw, const std::string& help) {
  return addOption(app, name, raw)->description(help);
}

void addOptions(CLI::App& app, OptionGroup group, RawRender& raw) {
  for (const OptionRow& row : optionRows()) {
    if (row.traits.group == group) row.add(app, row, raw);
  }
}

void addDeviceOptions(CLI::App& app, RawRender& raw) {
  for (const char* name :
       {"--rendering-backend", "--buffer-reads", "--vector-width", "--shader-folder", "--quiet"})
    addOption(app, name, raw);
}

}  // namespace fragtrace
