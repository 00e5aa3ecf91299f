// SPDX-License-Identifier: MIT
#include "options/input_options.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "options/numbers.h"

namespace fragtrace {

void addInputOptions(CLI::App& app, InputLimits& limits) {
  app.add_option("--memory-limit", limits.memoryBytes,
                 "memory limit, counted separately for files and for the picture, such as 500MB or 2GiB, at "
                 "least 1MB; by default the smallest of 8 GiB, half of the machine's memory and ulimit -v")
      ->transform(memorySize(kLeastMemoryBytes))
      ->type_name("SIZE");
  app.add_option("--texture-limit", limits.textureSide,
                 "maximum width and height of textures in pixels; larger ones are scaled down")
      ->check(wholeNumber(1, kLargestTextureSide));
  app.add_option_function<std::string>(
         "--missing-textures",
         [&limits](const std::string& choice) { limits.drawMissingTextures = choice == "warn"; },
         "what to do if the image of a texture cannot be read: error (default) ends the program; warn prints "
         "a warning, replaces a missing base colour with magenta, and omits the effects of other missing "
         "textures")
      ->check(CLI::IsMember({"error", "warn"}));
  app.add_flag("--allow-external-files", limits.allowExternalFiles,
               "let the scene refer to files outside its folder");
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
                 "name or index of the scene; by default the one that the file chooses");
  app.add_option(
         "--animation-time", selection.animationTime,
         "pose the scene at this time of its animation, in seconds; by default the scene is not animated")
      ->check(isTime);
  app.add_option("--animation", selection.animation,
                 "name or index of the animation for --animation-time; by default the first");
  app.add_option("--material-variant", selection.materialVariant,
                 "name or index of the material variant; `fragtrace info` lists the variants");
  app.add_option(
         "--hide", selection.hiddenNodes,
         "name or index of a node to hide, together with everything below it; can be given several times; "
         "`fragtrace info --nodes` lists the nodes")
      ->type_name("NODE")
      ->allow_extra_args(false);
}

}  // namespace fragtrace
