// SPDX-License-Identifier: MIT
// `fragtrace bench error`: how far pictures are from the reference, against the samples and the seconds
// spent.
#include <cmath>
#include <cstdio>

#include "bench/error_report.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/setup.h"
#include "errors.h"
#include "image/channels.h"
#include "image/difference.h"
#include "image/flip.h"
#include "image/tone_map.h"
#include "render/adaptive.h"

namespace fragtrace {

namespace {

constexpr int kReferenceFactor = 64;       // samples of a reference over the most that is measured
constexpr uint32_t kReferenceSeed = 7919;  // apart from those of the repetitions
constexpr int kAdaptiveSteps = 6;          // goals, each half of the last

/// One configuration on the device.
struct Contender {
  const BenchConfiguration& configuration;
  LoadedScene loaded;
  Tracer tracer;
  ErrorCurve curve;
};

struct Judge {
  Image reference;
  Image display;
  const RenderOptions& options;

  ErrorSample judge(const Image& picture, double samples, double seconds) const {
    const Difference difference = compare(picture, reference);
    const Image shown = toDisplay(picture, options.exposure, options.toneMap);
    return {samples, seconds, difference.mse, difference.relmse, flipError(shown, display).mean};
  }
};

/// Error after 1, 2, 4, ... samples of one sequence.
std::vector<ErrorSample> measureSteps(Contender& c, const View& view, const Judge& judge) {
  Film film(c.loaded.size);
  std::vector<ErrorSample> steps;
  RenderTimes times;
  const int most = c.configuration.render.spp;
  for (int done = 0, next = 1; done < most; next *= 2) {
    next = std::min(next, most);
    c.tracer.renderer->addSamples(film, view, done, next, times);
    done = next;
    steps.push_back(judge.judge(imageOf(film.read(), {}), done, times.renderMs / 1000.0));
  }
  return steps;
}

/// Error of adaptive pictures whose goals come down to the one asked for: the noise, else the time.
std::vector<ErrorSample> measureAdaptive(Contender& c, const View& view, const Judge& judge) {
  std::vector<ErrorSample> steps;
  for (int i = kAdaptiveSteps - 1; i >= 0; --i) {
    const RenderOptions& options = c.configuration.render;
    RenderTimes times;
    const double part = options.noise > 0.0 ? 1.0 : std::exp2(-i);
    const AdaptiveGoal goal{options.noise * std::exp2(i), options.seconds * part, options.spp};
    const AdaptivePicture picture = renderAdaptively(*c.tracer.renderer, c.loaded.size, view, goal, times);
    const double pixels = double(c.loaded.size.x) * c.loaded.size.y;
    steps.push_back(judge.judge(imageOf(picture.pixels, {}),
                                double(totalsOf(picture.pixels).samples) / pixels, times.renderMs / 1000.0));
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

Image readReference(const BenchErrorOptions& options, glm::ivec2 size) {
  const std::string name = options.reference.string();
  Image reference = readImage(options.reference);
  if (glm::ivec2(reference.width, reference.height) != size)
    throw InputError(name + ": is of " + sizeText({reference.width, reference.height}) +
                     " pixels, those to be measured are of " + sizeText(size));
  if (!findColorChannels(reference)) throw InputError(name + ": has no colour");
  return reference;
}

/// All pictures are compared with one reference.
void checkSize(const BenchErrorOptions& options, glm::ivec2 first, const BenchConfiguration& configuration,
               glm::ivec2 own) {
  if (own == first) return;
  throw UsageError("configuration '" + configuration.name + "': its picture is of " + sizeText(own) +
                   " pixels, that of '" + options.configurations.front().name + "' is of " + sizeText(first));
}

std::vector<NamedOutput> outputsOf(const BenchErrorOptions& options) {
  return {{"--json", options.json}, {"--csv", options.csv}, {"--chart", options.chart}};
}

ErrorReport measure(const BenchErrorOptions& options, const Context& context) {
  const RenderOptions& first = options.configurations.front().render;
  std::vector<Contender> contenders;
  int most = 1;
  for (const BenchConfiguration& configuration : options.configurations) {
    Statistics stats;
    RenderOptions wanted = configuration.render;
    wanted.quiet = wanted.quiet || !contenders.empty();  // warnings are said once
    LoadedScene loaded = loadScene(wanted, stats);
    Tracer tracer = makeTracer(context, loaded, wanted, stats);
    contenders.push_back({configuration, std::move(loaded), std::move(tracer), {}});
    ErrorCurve& curve = contenders.back().curve;
    curve.name = configuration.name;
    curve.options = configuration.text;
    curve.variant = stats.variant;
    if (!configuration.adaptive()) most = std::max(most, wanted.spp);
    checkOutputs(outputsOf(options), inputsOf(contenders.back().loaded.scene));
    checkSize(options, contenders.front().loaded.size, configuration, contenders.back().loaded.size);
  }
  ErrorReport report;
  report.scene = first.scene.filename().string();
  report.width = contenders.front().loaded.size.x;
  report.height = contenders.front().loaded.size.y;
  report.renderer = context.renderer;
  report.goal = options.goal;
  const int referenceSamples = int(std::min<int64_t>(int64_t(most) * kReferenceFactor, 1 << 29));
  report.reference = options.reference.empty()
                         ? std::to_string(referenceSamples) + " samples of '" +
                               options.configurations.front().name + "' with another seed"
                         : options.reference.filename().string();
  const Image reference = options.reference.empty()
                              ? makeReference(contenders.front(), referenceSamples, first.quiet)
                              : readReference(options, contenders.front().loaded.size);
  const Judge judge{reference, toDisplay(reference, first.exposure, first.toneMap), first};

  // Step: repetitions outermost, so that a machine that slows down does so for all.
  ProgressBar bar("measuring", first.quiet);
  double done = 0.0;
  for (int r = 0; r < options.repetitions; ++r) {
    for (Contender& c : contenders) {
      View view = c.loaded.view;
      view.seed += uint32_t(r);
      Film film(c.loaded.size);
      const double compileMs = c.tracer.renderer->compile(c.tracer.variant, film, view);
      if (r == 0) c.curve.compileMs = c.tracer.programMs + compileMs;  // later ones are in the program cache
      RenderTimes warmUp;
      c.tracer.renderer->addSamples(film, view, 0, 1, warmUp);
      c.curve.repetitions.push_back(c.configuration.adaptive() ? measureAdaptive(c, view, judge)
                                                               : measureSteps(c, view, judge));
      done += 1.0;
      bar.show(done / (double(contenders.size()) * options.repetitions));
    }
  }
  bar.clear();
  constexpr double kFarFewer = 8.0;
  for (Contender& c : contenders) {
    for (const std::vector<ErrorSample>& steps : c.curve.repetitions)
      c.curve.nearReference = c.curve.nearReference || (options.reference.empty() &&
                                                        steps.back().samples * kFarFewer > referenceSamples);
  }
  for (Contender& c : contenders) report.curves.push_back(std::move(c.curve));
  return report;
}

}  // namespace

int runBenchError(const BenchErrorOptions& options) {
  std::vector<std::filesystem::path> inputs{options.reference};
  for (const BenchConfiguration& configuration : options.configurations) {
    for (const std::filesystem::path& input : inputsOf(configuration.render)) inputs.push_back(input);
  }
  checkOutputs(outputsOf(options), inputs);
  const auto context = makeContext(options.configurations.front().render.backend);
  const ErrorReport report = measure(options, *context);
  countInterrupts();  // what is measured is written whole
  std::fputs(errorTable(report).c_str(), stdout);
  replaceText(options.json, errorJson(report));
  replaceText(options.csv, errorCsv(report));
  replaceText(options.chart, errorChart(report));
  return 0;
}

}  // namespace fragtrace
