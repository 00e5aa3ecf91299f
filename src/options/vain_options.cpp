// SPDX-License-Identifier: MIT
#include "options/vain_options.h"

#include <algorithm>
#include <glm/gtx/component_wise.hpp>

#include "image/files/video_format.h"
#include "image/format.h"
#include "options/option_row.h"

namespace fragtrace {

namespace {

using Options = RenderOptions;

/// Is said where the option is given and the condition holds.
struct VainRow {
  const char* option;
  bool (*isVain)(const Options&);
  const char* why;
};

/// Returns true if a file is written whose name ends so.
bool writes(const Options& o, std::initializer_list<ImageFormat> formats) {
  const auto format = o.output.file.empty() ? std::nullopt : formatOfName(o.output.file);
  return format && std::ranges::find(formats, *format) != formats.end();
}

bool isLinear(const Options& o) {
  return writes(o, {ImageFormat::OpenExr, ImageFormat::Hdr, ImageFormat::Pfm});
}

bool hasNoAlpha(const Options& o) {
  if (writes(o, {ImageFormat::Hdr, ImageFormat::Pfm})) return true;
  return holdsDisplay(o.output.file) && !holdsDisplayAlpha(o.output.file);
}

bool isVideo(const Options& o) { return videoFormatOf(o.output.file) != nullptr; }

bool hasNoSky(const Options& o) { return !o.light.sky.on; }

constexpr const char* kNoSky = "there is no --sky";

constexpr VainRow kRows[] = {
    {"--fps",
     [](const Options& o) {
       // The options of a frame have its time instead of --frames.
       const bool isFrame = o.selection.animationTime.has_value();
       return !o.output.sequence.frames && !isFrame && !isVideo(o) && o.camera.shutter <= 0.0;
     },
     "goes with --frames, --shutter, or with a video"},
    {"--background-blur", [](const Options& o) { return o.light.hdriFile.empty() && !o.light.sky.on; },
     "there is no --hdri-file and no --sky to blur"},
    {"--sun-elevation", hasNoSky, kNoSky},
    {"--sun-azimuth", hasNoSky, kNoSky},
    {"--sun-time", hasNoSky, kNoSky},
    {"--sky-turbidity", hasNoSky, kNoSky},
    {"--ground-albedo", hasNoSky, kNoSky},
    {"--fog-density", [](const Options& o) { return !has(o.stages, Stage::Gi); }, "only stage gi has it"},
    {"--no-background", hasNoAlpha,
     "a file of this format has no alpha, so the background is black; .png, .exr and .mov have it"},
    {"--background-color", [](const Options& o) { return !o.light.background; }, "--no-background hides it"},
    {"--background-color", [](const Options& o) { return glm::compMax(*o.light.backgroundColor) > 1.0f; },
     "values above 1 are brighter than white; divide values from 0 to 255 by 255"},
    {"--transparent-glass", [](const Options& o) { return o.light.background && !o.light.backgroundColor; },
     "goes with --no-background or --background-color: glass shows the environment else"},
    {"--turn", [](const Options& o) { return o.output.sequence.turntable == 0; }, "goes with --turntable"},
    {"--alpha", [](const Options& o) { return o.light.background || !holdsDisplayAlpha(o.output.file); },
     "changes a .png with --no-background only"},
    {"--no-dither",
     [](const Options& o) {
       return isLinear(o) || (writes(o, {ImageFormat::Png}) && o.output.encoding.pngBits == 16);
     },
     "changes .png and .jpg of 8 bits only"},
    {"--exposure", isLinear, "changes .png and .jpg only; this file holds linear radiance"},
    {"--tone-map", isLinear, "changes .png and .jpg only; this file holds linear radiance"},
    {"--output",
     [](const Options& o) {
       return !isSequence(o) && o.output.file.filename().string().find('#') != std::string::npos;
     },
     "# stands for a number or name only with --frames, --turntable or --material-variant all"},
};

}  // namespace

std::vector<std::string> vainOptions(const RenderOptions& options) {
  std::vector<std::string> sentences;
  for (const VainRow& row : kRows) {
    if (!rowOf(row.option).isDefault(options) && row.isVain(options))
      sentences.push_back(std::string(row.option) + ": " + row.why);
  }
  return sentences;
}

}  // namespace fragtrace
