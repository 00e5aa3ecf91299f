// SPDX-License-Identifier: MIT
#include "options/device_options.h"

#include <CLI/CLI.hpp>

#include "options/parse_render.h"

namespace fragtrace {

void addDeviceOptions(CLI::App& app, RawRender& raw) {
  CLI::App render;
  RawRender unused;
  addRenderOptions(render, unused);
  const auto described = [&](const char* name) { return render.get_option(name)->get_description(); };
  app.add_option("--rendering-backend", raw.backend, described("--rendering-backend"))->capture_default_str();
  app.add_option("--buffer-reads", raw.reads, described("--buffer-reads"))->capture_default_str();
  app.add_option("--shader-folder", raw.shaderFolder, described("--shader-folder"))->type_name("FOLDER");
  app.add_flag("--quiet", raw.options.quiet, described("--quiet"));
}

}  // namespace fragtrace
