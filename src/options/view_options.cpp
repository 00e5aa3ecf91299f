// SPDX-License-Identifier: MIT
#include "options/view_options.h"

#include <CLI/CLI.hpp>

#include "base/errors.h"
#include "options/parse_render.h"

namespace fragtrace {

namespace {

/// Relative error that the picture converges to before the program rests.
constexpr double kNoise = 0.005;
/// The largest side. Drivers can draw it, and X servers take more.
constexpr int kMostWindowPixels = 16384;

}  // namespace

void addViewOptions(CLI::App& app, RawView& raw) {
  RenderOptions& shown = raw.render.options;
  shown.output.denoise = Denoise::Variance;
  addOption(app, "file", raw.render, "scene: a .gltf or .glb file; without one, the window waits for a file");
  app.add_option("others", raw.others,
                 "more models, which Left and Right show instead of those of the folder")
      ->type_name("FILE");
  addOptions(app, OptionGroup::Tracing, raw.render);
  addOptions(app, OptionGroup::Filter, raw.render);
  app.remove_option(app.get_option("--stats"));  // there is no end that they could be of
  const auto describe = [&](const char* name, const char* text) { app.get_option(name)->description(text); };
  describe("--spp", "samples per pixel after which rendering stops; by default without limit");
  describe("--noise",
           "rendering stops once 95 % of the pixels have an estimated relative error below this, by default "
           "0.005");
  describe("--time", "seconds of rendering after which rendering stops");
  describe(
      "--denoise",
      "filter that removes noise while the samples are few: none, variance, oidn, auto; it fades out between "
      "64 and 256 samples per pixel");
  describe("--resolution",
           "WIDTH,HEIGHT of the picture in pixels, at most 16384 each; by default the window has 1280,720");
  addOption(app, "--trace-file", raw.render);
  addConfigOption(app, raw.config);
  app.add_option("--reference", raw.reference,
                 "picture to compare with: a linear .exr, .hdr or .pfm that is shown as side B of the split "
                 "view; without --resolution, the picture of the scene has the size of this one")
      ->type_name("FILE");
  app.add_flag("--watch", raw.watch,
               "reload the scene or the shaders of --shader-folder when a file changes");
  app.add_option("--status-file", raw.statusFile,
                 "JSON file in which the viewer keeps its current state, for scripts that control it")
      ->type_name("FILE");
}

ViewOptions finishView(RawView& raw, CLI::App& command) {
  ViewOptions options;
  raw.render.anyOutput = true;
  options.render = finishConfigured(raw.render, raw.config, command);
  const glm::ivec2 size = options.render.camera.resolution.value_or(glm::ivec2(1));
  if (size.x > kMostWindowPixels || size.y > kMostWindowPixels)
    throw UsageError("--resolution: the viewer's picture has at most " + std::to_string(kMostWindowPixels) +
                     " pixels a side");
  if (!raw.render.spp) options.render.sampling.spp = kMostSamples - options.render.sampling.sampleOffset;
  if (options.render.sampling.noise <= 0.0) options.render.sampling.noise = kNoise;
  options.watch = raw.watch;
  options.statusFile = raw.statusFile;
  options.reference = raw.reference;
  options.others.assign(raw.others.begin(), raw.others.end());
  return options;
}

}  // namespace fragtrace
