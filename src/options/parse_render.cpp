// SPDX-License-Identifier: MIT
#include "options/parse_render.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "bvh/bvh.h"
#include "image/format.h"
#include "image/image.h"
#include "options/choose.h"
#include "options/device_options.h"
#include "options/input_options.h"
#include "options/numbers.h"
#include "options/old_spellings.h"
#include "options/output_options.h"
#include "options/surroundings_options.h"

namespace fragtrace {

namespace {

std::vector<std::string> stageNames(bool cumulativeOnly) {
  std::vector<std::string> names;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative || !cumulativeOnly) names.emplace_back(row.name);
  }
  return names;
}

Stage stageNamed(const char* option, const std::string& name) {
  const std::optional<Stage> stage = parseStage(name);
  if (!stage)
    throw UsageError(std::string(option) + ": '" + name + "' is none of " + joined(stageNames(false)));
  return *stage;
}

int parseBounces(const std::string& text) {
  if (text == "unlimited") return kUnlimitedBounces;
  int value = -1;
  if (!CLI::detail::lexical_cast(text, value) || value < 0) {
    throw UsageError("--bounces: '" + text + "' is neither a number from 0 on nor 'unlimited'");
  }
  return value;
}

void checkFinite(const RenderOptions& o) {
  const auto check = [](const char* option, double value) {
    if (!std::isfinite(value)) throw UsageError(std::string(option) + ": not a finite number");
  };
  check("--exposure", o.output.exposure);
  // The library's ranges let NaN pass.
  check("--noise", o.sampling.noise);
  check("--time", o.sampling.seconds);
  check("--checkpoint", o.output.checkpointSeconds);
  check("--clamp-indirect", o.sampling.clampIndirect);
  check("--hdri-rotation", o.light.hdriRotationDegrees);
  check("--hdri-intensity", o.light.hdriIntensity);
  check("--background-blur", o.light.backgroundBlur);
  const glm::vec3 background = o.light.backgroundColor.value_or(glm::vec3(0.0f));
  for (int i = 0; i < 3; ++i) check("--background-color", background[i]);
  if (glm::any(glm::lessThan(background, glm::vec3(0.0f)))) throw UsageError("--background-color: below 0");
}

/// Of first hits, then those of the film.
std::vector<std::string_view> layerNames() {
  std::vector<std::string_view> names;
  for (const FeatureRow& row : kFeatureRows) {
    if (!row.name.empty()) names.push_back(row.name);
  }
  names.insert(names.end(), {"samples", "variance"});
  return names;
}

void chooseLayers(const std::vector<std::string>& names, RenderOptions& o) {
  const std::vector<std::string_view> known = layerNames();
  for (const std::string& name : names) {
    const auto index = choose<size_t>("--aov", name, known);
    if (name == "samples") {
      o.output.aovSamples = true;
    } else if (name == "variance") {
      o.output.aovVariance = true;
    } else if (const Feature feature = Feature(index + 1);
               std::ranges::find(o.output.aovFeatures, feature) == o.output.aovFeatures.end()) {
      if (isLightPart(feature) && !has(o.stages, Stage::Gi))
        throw UsageError("--aov " + name + ": only stage gi has it");
      o.output.aovFeatures.push_back(feature);
      // All that a filter needs.
      if (feature == Feature::Guides) o.output.aovSamples = o.output.aovVariance = true;
    }
  }
}

/// What light paths cannot do, which auto leaves to paths from the camera.
void checkCaustics(const RenderOptions& o) {
  if (o.light.caustics != Caustics::On) return;
  if (o.sampling.clampIndirect > 0.0)
    throw UsageError("--caustics on: light paths cannot be clamped (--clamp-indirect)");
  if (o.light.shadowCatcher)
    throw UsageError("--caustics on: a shadow catcher shows no caustics (--shadow-catcher)");
  if (std::ranges::any_of(o.output.aovFeatures, isLightPart))
    throw UsageError("--caustics on: emission, diffuse and specular (--aov) would not add up to the picture");
}

/// Pixels take light samples of others in the same pass of the whole picture, so that their errors are alike.
void checkLightReuse(const RenderOptions& o) {
  if (o.light.reuse != LightReuse::Spatial) return;
  const std::string refused = "--light-reuse spatial: not with ";
  if (o.camera.region) throw UsageError(refused + "--region: pixels take light from others");
  if (isAdaptive(o)) throw UsageError(refused + "--noise, --time: all pixels need as many samples");
  if (o.output.denoise != Denoise::None)
    throw UsageError(refused + "--denoise: a filter takes what pixels share for the picture");
  if (std::ranges::any_of(o.output.aovFeatures, isLightPart))
    throw UsageError(refused + "emission, diffuse, specular (--aov): they would not add up to the picture");
}

/// X, Y, width, height.
Region regionOf(const std::vector<int>& numbers) {
  const Region region{{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
  if (region.size.x < 1 || region.size.y < 1) throw UsageError("--region: holds no pixel");
  return region;
}

std::vector<std::string_view> debugViewNames() {
  std::vector<std::string_view> names;
  names.reserve(std::size(kDebugViewRows));
  for (const DebugViewRow& row : kDebugViewRows) names.push_back(row.name);
  return names;
}

/// Those that --help names: the heat map is a switch.
std::vector<std::string_view> namedDebugViews() {
  std::vector<std::string_view> names = debugViewNames();
  std::erase(names, rowOf(DebugView::Visits).name);
  return names;
}

DebugView debugViewNamed(const std::string& name) {
  if (name == rowOf(DebugView::Visits).name) return DebugView::Visits;
  choose<int>("--debug-view", name, namedDebugViews());  // throws for what is none
  return choose<DebugView>("--debug-view", name, debugViewNames());
}

/// What is shaded.
void addStageOptions(CLI::App& app, RawRender& raw) {
  app.add_option("--stage", raw.stage,
                 "last stage: " + joined(stageNames(true)) + "; each stage includes those before it")
      ->capture_default_str();
  app.add_option(
         "--enable", raw.enable,
         "additional stages and switches to turn on, separated by commas: " + joined(stageNames(false)))
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--disable", raw.disable,
                 "stages and switches to turn off, separated by commas: the names of --enable")
      ->delimiter(',')
      ->allow_extra_args(false);
}

/// How many samples, and which.
void addSampleOptions(CLI::App& app, RawRender& raw) {
  RenderOptions& o = raw.options;
  app.add_option(
         "--spp", raw.spp,
         "samples (camera paths) per pixel, 64 by default; with --noise or --time: at most this many, by "
         "default without limit")
      ->check(wholeNumber(1, kMostSamples));
  app.add_option(
         "--noise", o.sampling.noise,
         "render until 95 % of the pixels that can be noisy have an estimated relative error below this, for "
         "example 0.01")
      ->check(CLI::Range(1e-5, 1.0));
  app.add_option("--time", o.sampling.seconds,
                 "render for this many seconds, and place the samples where they help most")
      ->check(CLI::Range(0.01, 1e7));
  app.add_option(
         "--sample-offset", o.sampling.sampleOffset,
         "index of the first sample in the sample sequence of this seed; for rendering in parts (see merge)")
      ->check(wholeNumber(0, kMostSamples))
      ->capture_default_str();
  app.add_option("--seed", o.sampling.seed, "seed of the sample points, 0 to 4294967295")
      ->check(wholeNumber(0, std::numeric_limits<uint32_t>::max()))
      ->capture_default_str();
}

/// What --enable and --disable say today; --help leaves them out, and its use is told (sayOldSpellings).
void addOldSpellings(CLI::App& app, RawRender& raw) {
  app.add_option("--sampler", raw.sampler, "sobol: --enable sobol, random: --disable sobol")
      ->group(kOldSpellings);
  app.add_option("--fresnel", raw.fresnel, "schlick: --enable schlick, exact: --disable schlick")
      ->group(kOldSpellings);
  app.add_option("--energy-compensation", raw.compensation,
                 "on: --enable energy-compensation, off: --disable energy-compensation")
      ->group(kOldSpellings);
  app.add_option("--light-sampling", raw.lightSampling,
                 "nee: --enable light-sampling, bsdf: --disable light-sampling")
      ->group(kOldSpellings);
}

/// What a path does.
void addPathOptions(CLI::App& app, RawRender& raw) {
  RenderOptions& o = raw.options;
  app.add_option("--bounces", raw.bounces,
                 "maximum number of scattering events per path, not counting smooth glass, or 'unlimited'")
      ->capture_default_str();
  app.add_option("--rr-depth", o.sampling.rouletteDepth,
                 "Russian roulette may end a path from this scattering event on")
      ->check(wholeNumber(1, std::numeric_limits<int>::max() / 4))
      ->capture_default_str();
  app.add_option("--clamp-indirect", o.sampling.clampIndirect,
                 "maximum radiance that indirect light (two or more scattering events) adds to a sample; "
                 "this removes bright dots but darkens the picture")
      ->check(CLI::Range(1e-6, 1e30));
  app.add_option(
         "--light-selection", raw.lightSelection,
         "how global illumination chooses a light to sample: by what it may send to the point (tree), "
         "by its power, or all alike: " +
             joined(kLightSelectionNames))
      ->capture_default_str();
  app.add_option(
         "--light-reuse", raw.lightReuse,
         "how global illumination takes the light sample of a point: one alone (none), one of four by "
         "the light that they may bring (candidates), or, for what the camera sees, one of those "
         "of pixels nearby (spatial): " +
             joined(kLightReuseNames))
      ->capture_default_str();
  app.add_option("--caustics", raw.caustics,
                 "trace paths from lamps to smooth glass and metal for the light that these throw on rough "
                 "surfaces; auto does where there are both: " +
                     joined(kCausticsNames))
      ->capture_default_str();
}

/// What of the samples a picture shows.
void addPictureOptions(CLI::App& app, RawRender& raw) {
  RenderOptions& o = raw.options;
  app.add_option("--pixel-filter", raw.pixelFilter, "pixel filter: " + joined(kPixelFilterNames))
      ->capture_default_str();
  app.add_option("--line-width", o.camera.lineWidth, "width of points and lines in pixels of the picture")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  app.add_option("--aov", raw.aov,
                 "extra layers to write into an .exr, separated by commas: " + joined(layerNames()))
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--debug-view", raw.debugView,
                 "show this instead of the picture: " + joined(namedDebugViews()))
      ->capture_default_str();
  app.add_option(
         "--tree-level", o.output.treeLevel,
         "draw the boxes of this level of the bounding-volume hierarchy over a .png or .jpg; 0 is the root")
      ->check(wholeNumber(0, int(kMaxBvhDepth)));
  app.add_option("--exposure", o.output.exposure, "exposure in stops (EV), for .png and .jpg")
      ->capture_default_str();
  app.add_option("--tone-map", raw.toneMap,
                 "tone curve of .png and .jpg: linear, reinhard, aces, agx, neutral")
      ->capture_default_str();
}

void switchStages(const std::vector<std::string>& on, const std::vector<std::string>& off, StageSet& stages) {
  for (const std::string& name : on) stages.set(size_t(stageNamed("--enable", name)));
  for (const std::string& name : off) stages.reset(size_t(stageNamed("--disable", name)));
}

StageSet stagesOf(const RawRender& raw) {
  StageSet stages = stagesUpTo(choose<Stage>("--stage", raw.stage, stageNames(true)));
  switchStages(raw.fileEnable, raw.fileDisable, stages);
  if (choose<int>("--fresnel", raw.fresnel, std::vector<std::string>{"exact", "schlick"}) == 1) {
    stages.set(size_t(Stage::Schlick));
  }
  if (choose<int>("--energy-compensation", raw.compensation, std::vector<std::string>{"on", "off"}) == 1) {
    stages.reset(size_t(Stage::EnergyCompensation));
  }
  if (choose<int>("--sampler", raw.sampler, std::vector<std::string>{"sobol", "random"}) == 1) {
    stages.reset(size_t(Stage::Sobol));
  }
  if (choose<int>("--light-sampling", raw.lightSampling, std::vector<std::string>{"nee", "bsdf"}) == 1) {
    stages.reset(size_t(Stage::LightSampling));
  }
  switchStages(raw.enable, raw.disable, stages);
  return stages;
}

/// Throws UsageError where the numbers of samples contradict each other.
void settleSamples(const RawRender& raw, RenderOptions& o) {
  const bool adaptive = isAdaptive(o);
  if (raw.spp) o.sampling.spp = *raw.spp;
  if (adaptive && !raw.spp) o.sampling.spp = kMostSamples;
  // Two halves of two: one sample says nothing of its error.
  if (adaptive && o.sampling.sampleOffset > 0)
    throw UsageError("--sample-offset: adaptive pictures (--noise, --time) are no parts of a render");
  if (adaptive && o.sampling.spp < 4) throw UsageError("--spp: --noise and --time need at least 4");
  if (int64_t(o.sampling.sampleOffset) + o.sampling.spp > kMostSamples && !adaptive)
    throw UsageError("--sample-offset: with --spp it goes beyond sample " + std::to_string(kMostSamples));
}

}  // namespace

RenderOptions finishRender(const RawRender& raw) {
  RenderOptions o = raw.options;
  o.scene = raw.scene;
  o.output.file = raw.output;
  chooseStandardOutput(raw, o);
  if (!raw.output.empty() && !isWritableImageName(o.output.file)) {
    throw UsageError("--output: '" + raw.output + "' ends in none of .png, .jpg, .exr, .hdr, .pfm");
  }
  finishCamera(raw.camera, o);
  o.stages = stagesOf(raw);
  o.sampling.bounces = parseBounces(raw.bounces);
  finishSurroundings(raw, o);
  if (!raw.region.empty()) o.camera.region = regionOf(raw.region);
  o.light.selection = choose<LightSelection>("--light-selection", raw.lightSelection, kLightSelectionNames);
  o.light.reuse = choose<LightReuse>("--light-reuse", raw.lightReuse, kLightReuseNames);
  o.light.caustics = choose<Caustics>("--caustics", raw.caustics, kCausticsNames);
  o.camera.pixelFilter = choose<PixelFilter>("--pixel-filter", raw.pixelFilter, kPixelFilterNames);
  o.output.toneMap = choose<ToneMap>("--tone-map", raw.toneMap, toneMapNames());
  o.device.traversal = choose<TraversalMethod>("--traversal", raw.traversal, kTraversalNames);
  o.device.instancing = choose<Instancing>("--instancing", raw.instancing, kInstancingNames);
  o.device.backend = choose<Backend>("--rendering-backend", raw.backend, kBackendNames);
  o.device.bufferReads = choose<BufferReads>("--buffer-reads", raw.reads, kBufferReadsNames);
  o.device.dispatch = choose<Dispatch>("--dispatch", raw.dispatch, kDispatchNames);
  o.device.vectorWidth = choose<VectorWidth>("--vector-width", raw.vectorWidth, kVectorWidthNames);
  o.device.schedule = choose<Schedule>("--schedule", raw.schedule, kScheduleNames);
  o.output.statsFile = raw.statsFile;
  o.device.shaderFolder = raw.shaderFolder;
  chooseLayers(raw.aov, o);
  checkCaustics(o);
  if (!raw.aov.empty() && !raw.anyOutput && formatOfName(o.output.file) != ImageFormat::OpenExr) {
    throw UsageError("--aov: only .exr files hold more layers");
  }
  if (o.output.treeLevel && !raw.output.empty() && !isDisplayFormat(o.output.file))
    throw UsageError("--tree-level: boxes are drawn over a .png or .jpg only");
  o.output.progress = choose<ProgressForm>("--progress", raw.progress, kProgressNames);
  o.output.denoise = choose<Denoise>("--denoise", raw.denoise, kDenoiseNames);
  o.output.oidnLibrary = raw.oidnLibrary;
  o.output.debugView = debugViewNamed(raw.debugView);
  if (o.output.debugView == DebugView::Visits) o.stages.set(size_t(Stage::BvhHeatmap));
  settleSamples(raw, o);
  checkLightReuse(o);
  checkFinite(o);
  return o;
}

void addRenderOptions(CLI::App& app, RawRender& raw) {
  RenderOptions& o = raw.options;
  addCameraOptions(app, raw.camera);
  addStageOptions(app, raw);
  addSampleOptions(app, raw);
  addPathOptions(app, raw);
  addOldSpellings(app, raw);
  addSurroundingsOptions(app, raw);
  addPictureOptions(app, raw);
  addTracingOptions(app, raw);
  addSelectionOptions(app, o.selection);
  addInputOptions(app, o.limits);
  app.add_option("--stats", raw.statsFile,
                 "write statistics to this JSON file; '-' writes them to standard output, and nothing else "
                 "goes there")
      ->type_name("FILE");
  app.add_option("--shader-folder", raw.shaderFolder,
                 "read the shaders from this folder instead of the built-in ones")
      ->type_name("FOLDER");
  app.add_flag("--quiet", o.output.quiet, "print errors only; benchmarks still print their tables");
  app.add_flag("--verbose", o.output.verbose,
               "print the choices that the program makes, and times and sizes");
}

void addDenoiseOption(CLI::App& app, RawRender& raw) {
  app.add_option("--denoise", raw.denoise,
                 "filter that removes noise from the finished picture: " + joined(kDenoiseNames) +
                     "; auto uses oidn if it is installed, otherwise variance; an .exr keeps the noisy "
                     "colours as noisy.R, noisy.G, noisy.B")
      ->capture_default_str();
  app.add_option("--oidn-library", raw.oidnLibrary,
                 "library file of Open Image Denoise 2.x; by default the file that FRAGTRACE_OIDN_LIBRARY "
                 "names, otherwise the library installed by the system or by pip (pyoidn)")
      ->type_name("FILE");
}

}  // namespace fragtrace
