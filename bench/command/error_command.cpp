// SPDX-License-Identifier: MIT
// `fragtrace bench error`: how far pictures are from the reference, against the samples and the seconds
// spent.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors.h"
#include "base/timeline.h"
#include "bench/command/commands.h"
#include "bench/command/configurations.h"
#include "bench/command/results.h"
#include "bench/report/error_report.h"
#include "image/channels.h"
#include "image/compare/difference.h"
#include "image/compare/flip.h"
#include "image/display/tone_map.h"
#include "options/numbers.h"
#include "options/option_text.h"
#include "render/adaptive.h"
#include "session/picture/denoising.h"
#include "session/picture/draw_samples.h"
#include "session/say.h"
#include "session/tracer.h"

namespace fragtrace {

namespace {

constexpr const char* kDefaultSamples = "256";
constexpr int kReferenceFactor = 64;       // samples of a reference over the most that is measured
constexpr uint32_t kReferenceSeed = 7919;  // apart from those of the repetitions
constexpr int kAdaptiveSteps = 6;          // goals, each half of the last

/// The options as parsed, and values that follow from them.
struct ErrorOptions {
  std::string scene;
  RawConfigurations raw;
  std::vector<BenchConfiguration> configurations;
  std::filesystem::path reference;  ///< empty: made by the first configuration
  int repetitions = 3;
  double goal = 1e-3;
  ResultFiles files;
};

void declareError(CLI::App& app, ErrorOptions& o) {
  app.add_option("file", o.scene, "scene: a .gltf or .glb file")->type_name("FILE")->required();
  app.add_option(
         "--reference", o.reference,
         "reference picture; by default one rendered with the first configuration and 64 times the samples")
      ->type_name("FILE");
  app.add_option("--repetitions", o.repetitions, "pictures per step, each with its own seed")
      ->check(wholeNumber(1, 1000))
      ->capture_default_str();
  app.add_option("--goal", o.goal, "relative MSE at which times are compared")
      ->check(realNumber(1e-12, 1e3))
      ->capture_default_str();
  addJsonOption(app, o.files, "write all measurements to this JSON file");
  addConfigurationOptions(app, o.raw, "default,random,baseline, or default alone with --config");
  app.get_option("--spp")->description(std::string("samples per pixel of the last step, by default ") +
                                       kDefaultSamples);
  addOptions(app, OptionGroup::Filter, o.raw.shared);
  app.get_option("--denoise")
      ->description(
          joined(kDenoiseNames) +
          "; also measures each picture after filtering; its time then includes rendering and filtering");
}

/// Throws UsageError.
void settleError(const CLI::App& app, ErrorOptions& o) {
  o.configurations =
      configurationsOf(o.raw, app, o.scene, {"default", "random", "baseline"}, kDefaultSamples);
  const OutputOptions& shared = o.raw.shared.options.output;
  for (BenchConfiguration& c : o.configurations) {
    c.render.output.denoise = shared.denoise;
    c.render.output.oidnLibrary = shared.oidnLibrary;
    if (shared.denoise == Denoise::None) continue;
    const std::string reason = whyNotDenoised(c.render);
    if (!reason.empty()) throw UsageError("configuration '" + c.name + "': --denoise: " + reason);
  }
  if (!std::isfinite(o.goal)) throw UsageError("--goal: not a finite number");
  const auto isAdaptive = [](const BenchConfiguration& c) { return c.adaptive(); };
  if (o.reference.empty() && std::ranges::all_of(o.configurations, isAdaptive))
    throw UsageError("--reference: needed where every configuration is adaptive");
}

/// One configuration on the device.
struct Contender {
  BenchConfiguration configuration;  ///< with --denoise settled
  LoadedScene loaded;
  Tracer tracer;
  ErrorCurve curve;
  std::optional<PictureFilter> filter;
  ErrorCurve filtered;  ///< the curve with --denoise
};

/// A picture that has been drawn and may still be filtered.
struct Draw {
  Drawing drawing;
  int layerSamples = 0;
  double seconds = 0.0;  ///< seconds that the draw has taken so far
};

struct Judge {
  Image reference;
  Image display;
  const RenderOptions& options;

  ErrorSample judge(const Image& picture, double samples, double seconds) const {
    const Difference difference = compare(picture, reference);
    const Image shown = toDisplay(picture, options.output.exposure.value_or(0.0), options.output.toneMap);
    return {samples, seconds, difference.mse, difference.relmse, flipError(shown, display).mean};
  }
};

/// Error after 1, 2, 4, ... samples of one sequence.
std::vector<ErrorSample> measureSteps(Contender& c, const View& view, const Judge& judge) {
  Film film(c.loaded.size);
  std::vector<ErrorSample> steps;
  RenderTimes times;
  const int most = c.configuration.render.sampling.spp;
  for (int done = 0, next = 1; done < most; next *= 2) {
    next = std::min(next, most);
    c.tracer.renderer->addSamples(film, view, done, next, times);
    done = next;
    steps.push_back(judge.judge(imageOf(film.read(), {}), done, times.renderMs / 1000.0));
  }
  return steps;
}

/// The picture filtered, as `render --denoise` does it. `compileMs` grows by what was built on the way.
ErrorSample finish(Contender& c, const View& view, const Judge& judge, const Draw& draw, double& compileMs) {
  const RenderOptions& options = c.configuration.render;
  Image picture = pictureOf(draw.drawing, options);
  double seconds = draw.seconds;
  for (const ShaderVariant& variant : c.tracer.aovs) {
    const int samples = samplesOfLayer(options, variant.aov, draw.layerSamples);
    const LayerDraw layer =
        drawLayer({picture.width, picture.height}, *c.tracer.renderer, variant, view, samples);
    appendChannels(picture, layer.image, layer.image.channels);
    seconds += 0.001 * layer.times.renderMs;
    compileMs += layer.compileMs;
  }
  const double start = steadyMilliseconds();
  const Image denoised = c.filter->apply(picture).value();
  seconds += 0.001 * (steadyMilliseconds() - start);
  const double pixels = double(picture.width) * picture.height;
  return judge.judge(denoised, double(totalsOf(draw.drawing.pixels).samples) / pixels, seconds);
}

/// Draws one whole picture with `samples` samples. The time includes reading the film, so the picture is not
/// a part of a sequence.
Draw drawWhole(Contender& c, const View& view, int samples, double& compileMs) {
  RenderOptions options = c.configuration.render;
  options.sampling.spp = samples;
  SampledFilm sampled{Film(c.loaded.size), {}, 0};
  compileMs += c.tracer.renderer->compile(c.tracer.variant, sampled.film, view);
  Draw draw;
  draw.layerSamples = samples;
  RenderTimes times;
  const double start = steadyMilliseconds();
  drawAllSamples(*c.tracer.renderer, sampled, options, view, times, Renderer::toTheEnd, draw.drawing);
  draw.seconds = 0.001 * (steadyMilliseconds() - start);
  return draw;
}

/// Draws and filters once, so that all that the driver compiles at a first picture is compiled.
double warmUpFilter(Contender& c, const View& view, const Judge& judge) {
  double compileMs = c.filter->compileMs;
  const Draw draw = drawWhole(c, view, 1, compileMs);
  const double seconds = finish(c, view, judge, draw, compileMs).seconds;
  const double again = finish(c, view, judge, draw, compileMs).seconds;
  return compileMs + 1000.0 * std::max(seconds - again, 0.0);
}

/// Filtered pictures of 1, 2, 4, ... samples.
std::vector<ErrorSample> measureFiltered(Contender& c, const View& view, const Judge& judge) {
  std::vector<ErrorSample> steps;
  const int most = c.configuration.render.sampling.spp;
  for (int done = 0, next = 1; done < most; next *= 2) {
    done = std::min(next, most);
    double compileMs = 0.0;  // had been done
    const Draw draw = drawWhole(c, view, done, compileMs);
    steps.push_back(finish(c, view, judge, draw, compileMs));
  }
  return steps;
}

/// Error of adaptive pictures whose goals come down to the one asked for: the noise, else the time. Filtered
/// ones are the same.
std::vector<ErrorSample> measureAdaptive(Contender& c, const View& view, const Judge& judge,
                                         std::vector<ErrorSample>& filtered) {
  std::vector<ErrorSample> steps;
  for (int i = kAdaptiveSteps - 1; i >= 0; --i) {
    const RenderOptions& options = c.configuration.render;
    RenderTimes times;
    const double part = options.sampling.noise > 0.0 ? 1.0 : std::exp2(-i);
    const AdaptiveGoal goal{options.sampling.noise * std::exp2(i), options.sampling.seconds * part,
                            options.sampling.spp, options.light.shadowCatcher};
    AdaptiveRun run(c.loaded.size);
    AdaptivePicture picture = renderAdaptively(*c.tracer.renderer, run, view, goal, times);
    const double pixels = double(c.loaded.size.x) * c.loaded.size.y;
    const double seconds = times.renderMs / 1000.0;
    const FilmTotals totals = totalsOf(picture.pixels);
    steps.push_back(judge.judge(imageOf(picture.pixels, {}), double(totals.samples) / pixels, seconds));
    if (!c.filter) continue;
    const Draw draw{{std::move(picture.pixels), std::move(picture.variance), {}},
                    int(std::max(1u, totals.fewestSamples)),
                    seconds};
    double compileMs = 0.0;  // had been done
    filtered.push_back(finish(c, view, judge, draw, compileMs));
    Film film(c.loaded.size);
    c.tracer.renderer->compile(c.tracer.variant, film, view);  // after the layers'
  }
  return steps;
}

Image makeReference(Contender& c, int samples, bool quiet) {
  View view = c.loaded.view;
  view.seed += kReferenceSeed;
  Film film(c.loaded.size);
  c.tracer.renderer->compile(c.tracer.variant, film, view);
  ProgressBar bar("reference, " + std::to_string(samples) + " samples", quiet);
  RenderTimes times;
  c.tracer.renderer->addSamples(film, view, 0, samples, times, [&](double fraction) {
    bar.show(fraction);
    return true;
  });
  bar.clear();
  return imageOf(film.read(), {});
}

std::string sizeText(glm::ivec2 size) { return std::to_string(size.x) + " x " + std::to_string(size.y); }

Image readGivenReference(const ErrorOptions& options, glm::ivec2 size) {
  const std::string name = options.reference.string();
  Image reference = readImage(options.reference);
  if (glm::ivec2(reference.width, reference.height) != size)
    throw InputError(name + ": is of " + sizeText({reference.width, reference.height}) +
                     " pixels, those to be measured are of " + sizeText(size));
  if (!findColorChannels(reference)) throw InputError(name + ": has no colour");
  return reference;
}

/// Throws UsageError if a picture has another size than the first: all are compared with one reference.
void checkSize(const ErrorOptions& options, glm::ivec2 first, const BenchConfiguration& configuration,
               glm::ivec2 own) {
  if (own == first) return;
  throw UsageError("configuration '" + configuration.name + "': its picture is of " + sizeText(own) +
                   " pixels, that of '" + options.configurations.front().name + "' is of " + sizeText(first));
}

/// A configuration that is loaded, with its filter.
Contender makeContender(const BenchConfiguration& configuration, const Context& context, bool quiet) {
  Statistics stats;
  BenchConfiguration settled = configuration;
  const std::optional<OidnLibrary> oidn = openDenoiser(settled.render);
  RenderOptions wanted = settled.render;
  wanted.output.quiet = wanted.output.quiet || quiet;
  wanted = withGuides(wanted);
  LoadedScene loaded = loadScene(wanted, stats);
  Tracer tracer = makeTracer(context, loaded, wanted, stats);
  Contender made{settled, std::move(loaded), std::move(tracer), {}, {}, {}};
  made.curve.name = configuration.name;
  made.curve.options = configuration.text;
  made.curve.variant = stats.variant;
  if (wanted.output.denoise != Denoise::None) {
    wanted.output.quiet = true;  // no bar within that of the benchmark
    made.filter = makeFilter(wanted, oidn);
    made.filtered.name = made.curve.name;
    made.filtered.filter = made.filter->name;
  }
  return made;
}

/// One repetition: a curve, and one of the filtered pictures if there is a filter.
void repeat(Contender& c, const Judge& judge, int repetition) {
  View view = c.loaded.view;
  view.seed += uint32_t(repetition);
  Film film(c.loaded.size);
  const bool first = repetition == 0;  // later ones are in the program cache
  const double compileMs = c.tracer.renderer->compile(c.tracer.variant, film, view);
  if (first) c.curve.compileMs = c.tracer.programMs + compileMs;
  RenderTimes warmUp;
  c.tracer.renderer->addSamples(film, view, 0, 1, warmUp);
  std::vector<ErrorSample> filtered;
  if (c.configuration.adaptive()) {
    if (c.filter && first) {
      c.filtered.compileMs = warmUpFilter(c, view, judge);
      c.tracer.renderer->compile(c.tracer.variant, film, view);  // after the layers'
    }
    c.curve.repetitions.push_back(measureAdaptive(c, view, judge, filtered));
  } else {
    c.curve.repetitions.push_back(measureSteps(c, view, judge));
    if (c.filter && first) c.filtered.compileMs = warmUpFilter(c, view, judge);
    if (c.filter) filtered = measureFiltered(c, view, judge);
  }
  if (c.filter) c.filtered.repetitions.push_back(std::move(filtered));
}

/// Moves the curves into the report.
void takeCurves(std::vector<Contender>& contenders, const ErrorOptions& options, int referenceSamples,
                ErrorReport& report) {
  constexpr double kFarFewer = 8.0;
  for (Contender& c : contenders) {
    for (const std::vector<ErrorSample>& steps : c.curve.repetitions) {
      const bool near = options.reference.empty() && steps.back().samples * kFarFewer > referenceSamples;
      c.curve.nearReference = c.curve.nearReference || near;
    }
    c.filtered.nearReference = c.curve.nearReference;
    report.curves.push_back(std::move(c.curve));
    if (c.filter) report.curves.push_back(std::move(c.filtered));
  }
}

ErrorReport measure(const ErrorOptions& options, const Context& context) {
  const RenderOptions& first = options.configurations.front().render;
  std::vector<Contender> contenders;
  int most = 1;
  for (const BenchConfiguration& configuration : options.configurations) {
    const bool saidBefore = !contenders.empty();  // each warning is printed once
    contenders.push_back(makeContender(configuration, context, saidBefore));
    if (!configuration.adaptive()) most = std::max(most, configuration.render.sampling.spp);
    checkResultFiles(options.files, inputsOf(contenders.back().loaded.scene));
    checkSize(options, contenders.front().loaded.size, configuration, contenders.back().loaded.size);
  }
  const glm::ivec2 size = contenders.front().loaded.size;
  const int referenceSamples = int(std::min<int64_t>(int64_t(most) * kReferenceFactor, 1 << 29));
  ErrorReport report;
  report.scene = first.scene.filename().string();
  report.width = size.x;
  report.height = size.y;
  report.renderer = context.renderer;
  report.goal = options.goal;
  report.reference = options.reference.empty()
                         ? std::to_string(referenceSamples) + " samples of '" +
                               options.configurations.front().name + "' with another seed"
                         : options.reference.filename().string();
  const Image reference = options.reference.empty()
                              ? makeReference(contenders.front(), referenceSamples, first.output.quiet)
                              : readGivenReference(options, size);
  const Judge judge{reference,
                    toDisplay(reference, first.output.exposure.value_or(0.0), first.output.toneMap), first};

  // Step: repetitions outermost, so that a machine that slows down does so for all.
  ProgressBar bar("measuring", first.output.quiet);
  double done = 0.0;
  for (int r = 0; r < options.repetitions; ++r) {
    for (Contender& c : contenders) {
      repeat(c, judge, r);
      done += 1.0;
      bar.show(done / (double(contenders.size()) * options.repetitions));
    }
  }
  bar.clear();
  takeCurves(contenders, options, referenceSamples, report);
  return report;
}

int runError(const ErrorOptions& options) {
  std::vector<std::filesystem::path> inputs = inputsOf(options.configurations);
  inputs.push_back(options.reference);
  checkResultFiles(options.files, inputs);
  const auto context = contextOf(options.configurations.front().render);
  const ErrorReport report = measure(options, *context);
  writeResults(options.files, {errorTable(report), errorJson(report)});
  return 0;
}

}  // namespace

RunCommand addBenchError(CLI::App& app) { return commandOf(app, declareError, settleError, runError); }

}  // namespace fragtrace
