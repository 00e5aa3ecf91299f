// SPDX-License-Identifier: MIT
#include "options/surroundings_options.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "errors.h"
#include "options/choose.h"
#include "scene/blurred_map.h"

namespace fragtrace {

namespace {

constexpr double kMostIntensity = 1e6;

void chooseCatcher(const std::string& text, RenderOptions& o) {
  if (text.empty()) return;
  o.light.shadowCatcher = true;
  if (text == "bottom") return;
  double height = 0.0;
  if (!CLI::detail::lexical_cast(text, height) || !std::isfinite(height))
    throw UsageError("--shadow-catcher: '" + text + "' is neither a height nor 'bottom'");
  o.light.catcherHeight = height;
}

}  // namespace

void addSurroundingsOptions(CLI::App& app, RawRender& raw) {
  RenderOptions& o = raw.options;
  app.add_option("--hdri-file", raw.hdriFile, "equirectangular environment map: .hdr, .exr, .pfm")
      ->type_name("FILE");
  app.add_flag(
      "--studio", o.light.studio,
      "light the scene with a built-in environment: a key, a fill and a rim light, as soft boxes that the "
      "camera does not see, in front of a grey backdrop");
  app.add_option("--hdri-rotation", o.light.hdriRotationDegrees,
                 "rotation of the environment map about +Y, in degrees")
      ->capture_default_str();
  app.add_option("--hdri-intensity", o.light.hdriIntensity,
                 "multiply the light of the environment by this factor: of a map, of the studio, or of what "
                 "lights a scene by default")
      ->check(CLI::Range(0.0, kMostIntensity))
      ->capture_default_str();
  app.add_option(
         "--background-blur", o.light.backgroundBlur,
         "blur the environment map where the camera sees it directly: standard deviation in degrees; the "
         "light stays the same")
      ->check(CLI::Range(kLeastBlur, 90.0));
  app.add_option("--shadow-catcher", raw.shadowCatcher,
                 "draw the scene's shadow on a horizontal plane that is otherwise invisible: the plane's "
                 "height (Y) in "
                 "metres, or 'bottom' for the bottom of the scene")
      ->type_name("HEIGHT");
  app.add_flag("--no-background", raw.noBackground,
               "hide the environment map from the camera, and write alpha");
  app.add_option("--background-color", raw.backgroundColor,
                 "linear R,G,B that the camera sees where there is no surface, instead of the environment "
                 "map; it lights nothing")
      ->delimiter(',')
      ->expected(3);
  app.add_option("--default-light", raw.defaultLight,
                 "what lights a scene that has no light of its own: " + joined(kDefaultLightNames) +
                     "; white comes from all sides, and studio is the environment of --studio")
      ->capture_default_str();
  app.add_flag("--no-default-light", raw.noDefaultLight, "short for --default-light none");
}

void finishSurroundings(const RawRender& raw, RenderOptions& o) {
  if (!raw.backgroundColor.empty())
    o.light.backgroundColor =
        glm::vec3(raw.backgroundColor[0], raw.backgroundColor[1], raw.backgroundColor[2]);
  o.light.hdriFile = raw.hdriFile;
  if (o.light.studio && !o.light.hdriFile.empty()) throw UsageError("--studio: there is an --hdri-file, too");
  if (o.light.studio && o.light.backgroundBlur > 0.0)
    throw UsageError("--background-blur: the backdrop of --studio has nothing to blur");
  chooseCatcher(raw.shadowCatcher, o);
  o.light.background = !raw.noBackground;
  o.light.defaultLight = raw.noDefaultLight
                             ? DefaultLight::None
                             : choose<DefaultLight>("--default-light", raw.defaultLight, kDefaultLightNames);
}

}  // namespace fragtrace
