// SPDX-License-Identifier: MIT
#include "options/camera_options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <string_view>

#include "errors.h"
#include "options/numbers.h"
#include "options/option_text.h"

namespace fragtrace {

namespace {

std::optional<glm::dvec3> vectorOf(const char* option, const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  for (const double value : values) {
    if (!std::isfinite(value)) throw UsageError(std::string(option) + ": not a finite number");
  }
  return glm::dvec3(values[0], values[1], values[2]);
}

std::optional<glm::dvec3> placeOf(const char* option, const std::vector<double>& values) {
  const std::optional<glm::dvec3> place = vectorOf(option, values);
  if (place && glm::length(*place) > kFarthest)
    throw UsageError(std::string(option) + ": farther than 1e30 m from the origin");
  return place;
}

void append(std::string& text, const char* option, const std::optional<glm::dvec3>& v) {
  if (v) appendOption(text, option, exactText(v->x) + "," + exactText(v->y) + "," + exactText(v->z));
}

void append(std::string& text, const char* option, const std::optional<double>& value) {
  if (value) appendOption(text, option, exactText(*value));
}

}  // namespace

std::string withNumberSettled(std::string argument, std::string_view before) {
  if (argument.starts_with("-.") && argument.size() > 2 &&
      std::isdigit(static_cast<unsigned char>(argument[2]))) {
    argument.insert(1, "0");
  }
  constexpr std::string_view kResolution = "--resolution=";
  constexpr const char* kDigits = "0123456789";
  const bool joined = argument.starts_with(kResolution);
  if (!joined && before != kResolution.substr(0, kResolution.size() - 1)) return argument;
  const size_t start = joined ? kResolution.size() : 0;
  const size_t middle = argument.find_first_not_of(kDigits, start);
  const bool isSize = middle != std::string::npos && middle > start && argument[middle] == 'x' &&
                      middle + 1 < argument.size() &&
                      argument.find_first_not_of(kDigits, middle + 1) == std::string::npos;
  if (isSize) argument[middle] = ',';
  return argument;
}

std::vector<std::string> withNumbersSettled(std::vector<std::string> words) {
  // From the last one on, so that the word before is still as it was given.
  for (size_t i = words.size(); i-- > 0;)
    words[i] = withNumberSettled(words[i], i > 0 ? std::string_view(words[i - 1]) : std::string_view());
  return words;
}

void addCameraOptions(CLI::App& app, RawCamera& raw) {
  const auto addVector = [&](const char* name, std::vector<double>& values, const char* sentence) {
    app.add_option(name, values, sentence)->delimiter(',')->expected(3);
  };
  app.add_option("--resolution", raw.resolution,
                 "WIDTH,HEIGHT or WIDTHxHEIGHT in pixels; by default 1280,720, or 720 high at the aspect "
                 "ratio of the "
                 "camera")
      ->delimiter(',')
      ->expected(2)
      ->check(wholeNumber(1, 65536));
  CLI::Option* index = app.add_option("--camera-index", raw.index,
                                      "index of the scene's camera, from 0; by default the first camera, or "
                                      "a view of the whole scene if the file has no camera")
                           ->check(wholeNumber(0, std::numeric_limits<int>::max()));
  app.add_option("--camera", raw.name, "name or index of the camera; `fragtrace info` lists the cameras")
      ->excludes(index);
  addVector("--camera-position", raw.position, "X,Y,Z of the camera in world space, in metres");
  app.add_option(
         "--camera-orbit", raw.orbit,
         "look at the centre of the scene, or at --camera-focal-point, from AZIMUTH degrees to the right of "
         "the "
         "front (+Z) and ELEVATION degrees above it; ZOOM 2 shows everything twice as large (default 1)")
      ->delimiter(',')
      ->expected(2, 3)
      ->allow_extra_args(false)
      ->option_text("AZIMUTH,ELEVATION[,ZOOM] Excludes: --camera-position")
      ->excludes("--camera-position");
  app.add_flag("--fit", raw.fit,
               "move the camera, without turning it, until the scene fills the picture except for a narrow "
               "margin; with --turntable, all pictures use the same distance");
  addVector("--camera-focal-point", raw.focalPoint, "X,Y,Z of the point that the camera looks at");
  addVector("--camera-view-up", raw.viewUp, "X,Y,Z of the direction that points up in the picture");
  CLI::Option* angle = app.add_option("--camera-view-angle", raw.viewAngleDegrees,
                                      "vertical field of view in degrees, of a perspective camera");
  app.add_option("--camera-parallel-scale", raw.parallelScale,
                 "half of the picture's height in metres, of an orthographic camera")
      ->excludes(angle);
  app.add_option(
         "--f-stop", raw.lens.fStop,
         "blur what is out of focus, as a lens of this f-number does on a sensor 24 mm high, for example "
         "2.8; needs a perspective camera")
      ->check(CLI::Range(1e-6, 1e6));
  app.add_option(
         "--focus-distance", raw.lens.focusDistance,
         "distance in metres, along the view, at which --f-stop is sharp; by default that of the focal "
         "point")
      ->check(CLI::Range(1e-9, 1e30));
  app.add_option("--aperture-blades", raw.lens.blades,
                 "number of straight edges of the aperture of --f-stop, from 3 to 64; 0 is a round one")
      ->check(wholeNumber(0, 64))
      ->capture_default_str();
  addVector("--scene-origin", raw.sceneOrigin,
            "X,Y,Z of a point; positions near this point are the most accurate; by default the focal point "
            "if it is given, otherwise a point near the camera");
}

namespace {

Orbit orbitOf(const std::vector<double>& values) {
  for (const double value : values) {
    if (!std::isfinite(value)) throw UsageError("--camera-orbit: not a finite number");
  }
  const Orbit orbit{values[0], values[1], values.size() > 2 ? values[2] : 1.0};
  if (std::abs(orbit.elevationDegrees) > 90.0)
    throw UsageError("--camera-orbit: the elevation is not between -90 and 90 degrees");
  if (!(orbit.zoom >= 1e-3 && orbit.zoom <= 1e6))
    throw UsageError("--camera-orbit: the zoom is not between 0.001 and 1000000");
  return orbit;
}

}  // namespace

void finishCamera(const RawCamera& raw, RenderOptions& options) {
  if (!raw.resolution.empty()) options.camera.resolution = glm::ivec2(raw.resolution[0], raw.resolution[1]);
  options.camera.index = raw.index;
  options.selection.camera = raw.name;
  options.camera.overrides.position = placeOf("--camera-position", raw.position);
  options.camera.overrides.focalPoint = placeOf("--camera-focal-point", raw.focalPoint);
  options.camera.overrides.viewUp = vectorOf("--camera-view-up", raw.viewUp);
  options.camera.overrides.viewAngleDegrees = raw.viewAngleDegrees;
  options.camera.overrides.parallelScale = raw.parallelScale;
  if (!raw.orbit.empty()) options.camera.overrides.orbit = orbitOf(raw.orbit);
  options.camera.lens = raw.lens;
  const LensOptions& lens = options.camera.lens;
  if (lens.blades == 1 || lens.blades == 2) throw UsageError("--aperture-blades: neither 0 nor 3 or more");
  if (!lens.fStop && (lens.focusDistance || lens.blades > 0))
    throw UsageError(std::string(lens.focusDistance ? "--focus-distance" : "--aperture-blades") +
                     ": goes with --f-stop");
  for (const std::optional<double>& value : {lens.fStop, lens.focusDistance}) {
    if (value && !std::isfinite(*value)) throw UsageError("--f-stop, --focus-distance: not a finite number");
  }
  options.camera.overrides.fit = raw.fit ? Fit::View : Fit::None;
  options.camera.sceneOrigin = placeOf("--scene-origin", raw.sceneOrigin);
  if (options.camera.overrides.viewUp && *options.camera.overrides.viewUp == glm::dvec3(0.0))
    throw UsageError("--camera-view-up: is zero");
}

std::string cameraText(const RenderOptions& options) {
  std::string text;
  if (!options.camera.index && !options.selection.camera.empty())
    appendOption(text, "--camera", options.selection.camera);
  if (options.camera.index) appendOption(text, "--camera-index", std::to_string(*options.camera.index));
  append(text, "--camera-position", options.camera.overrides.position);
  if (const auto& orbit = options.camera.overrides.orbit) {
    appendOption(text, "--camera-orbit",
                 exactText(orbit->azimuthDegrees) + "," + exactText(orbit->elevationDegrees) +
                     (orbit->zoom == 1.0 ? "" : "," + exactText(orbit->zoom)));
  }
  if (options.camera.overrides.fit != Fit::None) text += text.empty() ? "--fit" : " --fit";
  append(text, "--camera-focal-point", options.camera.overrides.focalPoint);
  append(text, "--camera-view-up", options.camera.overrides.viewUp);
  append(text, "--camera-view-angle", options.camera.overrides.viewAngleDegrees);
  append(text, "--camera-parallel-scale", options.camera.overrides.parallelScale);
  append(text, "--f-stop", options.camera.lens.fStop);
  append(text, "--focus-distance", options.camera.lens.focusDistance);
  if (options.camera.lens.blades > 0)
    appendOption(text, "--aperture-blades", std::to_string(options.camera.lens.blades));
  append(text, "--scene-origin", options.camera.sceneOrigin);
  if (options.camera.resolution) {
    appendOption(
        text, "--resolution",
        std::to_string(options.camera.resolution->x) + "," + std::to_string(options.camera.resolution->y));
  }
  return text;
}

RenderOptions withCameraText(RenderOptions options, const std::string& text) {
  CLI::App app;
  app.set_help_flag();
  RawCamera raw;
  addCameraOptions(app, raw);
  parseWords(app, splitWords(text));
  finishCamera(raw, options);
  return options;
}

}  // namespace fragtrace
