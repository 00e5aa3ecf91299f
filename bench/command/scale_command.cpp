// SPDX-License-Identifier: MIT
// `fragtrace bench scale`: how time and memory grow with the number of triangles.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "bench/command/commands.h"
#include "bench/command/scale_options.h"
#include "bench/rays/ball_scene.h"
#include "bench/rays/hit_check.h"
#include "bench/rays/ray_sets.h"
#include "bench/report/scale_report.h"
#include "errors.h"
#include "pack/pack_tree.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/peak_memory.h"
#include "session/progress_bar.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

constexpr double kRoundMs = 300.0;  // of frames, each round
constexpr int kMostFrames = 64;

/// One traversal of one scene on the device.
struct Runner {
  TraversalMethod method;
  ShaderVariant variant;
  Renderer* renderer = nullptr;
  std::unique_ptr<Film> film;
  int frames = 1;  ///< a round
  ScaleFrames report;
};

struct Setting {
  const BenchScaleOptions& options;
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
  const std::string name = std::to_string(scene.triangles.size()) + " triangles, " + runner.report.traversal;
  if (totalsOf(pixels).budgetHits > 0)
    throw RenderError(name + ": the driver ended loops early (budget_hits)");
  const Image picture = imageOf(pixels, {});
  const FlatPictureCheck seen = checkFlatPicture(picture, scene, hits);
  runner.report.compared = seen.compared;
  runner.report.wrong = seen.wrong;
  for (size_t i = 0; first && i < picture.values.size(); i += 3) {
    const bool same =
        std::equal(picture.values.begin() + ptrdiff_t(i), picture.values.begin() + ptrdiff_t(i + 3),
                   first->values.begin() + ptrdiff_t(i));
    runner.report.differing += same ? 0 : 1;
  }
  // A bump that is thinner than a pixel can pass between the middles of pixels.
  const size_t pixelCount = picture.values.size() / 3;
  if (seen.wrong > 1 + pixelCount / 20000) {
    throw RenderError(name + ": the picture is wrong in " + std::to_string(seen.wrong) + " of " +
                      std::to_string(seen.compared) + " pixels");
  }
  if (runner.report.differing > wrongRaysAllowed(pixelCount)) {
    throw RenderError(name + ": the picture is not that of " + "the first traversal in " +
                      std::to_string(runner.report.differing) + " pixels");
  }
}

void warmUp(const Setting& setting, Runner& runner) {
  runner.film = std::make_unique<Film>(setting.size);
  runner.report.compileMs = runner.renderer->compile(runner.variant, *runner.film, setting.view);
  runner.report.variant = variantName(runner.variant);
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
  runner.report.frameMs.push_back(times.renderMs / runner.frames);
}

/// The iterative traversal walks a plain list: one frame, unless that takes too long.
ScaleFrames measureIterative(const Setting& setting, const Scene& scene, std::span<const ExactHit> hits,
                             const Image* first) {
  const Bvh list = listLeaves(scene);
  Runner runner{TraversalMethod::Iterative,
                variantFor(setting, TraversalMethod::Iterative, scene, 0),
                nullptr,
                {},
                1,
                {}};
  runner.report.traversal = "iterative";
  const auto renderer = upload(setting, packScene(scene, list, {}, runner.variant), runner.variant);
  runner.renderer = renderer.get();
  runner.film = std::make_unique<Film>(setting.size);
  runner.report.compileMs = runner.renderer->compile(runner.variant, *runner.film, setting.view);
  runner.report.variant = variantName(runner.variant);
  RenderTimes times;
  Stopwatch watch;
  double spent = 0.0;
  const bool complete = runner.renderer->addSamples(*runner.film, setting.view, 0, 1, times, [&](double) {
    spent += watch.lap();
    return spent < 1000.0 * setting.options.longest;
  });
  if (!complete) {
    runner.report.left = "a frame takes longer than --longest";
    return runner.report;
  }
  runner.report.frameMs.push_back(times.renderMs);
  check(runner, scene, hits, first);
  return runner.report;
}

/// What times the traversals of the tree that are asked for; without a renderer yet.
std::vector<Runner> treeRunners(const Setting& setting, const Scene& scene, uint32_t depth) {
  const BenchScaleOptions& options = setting.options;
  std::vector<Runner> runners;
  for (size_t i = 0; i < options.traversals.size(); ++i) {
    const TraversalMethod traversal = options.traversals[i];
    if (traversal == TraversalMethod::Iterative) continue;
    runners.push_back({traversal, variantFor(setting, traversal, scene, depth), nullptr, {}, 1, {}});
    runners.back().report.traversal = options.traversalNames[i];
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

ScaleRow measureSize(Setting& setting, size_t wanted, double iterativeMsPerTriangle) {
  const BenchScaleOptions& options = setting.options;
  ScaleRow row;
  const bool peakKnown = resetPeakMemory();
  Stopwatch watch;
  const Scene scene = makeBallScene(wanted);
  row.triangles = scene.triangles.size();
  row.makeMs = watch.lap();
  const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(row.triangles));
  row.buildMs = watch.lap();
  const BvhQuality quality = bvhQuality(bvh);
  row.sahCost = quality.sahCost;
  row.depth = quality.depth;
  setting.view.camera = frameScene(scene.bounds);

  // Step: both tree traversals read the same arrays.
  std::vector<Runner> runners = treeRunners(setting, scene, bvh.depth);
  std::unique_ptr<Renderer> renderer;
  if (!runners.empty()) {
    watch.lap();
    GpuScene packed = packScene(scene, bvh, {}, runners.front().variant);
    row.packMs = watch.lap();
    row.gpuBytes = packed.bytes();
    renderer = upload(setting, std::move(packed), runners.front().variant);
    row.uploadMs = watch.lap();
  }
  for (Runner& runner : runners) {
    runner.renderer = renderer.get();
    runner.variant.reads = runners.front().variant.reads;
    warmUp(setting, runner);
  }
  for (int round = 0; round < options.rounds; ++round) {
    for (Runner& runner : runners) timeFrames(setting, runner);
  }
  if (peakKnown) row.peakBytes = peakMemory();

  // Step: right pictures only.
  const ExactTracer tracer(scene, bvh);
  const std::vector<Ray> rays = primaryRays(setting.view.camera, setting.view.space, setting.size);
  proveTree(tracer, row.triangles, rays);
  const std::vector<ExactHit> hits = tracer.nearest(rays);
  const std::unique_ptr<Image> first = checkRunners(setting, runners, scene, hits);
  for (Runner& runner : runners) row.frames.push_back(std::move(runner.report));
  if (std::ranges::count(options.traversals, TraversalMethod::Iterative) > 0) {
    ScaleFrames iterative;
    iterative.traversal = "iterative";
    if (iterativeMsPerTriangle * double(row.triangles) > 1000.0 * options.longest) {
      iterative.left = "a frame takes longer than --longest";
    } else {
      renderer.reset();
      iterative = measureIterative(setting, scene, hits, first.get());
    }
    row.frames.push_back(std::move(iterative));
  }
  return row;
}

ScaleReport measure(const BenchScaleOptions& options, const Context& context) {
  Setting setting{options, context, {}, *options.render.camera.resolution};
  setting.view.showEnvironment = false;
  ScaleReport report;
  report.width = setting.size.x;
  report.height = setting.size.y;
  report.renderer = context.renderer;
  ProgressBar bar("measuring", options.render.output.quiet);
  double iterativeMsPerTriangle = 0.0;
  const std::vector<size_t> sizes = sizesOf(options);
  for (size_t i = 0; i < sizes.size(); ++i) {
    report.rows.push_back(measureSize(setting, sizes[i], iterativeMsPerTriangle));
    const ScaleRow& row = report.rows.back();
    for (const ScaleFrames& f : row.frames) {
      if (f.traversal == "iterative" && !f.frameMs.empty())
        iterativeMsPerTriangle = f.frameMs.front() / double(row.triangles);
    }
    bar.show(double(i + 1) / double(sizes.size()));
  }
  bar.clear();
  return report;
}

int runBenchScale(const BenchScaleOptions& options) {
  const std::vector<NamedOutput> outputs{{"--json", options.json}, {"--chart", options.chart}};
  checkOutputs(outputs, {});
  const auto context = makeContext(options.render.device.backend, options.render.device.vectorWidth);
  const ScaleReport report = measure(options, *context);
  countInterrupts();  // what is measured is written whole
  std::fputs(scaleTable(report).c_str(), stdout);
  replaceText(options.json, scaleJson(report));
  replaceText(options.chart, scaleChart(report));
  return 0;
}

}  // namespace

RunCommand addBenchScale(CLI::App& app) {
  const auto raw = std::make_shared<RawBenchScale>();
  addBenchScaleOptions(app, *raw);
  return [raw] { return runBenchScale(finishBenchScale(*raw)); };
}

}  // namespace fragtrace
