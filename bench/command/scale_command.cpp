// SPDX-License-Identifier: MIT
// `fragtrace bench scale`: how time and memory grow with the number of triangles.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include "base/errors.h"
#include "base/summary.h"
#include "bench/command/commands.h"
#include "bench/command/configurations.h"
#include "bench/command/peak_memory.h"
#include "bench/command/results.h"
#include "bench/report/scale_report.h"
#include "options/choose.h"
#include "options/numbers.h"
#include "pack/pack_tree.h"
#include "session/progress_bar.h"
#include "session/setup.h"
#include "tests/instruments/rays/ball_scene.h"
#include "tests/instruments/rays/hit_check.h"
#include "tests/instruments/rays/ray_sets.h"

namespace fragtrace {

namespace {

constexpr size_t kFewest = 100;
constexpr size_t kMost = 100000000;

const std::vector<std::string>& traversalNames() {
  static const std::vector<std::string> names{"iterative", "bvh", "front-to-back"};
  return names;
}

/// The options as parsed, and values that follow from them.
struct ScaleOptions {
  RawRender raw;
  RenderOptions render;  ///< resolution, device
  std::vector<std::string> traversalNames{"front-to-back", "bvh", "iterative"};
  std::vector<TraversalMethod> traversals;
  size_t from = 1000;
  size_t to = 10000000;
  int perDecade = 2;  ///< sizes in a factor of ten
  int rounds = 5;
  double longest = 60.0;  ///< seconds a frame of the iterative traversal may take
  ResultFiles files;
};

void declareScale(CLI::App& app, ScaleOptions& o) {
  app.add_option("--from", o.from, "triangles of the smallest scene")
      ->check(wholeNumber(kFewest, kMost))
      ->capture_default_str();
  app.add_option("--to", o.to, "triangles of the largest scene")
      ->check(wholeNumber(kFewest, kMost))
      ->capture_default_str();
  app.add_option("--per-decade", o.perDecade, "number of sizes per factor of ten")
      ->check(wholeNumber(1, 10))
      ->capture_default_str();
  addOption(app, "--resolution", o.raw, "WIDTH,HEIGHT of the picture in pixels")->check(wholeNumber(8, 4096));
  o.raw.options.camera.resolution = glm::ivec2(500, 500);
  app.add_option("--traversals", o.traversalNames,
                 "traversals to measure: " + joined(traversalNames()) + "; ratios are to the first")
      ->delimiter(',');
  app.add_option("--rounds", o.rounds, "rounds of timing")
      ->check(wholeNumber(1, 1000))
      ->capture_default_str();
  app.add_option("--longest", o.longest,
                 "skip the iterative traversal if its frame takes longer than this many seconds")
      ->check(realNumber(0.001, 1e6))
      ->capture_default_str();
  addJsonOption(app, o.files, "write all measurements to this file, one JSON line per size");
  addChartOption(app, o.files, "write a chart of time against triangles, an .svg");
  addDeviceOptions(app, o.raw);
}

/// Throws UsageError.
void settleScale(const CLI::App&, ScaleOptions& o) {
  o.raw.stage = "flat";
  o.render = finishRender(o.raw);
  if (o.to < o.from) throw UsageError("--to: is below --from");
  for (const std::string& name : o.traversalNames) {
    const int index = choose<int>("--traversals", name, traversalNames());
    if (std::ranges::count(o.traversalNames, name) > 1)
      throw UsageError("--traversals: '" + name + "' stands twice");
    o.traversals.push_back(TraversalMethod(index + int(TraversalMethod::Iterative)));
  }
  checkChart(o.files);
}

/// The sizes: from, then perDecade a factor of ten, and to.
std::vector<size_t> sizesOf(const ScaleOptions& options) {
  std::vector<size_t> sizes;
  for (int i = 0;; ++i) {
    const double size = double(options.from) * std::pow(10.0, double(i) / options.perDecade);
    // If less than 5 % remains up to the last size, there is no size in between.
    if (size > 0.95 * double(options.to)) break;
    sizes.push_back(size_t(std::llround(size)));
  }
  sizes.push_back(options.to);
  return sizes;
}

constexpr double kRoundMs = 300.0;  // milliseconds of frames in each round
constexpr int kMostFrames = 64;

/// One traversal of one scene on the device.
struct Runner {
  std::string name;
  ShaderVariant variant;
  Renderer* renderer = nullptr;
  std::unique_ptr<Film> film;
  int frames = 1;  ///< a round
  double compileMs = 0.0;
  std::vector<double> frameMs;  ///< one a round
  FlatPictureCheck seen;
  size_t differing = 0;  ///< pixels that differ from those of the first traversal
};

/// The data that all measurements of one run share. The camera is that of the size.
struct Setting {
  const ScaleOptions& options;
  const Context& context;
  View view;
  glm::ivec2 size;
};

ShaderVariant variantFor(const Setting& setting, TraversalMethod method, const Scene& scene, uint32_t depth) {
  RenderOptions wanted = setting.options.render;
  wanted.device.traversal = method;
  return chooseVariant(wanted, traitsOf(scene, Surroundings::None), Surroundings::None, depth,
                       BufferReads::Auto);
}

std::unique_ptr<Renderer> upload(const Setting& setting, GpuScene packed, ShaderVariant& variant) {
  const RenderOptions& render = setting.options.render;
  variant.reads =
      chooseReads(render.device.bufferReads, setting.context.software, packed, readLimits()).reads;
  return std::make_unique<Renderer>(setting.context, std::move(packed), variant.reads,
                                    render.device.shaderFolder);
}

/// The picture is held against double precision, and against the first traversal's. Throws RenderError.
void check(Runner& runner, const Scene& scene, std::span<const ExactHit> hits, const Image* first) {
  const FilmPixels pixels = runner.film->read();
  const std::string name = std::to_string(scene.triangles.size()) + " triangles, " + runner.name;
  if (totalsOf(pixels).budgetHits > 0)
    throw RenderError(name + ": the driver ended loops early (budget_hits)");
  const Image picture = imageOf(pixels, {});
  runner.seen = checkFlatPicture(picture, scene, hits);
  for (size_t i = 0; first && i < picture.values.size(); i += 3) {
    const bool same =
        std::equal(picture.values.begin() + ptrdiff_t(i), picture.values.begin() + ptrdiff_t(i + 3),
                   first->values.begin() + ptrdiff_t(i));
    runner.differing += same ? 0 : 1;
  }
  // A bump that is thinner than a pixel can pass between the middles of pixels.
  const size_t pixelCount = picture.values.size() / 3;
  if (runner.seen.wrong > 1 + pixelCount / 20000) {
    throw RenderError(name + ": the picture is wrong in " + std::to_string(runner.seen.wrong) + " of " +
                      std::to_string(runner.seen.compared) + " pixels");
  }
  if (runner.differing > wrongRaysAllowed(pixelCount)) {
    throw RenderError(name + ": the picture is not that of " + "the first traversal in " +
                      std::to_string(runner.differing) + " pixels");
  }
}

/// Once a scene; a renderer's programs stay in its cache.
void compile(const Setting& setting, Runner& runner, Renderer& renderer) {
  runner.renderer = &renderer;
  runner.film = std::make_unique<Film>(setting.size);
  runner.compileMs = renderer.compile(runner.variant, *runner.film, setting.view);
}

/// Chooses how many frames make a round.
void warmUp(const Setting& setting, Runner& runner) {
  RenderTimes times;
  runner.renderer->addSamples(*runner.film, setting.view, 0, 4, times);
  runner.frames = int(std::clamp(kRoundMs / times.frameMs.back(), 1.0, double(kMostFrames)));
}

/// A round: the variant is made current and finds its pace, then its frames are timed.
void timeFrames(const Setting& setting, Runner& runner) {
  runner.renderer->compile(runner.variant, *runner.film, setting.view);
  RenderTimes unused;
  runner.renderer->addSamples(*runner.film, setting.view, 0, 2, unused);
  RenderTimes times;
  runner.renderer->addSamples(*runner.film, setting.view, 2, 2 + runner.frames, times);
  runner.frameMs.push_back(times.renderMs / runner.frames);
}

/// Returns the JSON of a traversal's frame times.
Json framesJson(const Runner& runner) {
  return {{"traversal", runner.name},
          {"variant", variantName(runner.variant)},
          {"compile_ms", runner.compileMs},
          {"frame_ms", runner.frameMs},
          {"median_ms", summarize(runner.frameMs).median},
          {"compared_pixels", runner.seen.compared},
          {"wrong_pixels", runner.seen.wrong},
          {"differing_pixels", runner.differing}};
}

/// Returns the JSON that replaces the figures if a frame would take, or takes, too long.
Json tooLongJson() {
  return {{"traversal", "iterative"}, {"left_out", "a frame takes longer than --longest"}};
}

/// The iterative traversal walks a plain list: one frame, unless that takes too long.
Json measureIterative(const Setting& setting, const Scene& scene, std::span<const ExactHit> hits,
                      const Image* first) {
  const Bvh list = listLeaves(scene);
  Runner runner;
  runner.name = "iterative";
  runner.variant = variantFor(setting, TraversalMethod::Iterative, scene, 0);
  const auto renderer = upload(setting, packScene(scene, list, {}, runner.variant), runner.variant);
  compile(setting, runner, *renderer);
  RenderTimes times;
  Stopwatch watch;
  double spent = 0.0;
  const bool complete = renderer->addSamples(*runner.film, setting.view, 0, 1, times, [&](double) {
    spent += watch.lap();
    return spent < 1000.0 * setting.options.longest;
  });
  if (!complete) return tooLongJson();
  runner.frameMs.push_back(times.renderMs);
  check(runner, scene, hits, first);
  return framesJson(runner);
}

/// Makes a runner for each traversal of the tree that is asked for. The runners have no renderer yet.
std::vector<Runner> treeRunners(const Setting& setting, const Scene& scene, uint32_t depth) {
  const ScaleOptions& options = setting.options;
  std::vector<Runner> runners;
  for (size_t i = 0; i < options.traversals.size(); ++i) {
    if (options.traversals[i] == TraversalMethod::Iterative) continue;
    Runner& runner = runners.emplace_back();
    runner.name = options.traversalNames[i];
    runner.variant = variantFor(setting, options.traversals[i], scene, depth);
  }
  return runners;
}

/// Looks at the same samples of all, and says which picture is right: the first one's.
std::unique_ptr<Image> checkRunners(Setting& setting, std::vector<Runner>& runners, const Scene& scene,
                                    const std::vector<ExactHit>& hits) {
  std::unique_ptr<Image> first;
  for (Runner& runner : runners) {
    runner.renderer->compile(runner.variant, *runner.film, setting.view);
    RenderTimes unused;
    runner.renderer->addSamples(*runner.film, setting.view, 0, 1, unused);
    check(runner, scene, hits, first.get());
    if (!first) first = std::make_unique<Image>(imageOf(runner.film->read(), {}));
  }
  return first;
}

void timeRunners(const Setting& setting, std::vector<Runner>& runners, Renderer& renderer) {
  for (Runner& runner : runners) {
    runner.variant.reads = runners.front().variant.reads;
    compile(setting, runner, renderer);
    warmUp(setting, runner);
  }
  for (int round = 0; round < setting.options.rounds; ++round) {
    for (Runner& runner : runners) timeFrames(setting, runner);
  }
}

/// A size, as it is written. `iterativeMsPerTriangle` is that of the size before, and becomes this one's.
Json measureSize(Setting& setting, size_t wanted, double& iterativeMsPerTriangle) {
  const ScaleOptions& options = setting.options;
  Json row = {{"schema", 1},
              {"bench", "scale"},
              {"width", setting.size.x},
              {"height", setting.size.y},
              {"gl_renderer", setting.context.renderer}};
  const bool peakKnown = resetPeakMemory();
  Stopwatch watch;
  const Scene scene = makeBallScene(wanted);
  const size_t triangles = scene.triangles.size();
  row["triangles"] = triangles;
  row["make_ms"] = watch.lap();
  const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(triangles));
  row["build_ms"] = watch.lap();
  const BvhQuality quality = bvhQuality(bvh);
  setting.view.camera = frameScene(scene.bounds);

  // Step: both tree traversals read the same arrays.
  std::vector<Runner> runners = treeRunners(setting, scene, bvh.depth);
  std::unique_ptr<Renderer> renderer;
  size_t gpuBytes = 0;
  row["pack_ms"] = 0.0;
  row["upload_ms"] = 0.0;
  if (!runners.empty()) {
    watch.lap();
    GpuScene packed = packScene(scene, bvh, {}, runners.front().variant);
    row["pack_ms"] = watch.lap();
    gpuBytes = packed.bytes();
    renderer = upload(setting, std::move(packed), runners.front().variant);
    row["upload_ms"] = watch.lap();
  }
  if (renderer) timeRunners(setting, runners, *renderer);
  row["sah_cost"] = quality.sahCost;
  row["depth"] = quality.depth;
  row["gpu_bytes"] = gpuBytes;
  row["gpu_bytes_per_triangle"] = double(gpuBytes) / double(triangles);
  row["peak_bytes"] = peakKnown ? peakMemory() : 0;  // resident, until the last frame

  // Step: right pictures only.
  const ExactTracer tracer(scene, bvh);
  const std::vector<Ray> rays = primaryRays(setting.view.camera, setting.view.space, setting.size);
  proveTree(tracer, triangles, rays);
  const std::vector<ExactHit> hits = tracer.nearest(rays);
  const std::unique_ptr<Image> first = checkRunners(setting, runners, scene, hits);
  Json& traversals = row["traversals"] = Json::array();
  std::ranges::transform(runners, std::back_inserter(traversals), framesJson);
  if (std::ranges::count(options.traversals, TraversalMethod::Iterative) > 0) {
    renderer.reset();
    const bool tooLong = iterativeMsPerTriangle * double(triangles) > 1000.0 * options.longest;
    const Json iterative = tooLong ? tooLongJson() : measureIterative(setting, scene, hits, first.get());
    if (iterative.contains("frame_ms"))
      iterativeMsPerTriangle = iterative["frame_ms"][0].get<double>() / double(triangles);
    traversals.push_back(iterative);
  }
  return row;
}

std::vector<Json> measure(const ScaleOptions& options, const Context& context) {
  Setting setting{options, context, {}, *options.render.camera.resolution};
  setting.view.showEnvironment = false;
  ProgressBar bar("measuring", options.render.output.quiet);
  double iterativeMsPerTriangle = 0.0;
  std::vector<Json> rows;
  const std::vector<size_t> sizes = sizesOf(options);
  for (const size_t size : sizes) {
    rows.push_back(measureSize(setting, size, iterativeMsPerTriangle));
    bar.show(double(rows.size()) / double(sizes.size()));
  }
  bar.clear();
  return rows;
}

int runScale(const ScaleOptions& options) {
  checkResultFiles(options.files, {});
  const auto context = contextOf(options.render);
  const std::vector<Json> report = measure(options, *context);
  writeResults(options.files, {scaleTable(report), scaleJson(report), {}, scaleChart(report)});
  return 0;
}

}  // namespace

RunCommand addBenchScale(CLI::App& app) { return commandOf(app, declareScale, settleScale, runScale); }

}  // namespace fragtrace
