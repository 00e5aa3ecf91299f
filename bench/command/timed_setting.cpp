// SPDX-License-Identifier: MIT
#include "bench/command/timed_setting.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "options/numbers.h"
#include "session/say.h"

namespace fragtrace {

namespace {

/// Far from a GPU's watchdog, and so long that what is done between draws does not count.
constexpr double kTimedDrawMs = 250.0;
/// the least number of frames may take up to this many times a round's time
constexpr double kMostOverTime = 5.0;

/// Adds samples [from, to), by draws as the timing wants them. Milliseconds go into `times`.
void drawSamples(TimedSetting& s, int from, int to, RenderTimes& times) {
  const int most = s.timing.samplesPerDraw > 0 ? s.timing.samplesPerDraw : to - from;
  for (int done = from; done < to;) {
    const int next = std::min(to, done + most);
    s.tracer.renderer->addSamples(*s.film, s.loaded->view, done, next, times);
    done = next;
  }
}

/// Compiles, draws the first frame and more until a round's time has passed, and chooses the frames of a
/// round.
void warmUp(TimedSetting& s) {
  s.report.compileMs =
      s.tracer.programMs + s.tracer.renderer->compile(s.tracer.variant, *s.film, s.loaded->view);
  RenderTimes first;
  drawSamples(s, 0, 1, first);
  s.report.firstFrameMs = first.drawMs;
  // Step: frames until a round's time has passed; the last of them tell how many a round needs.
  const double roundMs = 1000.0 * s.timing.roundSeconds;
  double frameMs = std::max(first.drawMs, 1e-6);
  constexpr int kMost = 1 << 24;
  int frames = 1;
  for (double spent = first.drawMs; spent < roundMs && frames < kMost;) {
    RenderTimes times;
    s.film->clear();
    drawSamples(s, 0, frames, times);
    frameMs = std::max(times.drawMs / frames, 1e-6);
    spent += std::max(times.renderMs, times.drawMs);
    const double missing = std::max(1.0, (roundMs - spent) / frameMs);
    frames = int(std::min({2.0 * frames, std::ceil(missing), double(kMost)}));
  }
  // Step: choose enough frames that the fixed cost of a draw weighs alike in all settings compared.
  const double affordable = kMostOverTime * roundMs / frameMs;
  const double least = std::min(double(s.timing.leastFrames), affordable);
  const double wanted = std::clamp(std::max(roundMs / frameMs, least), 1.0, double(kMost));
  s.report.frames = s.configuration.samplesGiven ? s.configuration.render.sampling.spp : int(wanted);
}

/// Draws one round on a cleared film.
void drawRound(TimedSetting& s) {
  RenderTimes times;
  s.film->clear();
  drawSamples(s, 0, s.report.frames, times);
  s.report.frameMs.push_back(times.drawMs / s.report.frames);
  s.report.wallFrameMs.push_back(times.renderMs / s.report.frames);
}

}  // namespace

void addTimingOptions(CLI::App& app, FrameTiming& timing) {
  app.add_option("--rounds,--repetitions", timing.rounds,
                 "number of timing rounds; every round measures all settings, one after another")
      ->check(wholeNumber(1, 100000))
      ->capture_default_str();
  app.add_option("--round-time", timing.roundSeconds, "seconds per round")
      ->check(realNumber(0.001, 3600.0))
      ->capture_default_str();
  app.add_option("--samples-per-draw", timing.samplesPerDraw,
                 "maximum samples per draw; with 1, each frame is drawn on its own, as in a viewer; by "
                 "default, the renderer chooses a number that takes a short time")
      ->check(wholeNumber(1, 1 << 20));
}

void checkTimed(const BenchConfiguration& configuration) {
  const std::string name = "configuration '" + configuration.name + "': ";
  if (configuration.adaptive())
    throw UsageError(name + "--noise and --time draw no frames; `bench error` measures them");
}

TimedSetting makeSetting(const Context& context, const BenchConfiguration& configuration,
                         const FrameTiming& timing) {
  Statistics stats;
  RenderOptions options = configuration.render;
  // Frames are timed without what comes before them, so the variant is that of a long render.
  if (!configuration.samplesGiven) options.sampling.spp = std::numeric_limits<int>::max();
  TimedSetting s;
  s.configuration = configuration;
  s.timing = timing;
  s.loaded = std::make_shared<LoadedScene>(loadScene(options, stats));
  s.tracer = makeTracer(context, *s.loaded, options, stats);
  s.film = std::make_unique<Film>(s.loaded->size);
  if (!context.software) s.tracer.renderer->setDrawTime(kTimedDrawMs);
  FrameSetting& r = s.report;
  r.scene = configuration.render.scene.filename().string();
  r.configuration = configuration.name;
  r.options = configuration.fullText;
  r.variant = variantName(s.tracer.variant);
  r.clock = s.tracer.renderer->clock();
  r.width = s.loaded->size.x;
  r.height = s.loaded->size.y;
  r.triangles = s.loaded->scene.triangles.size();
  r.samplesPerDraw = timing.samplesPerDraw;
  return s;
}

void measureInTurn(std::span<TimedSetting> settings, bool quiet) {
  if (settings.empty()) return;
  ProgressBar bar("measuring", quiet);
  for (TimedSetting& s : settings) warmUp(s);
  const int rounds = settings.front().timing.rounds;
  for (int r = 0; r < rounds; ++r) {
    for (TimedSetting& s : settings) drawRound(s);
    bar.show(double(r + 1) / rounds);
  }
  bar.clear();
  for (TimedSetting& s : settings) {
    const FilmTotals totals = totalsOf(s.film->read());
    s.report.raysPerPath = double(totals.rays) / double(std::max<uint64_t>(1, totals.samples));
    s.report.nonfinitePixels = totals.nonfinitePixels;
    s.report.budgetHits = totals.budgetHits;
  }
}

}  // namespace fragtrace
