// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>

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

/// COLOR[,ROUGHNESS]
GroundOptions groundIn(const std::string& text) {
  const std::string option = "--ground";
  const auto commas = std::ranges::count(text, ',');
  const bool hasRoughness = commas == 1 || commas == 3;
  const size_t end = hasRoughness ? text.rfind(',') : text.size();
  GroundOptions ground;
  ground.color = colorIn(option, text.substr(0, end), 1.0);
  if (!hasRoughness) return ground;
  const std::optional<double> roughness = numberIn(CLI::detail::trim_copy(text.substr(end + 1)));
  if (!roughness || !(*roughness >= 0.0 && *roughness <= 1.0))
    throw UsageError(option + ": '" + text.substr(end + 1) + "' is no roughness from 0 to 1");
  ground.roughness = *roughness;
  return ground;
}

OptionRow groundRow() {
  OptionRow row = memberRow(
      "--ground",
      "put the scene on a level ground of that colour (a name, #rrggbb or linear R,G,B) and roughness, by "
      "default 0.6; it is as high as --shadow-catcher bottom, and reaches to the horizon",
      FRAGTRACE_MEMBER(light.ground), {.effect = Effect::Picture, .renewal = Renewal::Scene});
  row.examples = {"white", "#333,0.2", "0.5,0.25,1,0.125"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, [](RenderOptions& o, const std::string& text) { o.light.ground = groundIn(text); });
  };
  row.words = [](const RenderOptions& o) {
    const GroundOptions& ground = *o.light.ground;
    const glm::vec3& c = ground.color;
    return std::vector{numbersText(double(c.r), double(c.g), double(c.b), ground.roughness)};
  };
  return row;
}

/// Stands for other options, as settleShop() says.
OptionRow shopRow() {
  OptionRow row{.name = "--shop",
                .help =
                    "a picture for a shop's page: short for --studio --background-color white --fill 0.85 "
                    "--shadow-catcher bottom --transparent-glass --alpha display --quality good, as far "
                    "as no option of yours says otherwise"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) { app.add_flag(r.name, raw.shop, r.help); };
  row.isDefault = [](const RenderOptions&) { return true; };
  row.words = [](const RenderOptions&) { return std::vector<std::string>(); };
  row.copy = [](RenderOptions&, const RenderOptions&) {};
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

OptionRow fadeRow() {
  constexpr double kMost = 100.0;  // the narrowest pictures have longer sides
  OptionRow row = memberRow("--shadow-fade",
                            "let the shadow on --shadow-catcher fade out before the edges of the picture, "
                            "over SHARE of its smaller "
                            "side; VERTICAL is that above and below, SHARE then that at the sides; by "
                            "default the margins of --fit, "
                            "at least 0.08, and 0 without --fit",
                            FRAGTRACE_MEMBER(light.shadowFade), {.effect = Effect::Picture});
  row.examples = {"0,100", "0.30000001192092896,0.5"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option_function<std::vector<double>>(
           r.name,
           [&raw](const std::vector<double>& values) {
             raw.options.light.shadowFade = glm::dvec2(values.front(), values.back());
           },
           r.help)
        ->delimiter(',')
        ->expected(1, 2)
        ->check(realNumber(0.0, kMost))
        ->allow_extra_args(false);
  };
  row.words = [](const RenderOptions& o) {
    return std::vector{numbersText(o.light.shadowFade->x, o.light.shadowFade->y)};
  };
  return row;
}

/// Returns the rows of how lights are sampled.
std::vector<OptionRow> lightSampleRows() {
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
  };
}

std::vector<OptionRow> environmentRows() {
  return {
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
      choice("--studio-look",
             "look of the studio, which this turns on: {}; white is a bright room for dark and shiny things, "
             "dark shows edges",
             FRAGTRACE_MEMBER(light.studioLook), kStudioLookNames,
             {.effect = Effect::Picture, .renewal = Renewal::Scene}),
  };
}

/// Returns the rows of what a page has: shadow, ground and background.
std::vector<OptionRow> pageRows() {
  return {
      shopRow(),
      catcherRow(),
      catcherHeightRow(),
      groundRow(),
      fadeRow(),
      offFlag("--no-background", "hide the environment map from the camera, and write alpha",
              FRAGTRACE_MEMBER(light.background), {.effect = Effect::Picture, .attribute = "background"}),
      flag(
          "--transparent-glass",
          "with --no-background or --background-color: let the camera see the page through glass; alpha is 1 "
          "less the mean of what the glass lets pass of red, green and blue",
          FRAGTRACE_MEMBER(light.transparentGlass),
          {.effect = Effect::Picture, .renewal = Renewal::Program, .attribute = "transparent_glass"}),
      color("--background-color",
            "what the camera sees where there is no surface, instead of the environment map; it lights "
            "nothing; a .png or .jpg shows this very colour, whatever --exposure and --tone-map are",
            FRAGTRACE_MEMBER(light.backgroundColor), kMostIntensity, {.effect = Effect::Picture}),
  };
}

/// Returns the rows of the file's own light, and of what replaces it.
std::vector<OptionRow> ownLightRows() {
  constexpr OptionTraits kScene{.effect = Effect::Picture, .renewal = Renewal::Scene};
  return {
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

}  // namespace

std::vector<OptionRow> lightRows() {
  std::vector<OptionRow> rows = lightSampleRows();
  for (auto* const part : {&environmentRows, &pageRows, &ownLightRows})
    std::ranges::move(part(), std::back_inserter(rows));
  return rows;
}

}  // namespace fragtrace
