// SPDX-License-Identifier: MIT
// The options that say from where a scene is seen, both ways: parsed, and written as text that gives the same
// picture.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stage/render_options.h"

namespace CLI {
class App;
}

namespace fragtrace {

/// Values as the library parses them, before they become RenderOptions.
struct RawCamera {
  std::vector<int> resolution;
  std::optional<int> index;
  std::string name;
  std::vector<double> position;
  std::vector<double> focalPoint;
  std::vector<double> viewUp;
  std::vector<double> orbit;
  std::optional<double> viewAngleDegrees;
  std::optional<double> parallelScale;
  std::vector<double> sceneOrigin;
  LensOptions lens;
  bool fit = false;
};

/// Numbers such as "-.5,0,1" look like short options to the library; a zero before the point settles it. And
/// --resolution, the word `before` it, may be written as 640x480.
std::string withNumberSettled(std::string argument, std::string_view before);

/// The same of all words of a command.
std::vector<std::string> withNumbersSettled(std::vector<std::string> words);

void addCameraOptions(CLI::App& app, RawCamera& raw);

/// Checks what the library cannot, and puts the values into the options. Throws UsageError.
void finishCamera(const RawCamera& raw, RenderOptions& options);

/// The camera, origin and resolution of the options as text for the command line; every number reads back as
/// itself.
std::string cameraText(const RenderOptions& options);

/// The options with all that cameraText() writes taken from such a text; what it does not name is as by
/// default, but a resolution it does not name stays. Throws UsageError.
RenderOptions withCameraText(RenderOptions options, const std::string& text);

}  // namespace fragtrace
