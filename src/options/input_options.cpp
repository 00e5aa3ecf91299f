// SPDX-License-Identifier: MIT
#include "options/input_options.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "options/numbers.h"

namespace fragtrace {

void addInputOptions(CLI::App& app, InputLimits& limits) {
  app.add_option(
         "--memory-limit", limits.memoryBytes,
         "memory that files and the picture may each ask for, such as 500MB or 2GiB, at least 1MB; default: "
         "8 GiB, half of the machine's or ulimit -v, whichever is least")
      ->transform(memorySize(kLeastMemoryBytes));
  app.add_option("--texture-limit", limits.textureSide, "pixels; wider or higher textures are scaled down")
      ->check(wholeNumber(1, kLargestTextureSide));
  app.add_flag("--allow-external-files", limits.allowExternalFiles,
               "the scene may name files that are not in its folder");
}

void addSelectionOptions(CLI::App& app, SceneSelection& selection) {
  // The library's ranges let NaN pass.
  const CLI::Validator isTime(
      [](const std::string& text) -> std::string {
        double seconds = 0.0;
        const bool isNumber = CLI::detail::lexical_cast(text, seconds);
        return isNumber && std::isfinite(seconds) && seconds >= 0.0 ? "" : "is no finite number from 0 on";
      },
      "SECONDS");
  app.add_option("--scene", selection.scene,
                 "name or index of the file's scene; default: the file's own choice");
  app.add_option("--animation-time", selection.animationTime,
                 "seconds: the scene as it stands then in its animation; default: as the file stands")
      ->check(isTime);
  app.add_option("--animation", selection.animation,
                 "name or index of the animation of --animation-time; default: the first");
  app.add_option("--material-variant", selection.materialVariant,
                 "name or index of the materials that are shown, of those that `info` lists");
}

}  // namespace fragtrace
