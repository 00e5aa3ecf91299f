// SPDX-License-Identifier: MIT
// The options of `render`, which other commands take too.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "options/camera_options.h"
#include "stage/render_options.h"

namespace CLI {
class App;
}

namespace fragtrace {

/// Of any pixel: sample indices have 32 bits, targets of the film 30.
inline constexpr int kMostSamples = 1 << 29;

/// Option values as the library parses them, before they become RenderOptions.
struct RawRender {
  RenderOptions options;
  std::optional<int> spp;
  std::string scene;
  std::string output;
  RawCamera camera;
  std::string stage = "gi";
  std::vector<std::string> enable;
  std::vector<std::string> disable;
  std::vector<std::string> fileEnable;  ///< of --config: what the command line switches counts more
  std::vector<std::string> fileDisable;
  std::string bounces = "16";
  std::vector<double> backgroundColor;
  std::vector<int> region;
  std::string hdriFile;
  std::string lightSelection = "auto";
  std::string lightReuse = "none";
  std::string caustics = "auto";
  std::string pixelFilter = "box";
  std::string toneMap = "neutral";
  std::string traversal = "auto";
  std::string instancing = "auto";
  std::string backend = "auto";
  std::string reads = "auto";
  std::string dispatch = "auto";
  std::string vectorWidth = "auto";
  std::string schedule = "auto";
  std::string statsFile;
  std::string shaderFolder;
  std::vector<std::string> aov;
  std::string denoise = "none";
  std::string oidnLibrary;
  std::string debugView = "none";
  std::string progress = "auto";
  std::string format;  ///< of a picture on standard output
  std::string fresnel = "exact";
  std::string compensation = "on";
  std::string sampler = "sobol";
  std::string lightSampling = "nee";
  std::string shadowCatcher;
  bool noBackground = false;
  std::string defaultLight = "white";
  bool noDefaultLight = false;
  bool anyOutput = false;  ///< pictures get their names later, so what any format holds may be asked for
};

/// Adds all options but scene and output.
void addRenderOptions(CLI::App& app, RawRender& raw);

/// --denoise and --oidn-library, of commands that finish a picture.
void addDenoiseOption(CLI::App& app, RawRender& raw);

/// Checks what the library cannot. Throws UsageError.
RenderOptions finishRender(const RawRender& raw);

}  // namespace fragtrace
