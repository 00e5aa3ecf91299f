// SPDX-License-Identifier: MIT
// The command line as a pipeline: scene, tree, context, packed scene, renderer, film, picture.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/statistics.h"
#include "errors.h"
#include "gl/debug_log.h"
#include "gltf/gltf.h"
#include "image/channels.h"
#include "image/format.h"
#include "image/heatmap.h"
#include "image/library.h"
#include "image/tone_map.h"
#include "pack/pack_tree.h"

namespace fragtrace {

namespace {

constexpr int kInterruptedStatus = 130;

/// Milliseconds since the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

Camera chooseCamera(const Scene& scene, const RenderOptions& options) {
  Camera camera;
  if (options.cameraIndex) {
    if (*options.cameraIndex < 0 || size_t(*options.cameraIndex) >= scene.cameras.size()) {
      throw UsageError("--camera-index: " + std::to_string(*options.cameraIndex) + ", but the scene has " +
                       std::to_string(scene.cameras.size()) + " cameras (counted from 0)");
    }
    camera = scene.cameras[size_t(*options.cameraIndex)];
  } else {
    camera = scene.cameras.empty() ? frameScene(scene.bounds) : scene.cameras.front();
  }
  return withOverrides(camera, options.camera, scene.bounds);
}

glm::ivec2 chooseSize(const Camera& camera, const RenderOptions& options) {
  if (options.resolution) return *options.resolution;
  if (camera.aspectRatio <= 0.0) return {1280, 720};
  return {std::clamp(int(std::lround(720.0 * camera.aspectRatio)), 1, 16384), 720};
}

Environment loadEnvironment(const RenderOptions& options, const Scene& scene) {
  Environment environment;
  if (!options.hdriFile.empty()) {
    environment.kind = Surroundings::Map;
    environment.image = readImage(options.hdriFile);
    if (environment.image.channelCount() < 3) throw InputError(options.hdriFile.string() + ": has no colour");
  } else if (options.defaultLight && !hasOwnLight(scene)) {
    environment.kind = Surroundings::DefaultLight;
    environment.image = {1, 1, {"R", "G", "B"}, {1.0f, 1.0f, 1.0f}, {}};
  }
  return environment;
}

View makeView(const RenderOptions& options, const Scene& scene, const Camera& camera) {
  View view;
  view.camera = camera;
  view.sceneOrigin = scene.origin;
  view.hdriRotation = glm::radians(options.hdriRotationDegrees);
  view.background = options.background ? options.backgroundColor : glm::vec3(0.0f);
  view.showEnvironment = options.background && !options.hdriFile.empty();
  view.bounces = options.bounces;
  view.rouletteDepth = options.rouletteDepth;
  view.seed = options.seed;
  return view;
}

void say(const RenderOptions& options, const std::string& text) {
  if (!options.quiet) std::fprintf(stderr, "fragtrace: %s\n", text.c_str());
}

void writePicture(const RenderOptions& options, const Image& linear) {
  if (!isDisplayFormat(options.output)) return writeImage(options.output, linear);
  const bool colors = has(options.stages, Stage::BvhHeatmap);
  const bool keepsAlpha = formatOfName(options.output) == ImageFormat::Png;
  writeImage(options.output,
             toDisplay(keepsAlpha ? linear : withoutAlpha(linear), colors ? 0.0 : options.exposure,
                       colors ? ToneMap::Linear : options.toneMap));
}

}  // namespace

int runRender(const RenderOptions& options) {
  checkOutputs(options);
  Statistics stats;
  Stopwatch watch;

  // Step: load. The image library opens meanwhile when the output needs it.
  std::future<void> library;
  if (options.output.extension() != ".pfm") library = std::async(std::launch::async, preloadImageLibrary);
  GltfOptions loading;
  loading.recenterOn = options.camera.focalPoint;
  const Scene scene = loadGltf(options.scene, loading);
  checkOutputs(options, scene);
  if (scene.triangles.empty() && scene.spheres.empty()) {
    say(options, "warning: " + options.scene.string() + ": no triangle and no sphere, nothing to draw");
  }
  const Environment environment = loadEnvironment(options, scene);
  const Camera camera = chooseCamera(scene, options);
  const glm::ivec2 size = chooseSize(camera, options);
  stats.scene = describe(scene);
  stats.warnings = scene.warnings;
  stats.loadMs = watch.lap();
  for (const std::string& warning : scene.warnings) say(options, "warning: " + warning);
  stats.defaultLight = environment.kind == Surroundings::DefaultLight;
  if (stats.defaultLight) {
    say(options,
        "no light in the scene: a white environment that the camera does not see lights it "
        "(--no-default-light)");
  }

  // Step: build the tree; the iterative traversal needs none.
  const bool iterative = options.traversal == TraversalMethod::Iterative;
  const Bvh bvh =
      iterative ? listLeaves(scene) : buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  stats.bvh = bvhQuality(bvh);
  stats.bvhBuildMs = watch.lap();

  // Step: the shader variant, and the arrays that it reads.
  const auto context = makeContext(options.backend);
  DebugLog driverLog;
  const TraitSet present = traitsOf(scene, environment.kind);
  const ShaderVariant variant = chooseVariant(options, present, environment.kind, bvh.depth,
                                              chooseReads(options.bufferReads, context->software));
  stats.variant = variantName(variant);
  stats.backend = context->backend;
  stats.glRenderer = context->renderer;
  stats.glVersion = context->version;
  for (const StageRow& row : stageRows()) {
    const std::string reason = has(options.stages, row.stage) ? whyOff(row.stage, present) : "";
    if (!reason.empty()) stats.skipped.push_back(std::string(row.name) + ": " + reason);
  }
  watch.lap();
  const GpuScene packed = packScene(scene, bvh, environment, variant);
  stats.sceneBytes = packed.bytes();
  stats.packMs = watch.lap();
  Renderer renderer(*context, packed, variant, options.shaderFolder);
  stats.uploadMs = watch.lap();
  Film film(size);
  const View view = makeView(options, scene, camera);
  stats.compileMs = renderer.compile(film, view);
  if (options.verbose) {
    say(options, "OpenGL " + context->version + " on " + context->renderer + " (" + context->backend + ")");
    say(options, "variant " + stats.variant);
    for (const std::string& line : stats.skipped) say(options, "skipped " + line);
  }

  // Step: draw.
  countInterrupts();
  ProgressBar bar("rendering", options.quiet);
  stats.complete = renderer.addSamples(film, view, options.spp, stats.times, [&](double fraction) {
    bar.show(fraction);
    return interrupts() == 0;
  });
  bar.clear();
  for (const std::string& message : driverLog.take()) say(options, "driver: " + message);
  stats.spp = options.spp;
  stats.size = size;
  stats.film = film.readTotals();
  if (stats.film.budgetHits > 0) {
    throw RenderError("the driver ended loops early in " + std::to_string(stats.film.budgetHits) +
                      " pixels (budget_hits); the picture would be wrong, so none is written");
  }
  if (stats.film.emptyPixels > 0) {
    say(options, "warning: stopped before the first sample of " + std::to_string(stats.film.emptyPixels) +
                     " pixels; they are black");
  }
  if (stats.film.nonfinitePixels > 0) {
    say(options, "warning: samples of " + std::to_string(stats.film.nonfinitePixels) +
                     " pixels were not finite and count as black (nonfinite_pixels)");
  }
  if (interrupts() > 1) return kInterruptedStatus;

  // Step: write.
  Image picture = film.readImage({!options.background, options.aovSamples, options.aovVariance});
  if (has(variant.stages, Stage::BvhHeatmap)) picture = paintHeatmap(picture);
  if (library.valid()) library.wait();
  writePicture(options, picture);
  if (!options.statsFile.empty()) writeStatistics(options.statsFile, stats);
  if (!options.quiet) {
    const double paths =
        stats.complete ? options.spp : double(stats.film.samples) / (double(size.x) * size.y);
    std::printf("%s: %d x %d, %.4g samples a pixel in %.2f s (%.2f million paths/s)\n",
                options.output.string().c_str(), size.x, size.y, paths, stats.times.renderMs / 1000.0,
                megaPathsPerSecond(stats));
  }
  return stats.complete ? 0 : kInterruptedStatus;
}

}  // namespace fragtrace
