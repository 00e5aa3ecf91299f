// SPDX-License-Identifier: MIT
// `fragtrace bench motion`: the viewer's pictures while something moves, without a window: how many a
// second, how late, at what cost to the processor, and how far from what `render` draws.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.h"
#include "base/report.h"
#include "base/summary.h"
#include "base/text.h"
#include "bench/command/commands.h"
#include "bench/command/configurations.h"
#include "bench/command/motion_run.h"
#include "bench/command/results.h"
#include "bench/command/window_picture.h"
#include "bench/report/json.h"
#include "image/compare/difference.h"
#include "image/compare/flip.h"
#include "image/display/tone_map.h"
#include "options/library/option_facts.h"
#include "options/numbers.h"
#include "options/option_text.h"
#include "render/film/film_pixels.h"
#include "session/interrupt.h"
#include "session/say.h"
#include "session/tracer.h"

namespace fragtrace {

namespace {

constexpr std::array<std::string_view, 5> kPaths{"orbit", "dolly", "sun", "color", "roughness"};
constexpr std::array<std::string_view, 4> kModes{"filtered", "raw", "no-past", "spatial"};

struct MotionOptions {
  RawRender raw;
  RenderOptions render;
  std::string path = "orbit";
  double period = 10.0;
  double targetMs = 100.0;
  std::vector<std::string> modes{"filtered"};
  int referenceSamples = 256;
  MotionPlan plan;
  ResultFiles files;
};

void declareMotion(CLI::App& app, MotionOptions& o) {
  o.raw.options.output.denoise = Denoise::Variance;
  addOption(app, "file", o.raw)->required();
  app.add_option(
         "--path", o.path,
         "path of the camera: orbit, a turn about what it looks at; dolly, towards it and back; or a "
         "file of camera options, a line a place, as the viewer copies these; or what moves before a "
         "camera at rest: sun, the sun of --sky from 2 to 60 degrees and back; color, the base colours "
         "of all materials round the circle of hues; roughness, theirs from 0.1 to 0.9 and back")
      ->check(withChoices(kPaths, true))
      ->capture_default_str();
  app.add_option("--period", o.period, "seconds that the path takes before it begins again")
      ->check(realNumber(0.1, 1e4))
      ->capture_default_str();
  app.add_option("--interval", o.plan.intervalMs, "milliseconds from one move to the next")
      ->check(realNumber(1.0, 1e5))
      ->default_str("16.7");
  app.add_option("--target", o.targetMs,
                 "milliseconds that a picture may take before its resolution is lowered; 0: never")
      ->check(realNumber(0.0, 1e5))
      ->capture_default_str();
  app.add_option("--pictures", o.plan.pictures, "pictures that are measured")
      ->check(wholeNumber(1, 100'000))
      ->capture_default_str();
  app.add_option("--warm-up", o.plan.warmUp, "pictures before these")
      ->check(wholeNumber(1, 100'000))
      ->capture_default_str();
  app.add_option("--compare", o.plan.compared, "how many of the pictures are compared with references")
      ->check(wholeNumber(0, 1000))
      ->capture_default_str();
  app.add_option("--reference-spp", o.referenceSamples, "samples per pixel of a reference")
      ->check(wholeNumber(1, kMostSamples))
      ->capture_default_str();
  app.add_option("--modes", o.modes,
                 "what is measured in turn: filtered, as the options say; raw, without the filter; no-past, "
                 "without what the camera saw before; spatial, with light samples of neighbours")
      ->delimiter(',')
      ->check(oneOf({kModes.begin(), kModes.end()}))
      ->capture_default_str();
  app.add_flag("--wait", o.plan.view.waitsForPasses,
               "wait for the device after each step of a picture, so that each has its time");
  addJsonOption(app, o.files, "write all measurements to this JSON file");
  addOptions(app, OptionGroup::Tracing, o.raw);
  addOptions(app, OptionGroup::Filter, o.raw);
}

/// Throws UsageError, InputError.
void settleMotion(const CLI::App&, MotionOptions& o) {
  o.raw.anyOutput = true;
  o.render = finishRender(o.raw);
  if (isAdaptive(o.render)) throw UsageError("--noise and --time: a picture in motion has no end of its own");
  o.plan.size = o.render.camera.resolution.value_or(o.plan.size);
  o.render.camera.resolution = o.plan.size;
  o.plan.move = motionOf(o.path, o.period, o.render);
}

/// The viewer's options in that mode.
ViewOptions viewOptionsOf(const MotionOptions& o, const std::string& mode) {
  ViewOptions view = o.plan.view;
  view.render = o.render;
  view.render.sampling.spp = kMostSamples - o.render.sampling.sampleOffset;
  view.movingMs = o.targetMs;
  view.keepsPast = mode != "no-past";
  if (mode == "raw") view.render.output.denoise = Denoise::None;
  if (mode == "spatial") view.render.light.reuse = LightReuse::Spatial;
  return view;
}

/// Linear in light, as nothing is that a window shows.
Image enlarged(const Image& image, glm::ivec2 size) {
  Image large{size.x, size.y, image.channels, {}, {}};
  const size_t channels = image.channelCount();
  large.values.reserve(size_t(size.x) * size_t(size.y) * channels);
  const auto at = [&](int x, int y, size_t c) {
    x = std::clamp(x, 0, image.width - 1);
    y = std::clamp(y, 0, image.height - 1);
    return image.values[(size_t(y) * size_t(image.width) + size_t(x)) * channels + c];
  };
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec2 place((x + 0.5) * image.width / size.x - 0.5, (y + 0.5) * image.height / size.y - 0.5);
      const glm::ivec2 corner(glm::floor(place));
      const glm::vec2 part(place - glm::dvec2(corner));
      for (size_t c = 0; c < channels; ++c) {
        const float top = std::lerp(at(corner.x, corner.y, c), at(corner.x + 1, corner.y, c), part.x);
        const float bottom =
            std::lerp(at(corner.x, corner.y + 1, c), at(corner.x + 1, corner.y + 1, c), part.x);
        large.values.push_back(std::lerp(top, bottom, part.y));
      }
    }
  }
  return large;
}

/// Draws references for the pictures that were kept: a reference is the picture that `render` draws with the
/// same options. shown() returns a kept picture as the window shows it.
class References {
 public:
  References(const MotionOptions& o) : options_(o), context_(contextOf(o.render)) {
    window_.emplace();
    film_.emplace(o.plan.size);
    load(o.render);
  }

  /// Linear, through the camera of the options; none when interrupted.
  std::optional<Image> of(const RenderOptions& options) {
    const CameraOverrides& overrides = options.camera.overrides;
    const double aspect = double(options_.plan.size.x) / options_.plan.size.y;
    if (options.light.sky != shown_.light.sky || options.selection != shown_.selection) load(options);
    const Camera camera =
        chooseCamera(loaded_.scene.cameras, options.camera.index, overrides, loaded_.scene.bounds, aspect);
    film_->clear();
    RenderTimes times;
    const bool complete =
        tracer_.renderer->addSamples(*film_, makeView(shown_, loaded_, camera), 0, options_.referenceSamples,
                                     times, [](double) { return interrupts() == 0; });
    if (!complete) return std::nullopt;
    return imageOf(film_->read(), {});
  }

  Image shown(const Image& display) const { return window_->of(display, options_.plan.size); }

 private:
  void load(const RenderOptions& options) {
    shown_ = options_.render;
    shown_.sampling.textureFilter = TextureFilter::Exact;
    shown_.light.sky = options.light.sky;
    shown_.selection = options.selection;
    shown_.output.denoise = Denoise::None;
    tracer_ = {};
    loaded_ = loadScene(shown_, stats_);
    tracer_ = makeTracer(*context_, loaded_, shown_, stats_);
    tracer_.renderer->compile(tracer_.variant, *film_, loaded_.view);
  }

  const MotionOptions& options_;
  RenderOptions shown_;  ///< the options of the loaded scene
  Statistics stats_;
  std::unique_ptr<Context> context_;
  LoadedScene loaded_;
  Tracer tracer_;
  std::optional<Film> film_;
  std::optional<WindowPicture> window_;
};

/// The mean errors of the pictures that were kept.
struct MotionError {
  double relmse = 0.0;
  double flip = 0.0;
};

struct MotionRow {
  std::string mode;
  MotionFigures figures;
  MotionError error;
};

MotionError errorOf(const std::vector<KeptPicture>& kept, References& references, const OutputOptions& output,
                    glm::ivec2 size, const std::function<void()>& step) {
  MotionError error;
  for (const KeptPicture& picture : kept) {
    const std::optional<Image> reference = references.of(picture.options);
    if (!reference) return {};
    const Image display = toDisplay(picture.image, output.exposure.value_or(0.0), output.toneMap);
    const Image wanted = toDisplay(*reference, output.exposure.value_or(0.0), output.toneMap);
    error.relmse += compare(enlarged(picture.image, size), *reference).relmse / double(kept.size());
    error.flip += flipError(references.shown(display), wanted).mean / double(kept.size());
    step();
  }
  return error;
}

Json jsonOf(const MotionRow& row, bool waited) {
  const MotionFigures& f = row.figures;
  Json json = {{"mode", row.mode},          {"pictures", f.pictures},    {"seconds", f.seconds},
               {"pixels", f.pixels},        {"trace_cpu_ms", f.cpuMs},   {"gap_ms", f.gapMs},
               {"latency_ms", f.latencyMs}, {"compared", f.kept.size()}, {"moved_bytes", f.movedBytes}};
  for (size_t pass = 0; pass < kPassNames.size(); ++pass) {
    json["passes"][kPassNames[pass]] = {{"cpu_ms", f.passes.cpu[pass]}};
    if (waited) json["passes"][kPassNames[pass]]["wall_ms"] = f.passes.wall[pass];
  }
  if (!f.kept.empty()) json.update({{"relmse", row.error.relmse}, {"flip", row.error.flip}});
  return json;
}

/// Milliseconds of a picture's steps.
std::string passTable(const std::vector<MotionRow>& rows, bool waited) {
  std::string text = formatted("\n%-9s %-8s", "mode", "ms");
  for (const char* name : kPassNames) text += formatted(" %9s", name);
  for (const MotionRow& row : rows) {
    const auto add = [&](const char* clock, const auto& times) {
      text += formatted("\n%-9s %-8s", row.mode.c_str(), clock);
      for (const double ms : times) text += formatted(" %9.3f", ms / std::max(row.figures.pictures, 1));
    };
    add("CPU", row.figures.passes.cpu);
    if (waited) add("wall", row.figures.passes.wall);
  }
  return text + "\n";
}

std::string tableOf(const std::vector<MotionRow>& rows) {
  std::string text = formatted("%-9s %8s %8s %8s %8s %8s %9s %9s %9s %8s %8s\n", "mode", "pic/s", "gap p95",
                               "late ms", "late p95", "MPix/s", "size", "CPU ms", "kB", "relMSE", "FLIP");
  for (const MotionRow& row : rows) {
    const MotionFigures& f = row.figures;
    const Summary late = summarize(f.latencyMs);
    const double each = f.pixels / std::max(f.pictures, 1);
    text += formatted("%-9s %8.2f %8.1f %8.1f %8.1f %8.3f %9.0f %9.2f %9.1f", row.mode.c_str(),
                      f.pictures / f.seconds, summarize(f.gapMs).p95, late.median, late.p95,
                      1e-6 * f.pixels / f.seconds, each, f.cpuMs / std::max(f.pictures, 1),
                      1e-3 * f.movedBytes / std::max(f.pictures, 1));
    text += f.kept.empty() ? formatted(" %8s %8s\n", "", "")
                           : formatted(" %8.4f %8.4f\n", row.error.relmse, row.error.flip);
  }
  return text +
         "pic/s: pictures a second; size: pixels of a picture; CPU: of the tracing thread, a picture; kB: "
         "moved between host and device\n";
}

int runMotionCommand(const MotionOptions& o) {
  checkResultFiles(o.files, inputsOf(o.render));
  countInterrupts();
  std::vector<MotionRow> rows;
  for (const std::string& mode : o.modes) {
    ProgressBar bar(mode, o.render.output.quiet);
    MotionPlan plan = o.plan;
    plan.view = viewOptionsOf(o, mode);
    const auto goOn = [&](double fraction) {
      bar.show(fraction);
      return interrupts() == 0;
    };
    rows.push_back({mode, runMotion(plan, goOn), {}});
    bar.clear();
    if (interrupts() > 0) break;
  }
  std::optional<References> references;
  if (o.plan.compared > 0 && interrupts() == 0) {
    references.emplace(o);
    ProgressBar bar("references", o.render.output.quiet);
    double done = 0.0;
    for (MotionRow& row : rows) {
      row.error = errorOf(row.figures.kept, *references, o.render.output, o.plan.size,
                          [&] { bar.show(++done / double(rows.size() * size_t(o.plan.compared))); });
    }
    bar.clear();
  }
  if (interrupts() > 0) {
    reportError("interrupted, nothing is written");
    return kInterruptedStatus;
  }
  const std::string scene = o.render.scene.filename().string();
  Json json = {{"schema", 1},          {"bench", "motion"},      {"scene", scene},
               {"path", o.path},       {"width", o.plan.size.x}, {"height", o.plan.size.y},
               {"rows", Json::array()}};
  for (const MotionRow& row : rows) json["rows"].push_back(jsonOf(row, o.plan.view.waitsForPasses));
  const std::string head = formatted("%s, %d x %d, %s of %g s\n\n", scene.c_str(), o.plan.size.x,
                                     o.plan.size.y, o.path.c_str(), o.period);
  writeResults(o.files, {head + tableOf(rows) + passTable(rows, o.plan.view.waitsForPasses), jsonLine(json)});
  return 0;
}

}  // namespace

RunCommand addBenchMotion(CLI::App& app) {
  return commandOf(app, declareMotion, settleMotion, runMotionCommand);
}

}  // namespace fragtrace
