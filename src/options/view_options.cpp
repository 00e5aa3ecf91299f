// SPDX-License-Identifier: MIT
#include "options/view_options.h"

#include <CLI/CLI.hpp>

#include "errors.h"
#include "options/config_file.h"

namespace fragtrace {

namespace {

/// Relative error that the picture converges to before the program rests.
constexpr double kNoise = 0.005;
/// A side; what drivers draw, and less than what X servers take.
constexpr int kMostWindowPixels = 16384;

}  // namespace

void addViewOptions(CLI::App& app, RawView& raw) {
  app.add_option("file", raw.render.scene, ".gltf or .glb file")->required();
  addRenderOptions(app, raw.render);
  raw.render.denoise = "variance";
  addDenoiseOption(app, raw.render);
  const auto describe = [&](const char* name, const char* text) { app.get_option(name)->description(text); };
  describe("--spp", "camera paths a pixel at which the picture rests, default unlimited");
  describe("--noise", "it rests when 95 % of the pixels have a relative error below this, default 0.005");
  describe("--time", "it rests after so many seconds of drawing");
  describe(
      "--denoise",
      "none, variance: filter the noise out of the picture while its samples are few: all of it up to 64, "
      "nothing from 256");
  describe("--resolution", "WIDTH,HEIGHT of the window, default 1280,720, at most 16384 a side");
  addConfigOption(app, raw.config);
  app.add_flag("--watch", raw.watch, "reload when a file of the scene, or of --shader-folder, changes");
  app.add_option("--status-file", raw.statusFile,
                 "JSON file that always holds what the viewer is doing, for scripts that drive it");
}

ViewOptions finishView(RawView& raw, CLI::App& command) {
  ViewOptions options;
  raw.render.anyOutput = true;
  options.render = finishConfigured(raw.render, raw.config, command);
  const glm::ivec2 size = options.render.resolution.value_or(glm::ivec2(1));
  if (size.x > kMostWindowPixels || size.y > kMostWindowPixels)
    throw UsageError("--resolution: a window has at most " + std::to_string(kMostWindowPixels) +
                     " pixels a side");
  if (!raw.render.spp) options.render.spp = kMostSamples - options.render.sampleOffset;
  if (options.render.noise <= 0.0) options.render.noise = kNoise;
  options.watch = raw.watch;
  options.statusFile = raw.statusFile;
  return options;
}

}  // namespace fragtrace
