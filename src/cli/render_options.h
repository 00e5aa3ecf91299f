// SPDX-License-Identifier: MIT
// The options of `render`, which other commands take too.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stage/options.h"

namespace CLI {
class App;
}

namespace fragtrace {

/// Option values as the library parses them, before they become RenderOptions.
struct RawRender {
  RenderOptions options;
  std::optional<int> spp;
  std::string scene;
  std::string output;
  std::vector<int> resolution;
  std::string stage = "gi";
  std::vector<std::string> enable;
  std::vector<std::string> disable;
  std::string bounces = "16";
  std::vector<double> position;
  std::vector<double> focalPoint;
  std::vector<double> viewUp;
  std::vector<double> backgroundColor;
  std::string hdriFile;
  std::string pixelFilter = "box";
  std::string toneMap = "neutral";
  std::string traversal = "auto";
  std::string backend = "auto";
  std::string reads = "auto";
  std::string dispatch = "auto";
  std::string statsFile;
  std::string shaderFolder;
  std::vector<std::string> aov;
  std::string fresnel = "exact";
  std::string compensation = "on";
  std::string sampler = "sobol";
  std::string lightSampling = "nee";
  bool noBackground = false;
  bool noDefaultLight = false;
};

/// Numbers such as "-.5,0,1" look like short options to the library; a zero before the point settles it. And
/// a size may be written as 640x480.
std::string withNumberSettled(std::string argument);

/// Adds all options but scene and output.
void addRenderOptions(CLI::App& app, RawRender& raw);

/// Checks what the library cannot. Throws UsageError.
RenderOptions finishRender(const RawRender& raw);

}  // namespace fragtrace
