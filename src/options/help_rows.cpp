// SPDX-License-Identifier: MIT
// Where the options of `render` stand in help, and in which units. An option without a row here stands under
// the topic of its part of the table, and --help all alone shows it.
#include "options/help_rows.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace fragtrace {

namespace {

constexpr bool kEveryday = true;
constexpr bool kRest = false;
constexpr const char* kLook = "Look";
constexpr const char* kOutput = "Output";
constexpr const char* kQuality = "Quality";
constexpr const char* kScene = "Scene";

struct HelpRow {
  std::string_view name;
  OptionHelp shown;  ///< without a topic: that of its part
};

constexpr auto kHelpRows = std::to_array<HelpRow>({
    {"--output", {kOutput, kEveryday, "FILE"}},
    {"--resolution", {nullptr, kEveryday, "WIDTHxHEIGHT", "pixels"}},
    {"--region", {nullptr, kRest, "X,Y,WIDTH,HEIGHT", "pixels"}},
    {"--camera-index", {nullptr, kRest, "INDEX"}},
    {"--camera", {nullptr, kEveryday, "NAME"}},
    {"--camera-position", {nullptr, kEveryday, "X,Y,Z", "metres"}},
    {"--camera-orbit", {nullptr, kEveryday, "AZIMUTH,ELEVATION[,ZOOM]", "degrees"}},
    {"--fit", {nullptr, kEveryday}},
    {"--fit-shadow", {nullptr, kRest}},
    {"--fit-to", {nullptr, kEveryday, "NAME"}},
    {"--fill", {nullptr, kEveryday, "SHARE"}},
    {"--camera-focal-point", {nullptr, kEveryday, "X,Y,Z", "metres"}},
    {"--camera-view-up", {nullptr, kRest, "X,Y,Z"}},
    {"--camera-view-angle", {nullptr, kEveryday, "DEGREES", "degrees"}},
    {"--focal-length", {nullptr, kEveryday, "MM[,SENSOR]", "mm"}},
    {"--camera-parallel-scale", {nullptr, kRest, "METRES", "metres"}},
    {"--lens-shift", {nullptr, kRest, "X,Y"}},
    {"--f-stop", {nullptr, kEveryday, "F"}},
    {"--focus-distance", {nullptr, kEveryday, "METRES", "metres"}},
    {"--scene-origin", {kQuality, kRest, "X,Y,Z", "metres"}},
    {"--pixel-filter", {kQuality, kRest}},
    {"--line-width", {kLook, kRest, "PIXELS", "pixels"}},
    {"--stage", {nullptr, kEveryday}},
    {"--spp", {nullptr, kEveryday}},
    {"--noise", {nullptr, kEveryday, "ERROR"}},
    {"--quality", {nullptr, kEveryday}},
    {"--time", {nullptr, kEveryday, "SECONDS", "seconds"}},
    {"--bounces", {nullptr, kEveryday, "N"}},
    {"--light-selection", {kQuality, kRest}},
    {"--light-reuse", {kQuality, kRest}},
    {"--caustics", {kQuality, kEveryday}},
    {"--hdri-file", {nullptr, kEveryday, "FILE"}},
    {"--hdri-rotation", {nullptr, kEveryday, "DEGREES", "degrees"}},
    {"--hdri-intensity", {nullptr, kEveryday, "FACTOR"}},
    {"--background-blur", {kLook, kRest, "DEGREES", "degrees"}},
    {"--studio", {nullptr, kEveryday}},
    {"--studio-look", {nullptr, kEveryday}},
    {"--shop", {kLook, kEveryday}},
    {"--ground", {kLook, kEveryday, "COLOR[,ROUGHNESS]"}},
    {"--transparent-glass", {kLook, kEveryday}},
    {"--shadow-catcher", {kLook, kEveryday, "HEIGHT", "metres"}},
    {"--shadow-fade", {kLook, kRest, "SHARE[,VERTICAL]"}},
    {"--lamp-units", {nullptr, kEveryday}},
    {"--no-background", {kLook, kEveryday}},
    {"--background-color", {kLook, kEveryday, "COLOR"}},
    {"--default-light", {nullptr, kEveryday}},
    {"--sky", {nullptr, kEveryday}},
    {"--sun-elevation", {nullptr, kEveryday, "DEGREES", "degrees"}},
    {"--sun-azimuth", {nullptr, kEveryday, "DEGREES", "degrees"}},
    {"--sun-place", {nullptr, kRest, "LAT,LON", "degrees"}},
    {"--fog-density", {nullptr, kRest, "DENSITY", "1/m"}},
    {"--fog-color", {nullptr, kRest, "COLOR"}},
    {"--fog-anisotropy", {nullptr, kRest, "COSINE"}},
    {"--fog-height", {nullptr, kRest, "H[,BASE]", "metres"}},
    {"--fog-distance", {nullptr, kRest, "METRES", "metres"}},
    {"--volume-position", {nullptr, kRest, "X,Y,Z", "metres"}},
    {"--volume-scale", {nullptr, kRest, "METRES", "metres"}},
    {"--volume-density", {nullptr, kRest, "DENSITY", "1/m"}},
    {"--volume-color", {nullptr, kRest, "COLOR"}},
    {"--volume-anisotropy", {nullptr, kRest, "COSINE"}},
    {"--volume-emission", {nullptr, kRest, "FACTOR"}},
    {"--rendering-backend", {nullptr, kEveryday}},
    {"--device", {nullptr, kEveryday, "N|NAME"}},
    {"--vector-width", {nullptr, kRest, "BITS", "bits"}},
    {"--animation-time", {nullptr, kEveryday, "SECONDS", "seconds"}},
    {"--animation", {nullptr, kEveryday, "NAME"}},
    {"--scene", {nullptr, kRest, "NAME"}},
    {"--material-variant", {nullptr, kEveryday, "NAME"}},
    {"--hide", {nullptr, kEveryday}},
    {"--set", {nullptr, kEveryday, "MATERIAL:NAME=VALUES"}},
    {"--add-light", {"Light", kEveryday, "LIGHT"}},
    {"--up", {nullptr, kEveryday, "AXIS"}},
    {"--memory-limit", {"Device", kEveryday}},
    {"--texture-limit", {nullptr, kRest, "PIXELS", "pixels"}},
    {"--exposure", {kLook, kEveryday, "STOPS", "stops"}},
    {"--tone-map", {kLook, kEveryday}},
    {"--ocio-view", {kLook, kEveryday, "NAME"}},
    {"--ocio-config", {kLook, kRest}},
    {"--ocio-display", {kLook, kRest, "NAME"}},
    {"--ocio-look", {kLook, kRest, "NAME"}},
    {"--ocio-input", {kLook, kRest, "NAME"}},
    {"--quiet", {nullptr, kEveryday}},
    {"--verbose", {nullptr, kEveryday}},
    {"--png-depth", {nullptr, kRest, "BITS", "bits"}},
    {"--checkpoint", {nullptr, kRest, "SECONDS", "seconds"}},
    {"--resume", {nullptr, kEveryday}},
    {"--frames", {nullptr, kEveryday, "A:B[:STEP]"}},
    {"--fps", {nullptr, kEveryday, "FPS", "frames per second"}},
    {"--turntable", {nullptr, kEveryday}},
    {"--turn", {nullptr, kEveryday}},
    {"--shutter", {nullptr, kRest, "DEGREES", "degrees"}},
    {"--denoise", {kQuality, kEveryday}},
    {"--oidn-library", {kQuality, kRest, "FILE"}},
});

}  // namespace

OptionHelp helpOf(std::string_view name, const char* topic) {
  const auto* row = std::ranges::find(kHelpRows, name, &HelpRow::name);
  OptionHelp shown = row == std::end(kHelpRows) ? OptionHelp{} : row->shown;
  if (shown.topic == nullptr) shown.topic = topic;
  return shown;
}

std::vector<std::string_view> namesOfHelpRows() {
  std::vector<std::string_view> names;
  names.reserve(std::size(kHelpRows));
  for (const HelpRow& row : kHelpRows) names.push_back(row.name);
  return names;
}

}  // namespace fragtrace
