// SPDX-License-Identifier: MIT

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/errors.h"
#include "options/option_row.h"
#include "options/row_makers.h"
#include "scene/sky/map_filter.h"
#include "scene/volume/grid.h"

namespace fragtrace {

namespace {

/// X,Y,Z of a place, or of a direction, which is not zero.
template <typename Member>
OptionRow vectorRow(const char* name, std::string help, Member member, bool isPlace, OptionTraits traits) {
  const auto take = [name, isPlace](const std::vector<double>& values) {
    const glm::dvec3 v(values[0], values[1], values[2]);
    if (isPlace && glm::length(v) > kFarthest)
      throw UsageError(std::string(name) + ": farther than 1e30 m from the origin");
    if (!isPlace && v == glm::dvec3(0.0)) throw UsageError(std::string(name) + ": is zero");
    return v;
  };
  return numbers<double>(
      name, std::move(help), member, 3, take, [](const glm::dvec3& v) { return numbersText(v.x, v.y, v.z); },
      {"-0.1,1e-07,3", "1,2,-0.33333333333333331"}, traits);
}

Orbit orbitOf(const std::vector<double>& values) {
  const Orbit orbit{values[0], values[1], values.size() > 2 ? values[2] : 1.0};
  if (std::abs(orbit.elevationDegrees) > 90.0)
    throw UsageError("--camera-orbit: the elevation is not between -90 and 90 degrees");
  if (!(orbit.zoom >= 1e-3 && orbit.zoom <= 1e6))
    throw UsageError("--camera-orbit: the zoom is not between 0.001 and 1000000");
  return orbit;
}

/// The view angle as photographers say it.
OptionRow focalLengthRow() {
  OptionRow row{
      .name = "--focal-length",
      .help =
          "MM or MM,SENSOR: focal length of a perspective camera in millimetres, and the height of its "
          "sensor (24): another way to say --camera-view-angle",
      .traits = {.effect = Effect::View},
      .examples = {"50", "35,15.6"}};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option_function<std::vector<double>>(
           r.name,
           [&raw](const std::vector<double>& mm) {
             const double sensor = mm.size() > 1 ? mm[1] : 1000.0 * kSensorHeight;
             raw.options.camera.overrides.viewAngleDegrees = glm::degrees(viewAngleOf(mm[0], sensor));
           },
           r.help)
        ->delimiter(',')
        ->expected(1, 2)
        ->check(realNumber(1e-3, 1e6))
        ->excludes("--camera-view-angle");
  };
  row.isDefault = [](const RenderOptions&) { return true; };
  row.words = [](const RenderOptions&) { return std::vector<std::string>(); };
  row.copy = [](RenderOptions&, const RenderOptions&) {};
  return row;
}

OptionRow orbitRow() {
  OptionRow row = memberRow(
      "--camera-orbit",
      "look at the centre of the scene, or at --camera-focal-point, from AZIMUTH degrees to the right of the "
      "front (+Z) and ELEVATION degrees above it; ZOOM 2 shows everything twice as large (default 1)",
      FRAGTRACE_MEMBER(camera.overrides.orbit), {.effect = Effect::View, .excludes = "--camera-position"});
  row.examples = {"0.1,-90", "30,20,0.3"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option_function<std::vector<double>>(
           r.name,
           [&raw](const std::vector<double>& values) {
             raw.options.camera.overrides.orbit = orbitOf(values);
           },
           r.help)
        ->delimiter(',')
        ->expected(2, 3)
        ->check(realNumber())
        ->allow_extra_args(false)
        ->excludes(r.traits.excludes);
  };
  row.words = [](const RenderOptions& o) {
    const Orbit& orbit = *o.camera.overrides.orbit;
    const std::string angles = numbersText(orbit.azimuthDegrees, orbit.elevationDegrees);
    return std::vector{orbit.zoom == 1.0 ? angles : angles + "," + exactText(orbit.zoom)};
  };
  return row;
}

OptionRow regionRow() {
  const auto take = [](const std::vector<int>& n) {
    const Region region{{n[0], n[1]}, {n[2], n[3]}};
    if (region.size.x < 1 || region.size.y < 1) throw UsageError("--region: holds no pixel");
    return region;
  };
  return numbers<int>(
      "--region",
      "X,Y,WIDTH,HEIGHT in pixels from the top left of the picture: draw and write this part alone, with the "
      "same samples as in the whole",
      FRAGTRACE_MEMBER(camera.region), 4, take,
      [](const Region& r) { return numbersText(r.corner.x, r.corner.y, r.size.x, r.size.y); }, {"0,7,640,1"},
      {.effect = Effect::Picture, .copied = false, .group = OptionGroup::Output}, NumberRange<int>{0, 65536});
}

glm::dvec2 lensShiftOf(const std::vector<double>& values) {
  constexpr double kFarthestShift = 10.0;
  const glm::dvec2 shift(values[0], values[1]);
  if (!(std::max(std::abs(shift.x), std::abs(shift.y)) <= kFarthestShift))
    throw UsageError("--lens-shift: is not between -10 and 10");
  return shift;
}

}  // namespace

std::vector<OptionRow> cameraRows() {  // NOLINT(readability-function-size): a table
  constexpr OptionTraits kView{.effect = Effect::View};
  constexpr OptionTraits kProjection{.effect = Effect::View, .renewal = Renewal::Program};
  constexpr OptionTraits kLens{.effect = Effect::Picture, .renewal = Renewal::Program};
  return {
      numbers<int>(
          "--resolution",
          "WIDTH,HEIGHT or WIDTHxHEIGHT in pixels; by default 1280,720, or 720 high at the aspect ratio of "
          "the camera",
          FRAGTRACE_MEMBER(camera.resolution), 2,
          [](const std::vector<int>& n) { return glm::ivec2(n[0], n[1]); },
          [](const glm::ivec2& size) { return numbersText(size.x, size.y); }, {"640,480", "1,65536"},
          {.effect = Effect::Picture, .kept = true}, NumberRange<int>{1, 65536}, "WIDTHxHEIGHT"),
      regionRow(),
      limit<int>("--camera-index",
                 "index of the scene's camera, from 0; by default the first camera, or, if the file has no "
                 "camera, as by --camera-orbit 35,20 --fit",
                 FRAGTRACE_MEMBER(camera.index), {0, std::numeric_limits<int>::max()}, kView),
      word("--camera", "name or index of the camera; `fragtrace info` lists the cameras",
           FRAGTRACE_MEMBER(selection.camera),
           {.effect = Effect::Picture, .renewal = Renewal::Scene, .excludes = "--camera-index"}),
      vectorRow("--camera-position", "X,Y,Z of the camera in world space, in metres",
                FRAGTRACE_MEMBER(camera.overrides.position), true, kView),
      orbitRow(),
      flag("--fit",
           "move the camera, without turning it, until the scene fills the picture except for a narrow "
           "margin; "
           "with --turntable, all pictures use the same distance, with --frames the same camera",
           FRAGTRACE_MEMBER(camera.overrides.fit), kView),
      flag("--fit-shadow", "the same, until the shadow on --shadow-catcher is in the picture, too",
           FRAGTRACE_MEMBER(camera.overrides.fitShadow), kView),
      word("--fit-to",
           "the same as --fit for a part of the scene: the name of a node, with all below it, or else of a "
           "material",
           FRAGTRACE_MEMBER(camera.overrides.fitTo), kView),
      limit<double>(
          "--fill",
          "the same as --fit, until this share of the picture's width or height is filled; --fit alone "
          "fills 0.95",
          FRAGTRACE_MEMBER(camera.overrides.fill), {0.05, 1.0}, kView),
      vectorRow("--camera-focal-point", "X,Y,Z of the point that the camera looks at",
                FRAGTRACE_MEMBER(camera.overrides.focalPoint), true, kView),
      vectorRow("--camera-view-up", "X,Y,Z of the direction that points up in the picture",
                FRAGTRACE_MEMBER(camera.overrides.viewUp), false, kView),
      choice("--camera-type",
             "projection of the camera, {}; by default that of the scene's camera, or the one that "
             "--camera-view-angle or --camera-parallel-scale goes with",
             FRAGTRACE_MEMBER(camera.overrides.type), kCameraTypeNames, kProjection),
      numberRow<double>("--camera-view-angle",
                        "vertical field of view in degrees, of a perspective camera; of a fisheye, the angle "
                        "of the whole circle",
                        FRAGTRACE_MEMBER(camera.overrides.viewAngleDegrees), std::nullopt, false, kView),
      focalLengthRow(),
      numberRow<double>("--camera-parallel-scale",
                        "half of the picture's height in metres, of an orthographic camera",
                        FRAGTRACE_MEMBER(camera.overrides.parallelScale), std::nullopt, false,
                        {.effect = Effect::View, .excludes = "--camera-view-angle"}),
      numbers<double>(
          "--lens-shift",
          "X,Y in parts of the picture's width and height, -10 to 10: show what lies so much more to the "
          "right and up "
          "without turning the camera, so that verticals stay upright",
          FRAGTRACE_MEMBER(camera.overrides.lensShift), 2, lensShiftOf,
          [](const glm::dvec2& n) { return numbersText(n.x, n.y); }, {"0.25,-0.5", "0,1e-07"}, kProjection),
      limit<double>("--f-stop",
                    "blur what is out of focus, as a lens of this f-number does on a sensor 24 mm high, for "
                    "example 2.8; needs a perspective camera",
                    FRAGTRACE_MEMBER(camera.lens.fStop), {1e-6, 1e6}, kLens),
      limit<double>("--focus-distance",
                    "distance in metres, along the view, at which --f-stop is sharp; by default that of the "
                    "focal point",
                    FRAGTRACE_MEMBER(camera.lens.focusDistance), {1e-9, 1e30}, kLens),
      number<int>("--aperture-blades",
                  "number of straight edges of the aperture of --f-stop, from 3 to 64; 0 is a round one",
                  FRAGTRACE_MEMBER(camera.lens.blades), {0, 64}, kLens),
      vectorRow("--scene-origin",
                "X,Y,Z of a point; positions near this point are the most accurate; by default the focal "
                "point if it is given, otherwise a point near the camera",
                FRAGTRACE_MEMBER(camera.sceneOrigin), true,
                {.effect = Effect::Method, .renewal = Renewal::Scene}),
      choice("--pixel-filter", "pixel filter", FRAGTRACE_MEMBER(camera.pixelFilter), kPixelFilterNames,
             kLens),
      number<double>("--line-width", "width of points and lines in pixels of the picture",
                     FRAGTRACE_MEMBER(camera.lineWidth), {0.01, 1000.0},
                     {.effect = Effect::Picture, .renewal = Renewal::Scene}),
  };
}

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

namespace {

constexpr OptionTraits kOfSky{.effect = Effect::Picture, .renewal = Renewal::Surroundings};

OptionTraits named(const char* attribute) {
  OptionTraits traits = kOfSky;
  traits.attribute = attribute;
  return traits;
}

OptionRow skyTimeRow() {
  OptionRow row =
      word("--sun-time",
           "put the sun of --sky where it stands at this time, seen from --sun-place: ISO 8601 with "
           "its offset, as 2026-06-21T14:30+02:00",
           FRAGTRACE_MEMBER(light.sky.time), named("sun_time"), "TIME");
  row.examples = {"2026-06-21T14:30:00+02:00"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    const auto take = [](RenderOptions& o, const std::string& text) {
      if (daysOf(text + "Z"))
        throw UsageError("--sun-time: '" + text + "' has no offset from universal time, as " + text +
                         "+02:00 or " + text + "Z has");
      if (!daysOf(text))
        throw UsageError(
            "--sun-time: '" + text +
            "' is no time with its offset as ISO 8601 writes it, such as 2026-06-21T14:30+02:00");
      o.light.sky.time = text;
    };
    addWord(app, r, raw, take, "TIME");
  };
  row.words = [](const RenderOptions& o) { return std::vector<std::string>{o.light.sky.time}; };
  row.value = [](const RenderOptions& o) { return AttributeValue(o.light.sky.time); };
  return row;
}

glm::dvec2 latitudeLongitudeOf(const std::vector<double>& values) {
  if (std::abs(values[0]) > 90.0) throw UsageError("--sun-place: the latitude is not within -90 and 90");
  if (std::abs(values[1]) > 180.0) throw UsageError("--sun-place: the longitude is not within -180 and 180");
  return {values[0], values[1]};
}

}  // namespace

std::vector<OptionRow> skyRows() {
  return {
      flag("--sky",
           "light the scene with a clear sky and its sun; north is -Z, and --hdri-rotation turns both",
           FRAGTRACE_MEMBER(light.sky.on),
           {.effect = Effect::Picture, .renewal = Renewal::Scene, .attribute = "sky"}),
      number<double>("--sun-elevation",
                     "height of the sun of --sky above the horizon, in degrees; negative after sunset",
                     FRAGTRACE_MEMBER(light.sky.sun.elevation), {-90.0, 90.0}, named("sun_elevation")),
      number<double>("--sun-azimuth",
                     "direction to the sun of --sky, in degrees clockwise from north: 90 is east (+X)",
                     FRAGTRACE_MEMBER(light.sky.sun.azimuth), {-360.0, 360.0},
                     {.effect = Effect::Picture, .attribute = "sun_azimuth"}),
      skyTimeRow(),
      numbers<double>(
          "--sun-place", "LAT,LON of --sun-time: latitude and longitude in degrees, north and east positive",
          FRAGTRACE_MEMBER(light.sky.place), 2, latitudeLongitudeOf,
          [](const glm::dvec2& p) { return numbersText(p.x, p.y); }, {"52.52,13.405"}, kOfSky),
      number<double>("--sky-turbidity", "haze in the air of --sky: 1 has none, 3 is a clear day, 10 is hazy",
                     FRAGTRACE_MEMBER(light.sky.turbidity), {1.0, 10.0}, named("sky_turbidity")),
      number<double>("--ground-albedo",
                     "part of the light that the ground below the sky of --sky reflects, which is seen below "
                     "the horizon",
                     FRAGTRACE_MEMBER(light.sky.groundAlbedo), {0.0, 1.0}, named("ground_albedo")),
  };
}

namespace {

constexpr double kMostExtinction = 1e6;

/// H[,BASE]
void chooseHeight(RenderOptions& o, const std::string& text) {
  const size_t comma = text.find(',');
  const bool hasBase = comma != std::string::npos;
  const std::optional<double> height = numberIn(text.substr(0, comma));
  const std::optional<double> base = hasBase ? numberIn(text.substr(comma + 1)) : std::optional(0.0);
  if (!height || !base || !std::isfinite(*height) || !std::isfinite(*base) || *height <= 0.0)
    throw UsageError("--fog-height: '" + text + "' is not a height above 0, or a height and a base");
  o.fog.height = height;
  o.fog.base = hasBase ? base : std::nullopt;
}

OptionRow heightRow() {
  OptionRow row = memberRow(
      "--fog-height",
      "make the fog thinner above the height BASE (Y, in metres; by default the bottom of the scene), by a "
      "factor of e every H metres",
      FRAGTRACE_MEMBER(fog.height), {.effect = Effect::Picture});
  row.examples = {"1.5", "0.30000001192092896,-2"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, chooseHeight, "H[,BASE]");
  };
  row.words = [](const RenderOptions& o) {
    const std::string base = o.fog.base ? "," + exactText(*o.fog.base) : "";
    return std::vector<std::string>{exactText(*o.fog.height) + base};
  };
  row.copy = [](RenderOptions& to, const RenderOptions& from) {
    to.fog.height = from.fog.height;
    to.fog.base = from.fog.base;
  };
  return row;
}

}  // namespace

std::vector<OptionRow> fogRows() {
  constexpr OptionTraits kDrawn{.effect = Effect::Picture};
  return {
      number<double>("--fog-density",
                     "fill a ball round the scene with fog, and say how dense it is: the extinction "
                     "coefficient, in 1/m; only stage gi has it",
                     FRAGTRACE_MEMBER(fog.density), {0.0, kMostExtinction},
                     {.effect = Effect::Picture, .renewal = Renewal::Program, .attribute = "fog_density"}),
      color("--fog-color", "the part of the light that the fog scatters (albedo)",
            FRAGTRACE_MEMBER(fog.color), 1.0, kDrawn),
      number<double>("--fog-anisotropy",
                     "mean cosine of the angle by which the fog scatters light: above 0 it continues forward",
                     FRAGTRACE_MEMBER(fog.anisotropy), {-kMostAnisotropy, kMostAnisotropy}, kDrawn),
      heightRow(),
      limit<double>(
          "--fog-distance",
          "radius of the ball in metres, round the middle of the scene; by default 1.5 times that of "
          "the scene's own",
          FRAGTRACE_MEMBER(fog.distance), {1e-9, 1e12}, kDrawn),
  };
}

namespace {

/// FILE[:GRID]
void chooseFile(RenderOptions& o, const std::string& text) {
  const VolumeSource named = volumeFile(text);
  o.volume.file = named.file;
  o.volume.grid = named.grid;
  if (named.file.empty() || (named.grid && named.grid->empty()))
    throw UsageError("--volume: '" + text + "' is not FILE.nvdb or FILE.nvdb:GRID");
}

std::string textOf(const VolumeSource& v) { return v.file.string() + (v.grid ? ":" + *v.grid : ""); }

OptionRow fileRow() {
  OptionRow row = memberRow("--volume",
                            "grid of densities, such as a cloud or smoke, to place in the scene: a NanoVDB "
                            "file, and if it is not the grid "
                            "`density`, its name; only stage gi has it",
                            FRAGTRACE_MEMBER(volume.file),
                            {.effect = Effect::Picture, .renewal = Renewal::Scene, .attribute = "volume"});
  row.examples = {"it's.nvdb:heat", "cloud.nvdb"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, chooseFile, "FILE[:GRID]");
  };
  row.words = [](const RenderOptions& o) { return std::vector{textOf(o.volume)}; };
  row.value = [](const RenderOptions& o) { return AttributeValue(o.volume.file.filename().string()); };
  row.copy = [](RenderOptions& to, const RenderOptions& from) {
    to.volume.file = from.volume.file;
    to.volume.grid = from.volume.grid;
  };
  return row;
}

}  // namespace

std::vector<OptionRow> volumeRows() {
  constexpr OptionTraits kPlaced{.effect = Effect::Picture, .renewal = Renewal::Scene};
  const auto position = [](const std::vector<double>& v) { return glm::dvec3(v[0], v[1], v[2]); };
  return {
      fileRow(),
      numbers<double>(
          "--volume-position", "X,Y,Z, in metres: place of the origin of the grid's file",
          FRAGTRACE_MEMBER(volume.position), 3, position,
          [](const glm::dvec3& p) { return numbersText(p.x, p.y, p.z); }, {"1,-2.5,0"}, kPlaced),
      limit<double>("--volume-scale", "metres per unit of the grid's file; by default 1",
                    FRAGTRACE_MEMBER(volume.scale), {kLeastVolumeScale, kMostVolumeScale}, kPlaced),
      limit<double>("--volume-density", "extinction coefficient of a density of 1, in 1/m; by default 1",
                    FRAGTRACE_MEMBER(volume.density), {0.0, kMostVolumeFactor}, kPlaced),
      color("--volume-color",
            "the part of the light that the grid scatters (albedo), and does not absorb; by default 1,1,1",
            FRAGTRACE_MEMBER(volume.color), 1.0, kPlaced),
      limit<double>(
          "--volume-anisotropy",
          "mean cosine of the angle by which the grid scatters light: above 0 it continues forward; "
          "by default 0",
          FRAGTRACE_MEMBER(volume.anisotropy), {-kMostAnisotropy, kMostAnisotropy}, kPlaced),
      limit<double>(
          "--volume-emission",
          "let the part of the grid that absorbs light (--volume-color) glow as a black body at the "
          "temperatures (kelvin) of the grid `temperature` of its file, times this factor; by default 0",
          FRAGTRACE_MEMBER(volume.emission), {0.0, kMostVolumeFactor}, kPlaced),
  };
}

}  // namespace fragtrace
