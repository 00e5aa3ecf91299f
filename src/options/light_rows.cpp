// SPDX-License-Identifier: MIT
#include <cmath>

#include "base/errors.h"
#include "options/option_row.h"
#include "options/row_makers.h"
#include "scene/sky/blurred_map.h"

namespace fragtrace {

namespace {

constexpr double kMostIntensity = 1e6;

void chooseCatcher(RenderOptions& o, const std::string& text) {
  o.light.shadowCatcher = true;
  if (text == "bottom") return;
  const std::optional<double> height = numberIn(text);
  if (!height || !std::isfinite(*height))
    throw UsageError("--shadow-catcher: '" + text + "' is neither a height nor 'bottom'");
  o.light.catcherHeight = height;
}

OptionRow catcherRow() {
  OptionRow row = memberRow(
      "--shadow-catcher",
      "draw the scene's shadow on a horizontal plane that is otherwise invisible: the plane's height (Y) in "
      "metres, or 'bottom' for the bottom of the scene; not with --fog-density",
      FRAGTRACE_MEMBER(light.shadowCatcher),
      {.effect = Effect::Picture, .renewal = Renewal::Scene, .attribute = "shadow_catcher"});
  row.choices = {"bottom"};
  row.open = true;
  row.examples = {"bottom", "-0.10000000149011612"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, chooseCatcher, "HEIGHT");
  };
  row.words = [](const RenderOptions& o) {
    const std::optional<double>& height = o.light.catcherHeight;
    return std::vector<std::string>{height ? exactText(*height) : "bottom"};
  };
  row.value = [](const RenderOptions& o) { return AttributeValue(o.light.shadowCatcher); };
  return row;
}

/// Has no default light, however --default-light stands.
OptionRow noDefaultLightRow() {
  OptionRow row{.name = "--no-default-light", .help = "short for --default-light none"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_flag(r.name, raw.noDefaultLight, r.help)->excludes("--default-light");
  };
  row.isDefault = [](const RenderOptions&) { return true; };
  row.words = [](const RenderOptions&) { return std::vector<std::string>(); };
  row.copy = [](RenderOptions&, const RenderOptions&) {};
  return row;
}

/// The plane is moved without loading the scene again.
OptionRow catcherHeightRow() {
  return memberRow("--shadow-catcher HEIGHT", "", FRAGTRACE_MEMBER(light.catcherHeight),
                   {.effect = Effect::Picture, .copied = false, .group = OptionGroup::None});
}

glm::vec3 colorOf(const std::vector<double>& values) {
  for (const double value : values) {
    if (value < 0.0) throw UsageError("--background-color: below 0");
    if (value > kMostIntensity) throw UsageError("--background-color: above " + numberText(kMostIntensity));
  }
  return {values[0], values[1], values[2]};
}

}  // namespace

std::vector<OptionRow> lightRows() {
  constexpr OptionTraits kScene{.effect = Effect::Picture, .renewal = Renewal::Scene};
  constexpr OptionTraits kEstimator{.effect = Effect::Noise, .renewal = Renewal::Program};
  return {
      choice("--light-selection",
             "how global illumination chooses a light to sample: by what it may send to the point (tree), by "
             "its power, or all alike",
             FRAGTRACE_MEMBER(light.selection), kLightSelectionNames, kEstimator),
      choice(
          "--light-reuse",
          "how a point of global illumination gets its light sample: it draws one (none); it draws four, and "
          "keeps one by the light that each may bring (candidates); the same, and points that the camera "
          "sees choose among those of pixels nearby, too (spatial)",
          FRAGTRACE_MEMBER(light.reuse), kLightReuseNames, kEstimator),
      choice("--caustics",
             "trace paths from lamps and suns (--sky, --hdri-file) to smooth and glossy glass and metal, for "
             "light that these throw on rough surfaces; auto does where there are both",
             FRAGTRACE_MEMBER(light.caustics), kCausticsNames,
             {.effect = Effect::Picture, .renewal = Renewal::Program}),
      word("--hdri-file",
           "equirectangular environment map: .hdr, .exr, .pfm, or, without bright lights, .png, .jpg",
           FRAGTRACE_MEMBER(light.hdriFile),
           {.effect = Effect::Picture, .renewal = Renewal::Scene, .attribute = "hdri"}, "FILE"),
      number<double>("--hdri-rotation", "rotation of the environment map about +Y, in degrees",
                     FRAGTRACE_MEMBER(light.hdriRotationDegrees), {-1e6, 1e6},
                     {.effect = Effect::Picture, .attribute = "hdri_rotation"}),
      number<double>(
          "--hdri-intensity",
          "multiply the light of the environment by this factor: of a map, of the studio, or of what lights "
          "a scene by default",
          FRAGTRACE_MEMBER(light.hdriIntensity), {0.0, kMostIntensity},
          {.effect = Effect::Picture, .attribute = "hdri_intensity"}),
      limit<double>(
          "--background-blur",
          "blur the environment map where the camera sees it directly: standard deviation in degrees; the "
          "light stays the same",
          FRAGTRACE_MEMBER(light.backgroundBlur), {kLeastBlur, 90.0},
          {.effect = Effect::Picture, .renewal = Renewal::Scene, .attribute = "background_blur"}),
      flag("--studio",
           "light the scene with a built-in environment: a key, a fill and a rim light, as soft boxes that "
           "the camera does not see, in front of a grey backdrop",
           FRAGTRACE_MEMBER(light.studio),
           {.effect = Effect::Picture, .renewal = Renewal::Scene, .attribute = "studio"}),
      catcherRow(),
      catcherHeightRow(),
      limit<double>(
          "--shadow-fade",
          "let the shadow on --shadow-catcher fade out before the edge of the picture, over this part "
          "of its smaller side; by default 0.08 with --fit, and 0 without",
          FRAGTRACE_MEMBER(light.shadowFade), {0.0, 0.5}, {.effect = Effect::Picture}),
      offFlag("--no-background", "hide the environment map from the camera, and write alpha",
              FRAGTRACE_MEMBER(light.background), {.effect = Effect::Picture, .attribute = "background"}),
      numbers<double>(
          "--background-color",
          "linear R,G,B that the camera sees where there is no surface, instead of the "
          "environment map; it lights nothing",
          FRAGTRACE_MEMBER(light.backgroundColor), 3, colorOf,
          [](const glm::vec3& c) { return numbersText(double(c.r), double(c.g), double(c.b)); },
          {"0.10000000149011612,0.2,1"}, {.effect = Effect::Picture}, std::nullopt, kColorForm),
      choice("--default-light",
             "what lights a scene that has no light of its own: {}; white comes from all sides, and studio "
             "is the environment of --studio",
             FRAGTRACE_MEMBER(light.defaultLight), kDefaultLightNames, kScene),
      noDefaultLightRow(),
      choice(
          "--lamp-units",
          "how the file's point, spot and directional lights are read: {}; photometric takes their numbers "
          "as "
          "glTF defines them, radiometric divides them by 683, by which exporters such as Blender's multiply "
          "watts; auto decides by what the first view shows",
          FRAGTRACE_MEMBER(light.lampUnits), kLampUnitsNames, kScene),
  };
}

}  // namespace fragtrace
