// SPDX-License-Identifier: MIT
#include <cmath>

#include "base/errors.h"
#include "options/option_row.h"
#include "options/row_makers.h"

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

}  // namespace fragtrace
