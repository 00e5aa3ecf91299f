// SPDX-License-Identifier: MIT
#include "cli/input_options.h"

#include <CLI/CLI.hpp>

namespace fragtrace {

void addInputOptions(CLI::App& app, InputLimits& limits) {
  app.add_option(
         "--memory-limit", limits.memoryBytes,
         "memory that files may ask for, such as 500MB or 2GiB; default: 8 GiB, half of the machine's "
         "or ulimit -v, whichever is least")
      ->transform(CLI::AsSizeValue(true))
      ->check(CLI::PositiveNumber);
  app.add_option("--texture-limit", limits.textureSide, "pixels; wider or higher textures are scaled down")
      ->check(CLI::Range(1, kLargestTextureSide));
  app.add_flag("--allow-external-files", limits.allowExternalFiles,
               "the scene may name files that are not in its folder");
}

}  // namespace fragtrace
