// SPDX-License-Identifier: MIT

#include <algorithm>
#include <charconv>

#include "base/errors.h"
#include "bvh/bvh.h"
#include "image/channels.h"
#include "options/option_row.h"
#include "options/option_text.h"
#include "options/row_makers.h"

namespace fragtrace {

namespace {

constexpr std::array<std::string_view, 7> kFormatNames{"png", "jpg", "exr", "hdr", "pfm", "rgb24", "rgba64"};

/// The layers of first hits come first, those of the film follow.
std::vector<std::string> layerNames() {
  std::vector<std::string> names;
  for (const AovRow& row : kAovRows) {
    if (!row.name.empty()) names.emplace_back(row.name);
  }
  names.insert(names.end(), {"samples", "variance"});
  return names;
}

constexpr std::string_view kGroup = "light:";

void chooseLightGroup(const std::string& name, OutputOptions& o) {
  if (name.empty()) throw UsageError("--aov light: the name of a light follows, such as light:environment");
  for (const std::string& other : o.lightGroups) {
    if (other == name) return;
    if (lightLayer(other) != lightLayer(name)) continue;
    std::string text = "--aov light:" + name;
    text.append(": its layer has the name of that of light:")
        .append(other)
        .append(", ")
        .append(lightLayer(name));
    throw UsageError(text);
  }
  o.lightGroups.push_back(name);
}

void chooseLayers(const std::vector<std::string>& names, OutputOptions& o) {
  const std::vector<std::string> known = layerNames();
  for (const std::string& name : names) {
    if (name.starts_with(kGroup)) {
      chooseLightGroup(name.substr(kGroup.size()), o);
      continue;
    }
    const auto index = choose<size_t>("--aov", name, known);
    if (name == "samples") {
      o.aovSamples = true;
    } else if (name == "variance") {
      o.aovVariance = true;
    } else if (const auto aov = Aov(index + 1); std::ranges::find(o.aovs, aov) == o.aovs.end()) {
      o.aovs.push_back(aov);
      // A filter needs the layers `samples` and `variance`, too.
      if (aov == Aov::Guides) o.aovSamples = o.aovVariance = true;
    }
  }
}

OptionRow layersRow() {
  OptionRow row{.name = "--aov",
                .help = "extra layers to write into an .exr, separated by commas: " + joined(layerNames()) +
                        "; light:NAME is the light of the lights and emissive materials of that name, of the "
                        "environment, or of the rest",
                .traits = {.effect = Effect::Layers, .renewal = Renewal::Program},
                .choices = layerNames(),
                .open = true,
                .examples = layerNames()};
  row.examples.insert(row.examples.begin(), "light:rest");
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option_function<std::vector<std::string>>(
           r.name, [&raw](const std::vector<std::string>& names) { chooseLayers(names, raw.options.output); },
           r.help)
        ->delimiter(',')
        ->allow_extra_args(false);
  };
  row.isDefault = [](const RenderOptions& o) {
    return o.output.aovs.empty() && o.output.lightGroups.empty() && !o.output.aovSamples &&
           !o.output.aovVariance;
  };
  row.words = [](const RenderOptions& o) {
    std::string names;
    const auto add = [&](std::string_view name) { names += (names.empty() ? "" : ",") + std::string(name); };
    for (const Aov aov : o.output.aovs) add(rowOf(aov).name);
    if (o.output.aovSamples) add("samples");
    if (o.output.aovVariance) add("variance");
    for (const std::string& group : o.output.lightGroups) add(std::string(kGroup) + group);
    return std::vector{names};
  };
  row.copy = [](RenderOptions& to, const RenderOptions& from) {
    to.output.aovs = from.output.aovs;
    to.output.lightGroups = from.output.lightGroups;
    to.output.aovSamples = from.output.aovSamples;
    to.output.aovVariance = from.output.aovVariance;
  };
  return row;
}

std::vector<std::string_view> debugViewNames() {
  std::vector<std::string_view> names;
  names.reserve(std::size(kDebugViewRows));
  for (const DebugViewRow& row : kDebugViewRows) names.push_back(row.name);
  return names;
}

OptionRow pngDepthRow() {
  OptionRow row =
      memberRow("--png-depth", "bits per channel of a .png: 8, 16", FRAGTRACE_MEMBER(output.encoding.pngBits),
                {.effect = Effect::Display, .group = OptionGroup::Encoding});
  row.examples = row.choices = {"8", "16"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, [known = r.examples](RenderOptions& o, const std::string& text) {
      o.output.encoding.pngBits = choose<int>("--png-depth", text, known) == 0 ? 8 : 16;
    });
    app.get_option(r.name)->default_str(std::to_string(raw.options.output.encoding.pngBits));
  };
  row.words = [](const RenderOptions& o) { return std::vector{std::to_string(o.output.encoding.pngBits)}; };
  return row;
}

constexpr int kMostFrame = 9'999'999;

/// A:B or A:B:STEP.
FrameRange framesOf(const std::string& text) {
  std::vector<int> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    int number = -1;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc() || number < 0 || number > kMostFrame) break;
    numbers.push_back(number);
    if (rest == end) {
      at = end;
      break;
    }
    if (*rest != ':') break;
    at = rest + 1;
  }
  const bool whole = at == end && (numbers.size() == 2 || numbers.size() == 3);
  if (!whole || numbers[1] < numbers[0] || (numbers.size() == 3 && numbers[2] < 1))
    throw UsageError("--frames: '" + text + "' is no A:B or A:B:STEP, such as 0:59, with 0 <= A <= B <= " +
                     std::to_string(kMostFrame));
  return {numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : 1};
}

OptionRow framesRow(const OptionTraits& traits) {
  OptionRow row = memberRow(
      "--frames",
      "A:B or A:B:STEP: render pictures A to B of the animation, or of --turntable (B included), each to "
      "--output with its number instead of ####, or all to a video",
      FRAGTRACE_MEMBER(output.sequence.frames), traits);
  row.examples = {"0:59", "10:9999999:3"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw,
            [](RenderOptions& o, const std::string& text) { o.output.sequence.frames = framesOf(text); });
  };
  row.words = [](const RenderOptions& o) {
    const FrameRange& range = *o.output.sequence.frames;
    return std::vector{std::to_string(range.first) + ":" + std::to_string(range.last) + ":" +
                       std::to_string(range.step)};
  };
  return row;
}

OptionRow rateRow(const OptionTraits& traits) {
  constexpr NumberRange<double> kRates{0.001, 1e6};
  OptionRow row = number<double>(
      "--fps",
      "frames per second: picture k of --frames shows the animation at k / FPS seconds; a video shows so "
      "many, or, with a STEP, FPS / STEP; a number, or a fraction such as 30000/1001; 23.976, 29.97, 47.952, "
      "59.94 and 119.88 mean the exact rates of broadcast, such as 24000/1001",
      FRAGTRACE_MEMBER(output.sequence.fps), kRates, traits);
  row.examples.push_back("30000/1001");
  row.add = [=](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option(r.name, raw.options.output.sequence.fps, r.help)
        ->transform(frameRate(kRates.least, kRates.most))
        ->capture_default_str();
  };
  return row;
}

OptionRow formatRow() {
  OptionRow row = memberRow(
      "--format",
      "format of the picture, whatever the name of --output; of '-', which is standard output: " +
          joined(kFormatNames) +
          "; rgb24 and rgba64, for '-' alone, are pixels, 8 bits a channel or 16 (little-endian, straight "
          "alpha), as a .png shows them (sRGB); there, --frames and --turntable write all pictures so, one "
          "after the other",
      FRAGTRACE_MEMBER(output.format),
      {.effect = Effect::Report, .copied = false, .group = OptionGroup::Output});
  row.choices.assign(kFormatNames.begin(), kFormatNames.end());
  row.examples = row.choices;
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, [](RenderOptions& o, const std::string& text) {
      choose<int>("--format", text, kFormatNames);
      o.output.format = text;
    });
  };
  row.words = [](const RenderOptions& o) { return std::vector{o.output.format}; };
  return row;
}

}  // namespace

std::vector<OptionRow> outputRows() {  // NOLINT(readability-function-size): a table
  constexpr OptionTraits kDisplay{.effect = Effect::Display};
  constexpr OptionTraits kSaid{.effect = Effect::Report, .copied = false, .kept = true};
  constexpr OptionTraits kOne{.effect = Effect::Report, .copied = false, .group = OptionGroup::Output};
  constexpr OptionTraits kNumbered{.effect = Effect::View, .copied = false, .group = OptionGroup::Sequence};
  const OptionTraits shutter{.effect = Effect::Picture,
                             .renewal = Renewal::Scene,
                             .attribute = "shutter",
                             .copied = false,
                             .group = OptionGroup::Sequence};
  constexpr OptionTraits kEncoded{.effect = Effect::Display, .group = OptionGroup::Encoding};
  OptionTraits progress = kSaid;
  progress.group = OptionGroup::Output;
  OptionTraits quiet = kSaid;
  quiet.renewal = Renewal::Program;
  OptionTraits filter = kDisplay;
  filter.group = OptionGroup::Filter;
  return {
      layersRow(),
      choice("--debug-view", "show this instead of the picture", FRAGTRACE_MEMBER(output.debugView),
             debugViewNames(), {.effect = Effect::Picture, .renewal = Renewal::Program}),
      limit<int>(
          "--tree-level",
          "draw the boxes of this level of the bounding-volume hierarchy over a .png or .jpg; 0 is the root",
          FRAGTRACE_MEMBER(output.treeLevel), {0, int(kMaxBvhDepth)}, kDisplay),
      limit<double>(
          "--exposure",
          "exposure in stops (EV), for .png and .jpg; by default 0, unless the scene's own light is more "
          "than 16 times too bright or 64 times too dark for middle grey",
          FRAGTRACE_MEMBER(output.exposure), {-100.0, 100.0}, kDisplay),
      choice("--tone-map", "tone curve of .png and .jpg", FRAGTRACE_MEMBER(output.toneMap), toneMapNames(),
             kDisplay),
      word("--stats",
           "write statistics to this JSON file; '-' writes them to standard output, and nothing else goes "
           "there",
           FRAGTRACE_MEMBER(output.statsFile), kSaid, "FILE"),
      word(
          "--trace-file",
          "write a timeline of all threads and of the process for pictures to this JSON file, from the start "
          "of the process to its end; https://ui.perfetto.dev shows it",
          FRAGTRACE_MEMBER(output.traceFile),
          {.effect = Effect::Report, .copied = false, .kept = true, .group = OptionGroup::Output}, "FILE"),
      flag("--count-work",
           "count the work of the samples, into the file of --stats: rays by kind, steps through the tree, "
           "what they test, evaluate and read; the same each time; times are left out, since counting takes "
           "long",
           FRAGTRACE_MEMBER(output.countWork),
           {.effect = Effect::Method,
            .renewal = Renewal::Program,
            .copied = false,
            .group = OptionGroup::Output}),
      flag("--quiet", "print errors only; benchmarks still print their tables",
           FRAGTRACE_MEMBER(output.quiet), quiet),
      flag("--verbose", "print the choices that the program makes, and times and sizes",
           FRAGTRACE_MEMBER(output.verbose), kSaid),
      flag("--half",
           "store the colours, normals and roughness of an .exr as 16-bit floats, for about half the file "
           "size; all other layers keep 32 bits; values beyond 65504 are clamped",
           FRAGTRACE_MEMBER(output.encoding.half), kEncoded),
      word("--ocio-view",
           "show a .png or .jpg by this view of an OpenColorIO configuration, instead of --tone-map",
           FRAGTRACE_MEMBER(output.ocio.view), kEncoded),
      word("--ocio-config", "the configuration; by default the one that $OCIO names",
           FRAGTRACE_MEMBER(output.ocio.config), kEncoded, "FILE"),
      word("--ocio-display", "the configuration's display that has the view; by default its first",
           FRAGTRACE_MEMBER(output.ocio.display), kEncoded),
      word("--ocio-look", "a look of the configuration to apply before the view, such as \"AgX - Punchy\"",
           FRAGTRACE_MEMBER(output.ocio.look), kEncoded),
      word("--ocio-input",
           "the configuration's name of linear Rec. 709, the colours of a picture; by default one of the "
           "usual names",
           FRAGTRACE_MEMBER(output.ocio.input), kEncoded),
      pngDepthRow(),
      offFlag(
          "--no-dither",
          "round the values of a .png or .jpg of 8 bits without the noise of one step that keeps gradients "
          "free of bands",
          FRAGTRACE_MEMBER(output.dither), kEncoded),
      choice("--alpha",
             "for which programs a .png is: those that blend light (linear), or those that blend sRGB "
             "values, as browsers do (display); then shadows look right over white, and are weaker over dark "
             "pages; auto is display with --shadow-catcher or --transparent-glass, and else linear",
             FRAGTRACE_MEMBER(output.alpha), kAlphaNames, kEncoded),
      limit<double>(
          "--checkpoint",
          "write the state of the render to OUTPUT.checkpoint every this many seconds, and when the render "
          "is interrupted; the file is deleted when the picture is finished",
          FRAGTRACE_MEMBER(output.checkpointSeconds), {0.1, 1e7}, kOne),
      flag("--resume",
           "continue from OUTPUT.checkpoint; the result is the same picture; if there is no checkpoint, "
           "start from the beginning, or do nothing if the picture is finished",
           FRAGTRACE_MEMBER(output.resume), kOne),
      formatRow(),
      choice("--progress",
             "how progress is reported on stderr: as a bar or lines (auto), as one JSON object per line, "
             "messages included (json), or not at all (none)",
             FRAGTRACE_MEMBER(output.progress), kProgressNames, progress),
      framesRow(kNumbered),
      rateRow(kNumbered),
      limit<int>(
          "--turntable",
          "render N pictures, numbers 0 to N - 1, from evenly spaced directions around the focal point, each "
          "to --output with its number instead of ####, or all to a video; --frames A:B chooses some",
          FRAGTRACE_MEMBER(output.sequence.turntable), {1, kMostFrame}, kNumbered),
      choice(
          "--turn",
          "what turns in a --turntable: the camera about the scene, or the scene before camera, environment "
          "and lamps, which stay",
          FRAGTRACE_MEMBER(output.sequence.turn), kTurnNames, kNumbered),
      limit<double>("--shutter",
                    "blur what moves while the shutter is open, DEGREES of 360 of the time from frame to "
                    "frame, around the moment of each: of an animation (--frames; --animation-time with "
                    "--fps), whatever its STEP, or a turn (--turntable); films often have 180",
                    FRAGTRACE_MEMBER(camera.shutter), {0.0, 360.0}, shutter),
      flag("--continue",
           "with --frames or --turntable: skip pictures that are there already, in the size of --resolution "
           "or --region; other settings are not compared",
           FRAGTRACE_MEMBER(output.sequence.keep), kNumbered),
      choice("--denoise",
             "filter that removes noise from the finished picture: {}; auto uses oidn if it is installed, "
             "otherwise variance; an .exr keeps the noisy colours as noisy.R, noisy.G, noisy.B",
             FRAGTRACE_MEMBER(output.denoise), kDenoiseNames, filter),
      word("--oidn-library",
           "library file of Open Image Denoise 2.x; by default the file that FRAGTRACE_OIDN_LIBRARY names, "
           "otherwise the library installed by the system or by pip (pyoidn)",
           FRAGTRACE_MEMBER(output.oidnLibrary), filter, "FILE"),
  };
}

namespace {

Stage lastStage(const StageSet& stages) {
  Stage last = Stage::Flat;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative && has(stages, row.stage)) last = row.stage;
  }
  return last;
}

/// The stages and switches that are on, or off, but not with --stage alone.
std::string switchedStages(const StageSet& stages, bool on) {
  const StageSet usual = stagesUpTo(lastStage(stages));
  std::string names;
  for (const StageRow& row : stageRows()) {
    if (has(stages, row.stage) == on && has(usual, row.stage) != on)
      names += (names.empty() ? "" : ",") + std::string(row.name);
  }
  return names;
}

/// Stages are set as a whole by finishRender(), and have their effects in stageRows().
OptionRow stageRow() {
  OptionRow row{.name = "--stage",
                .help = "last stage: " + joined(stageNames(true)) + "; each stage includes those before it",
                .choices = stageNames(true),
                .examples = stageNames(true)};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option(r.name, raw.stage, r.help)->capture_default_str();
  };
  row.isDefault = [](const RenderOptions& o) { return lastStage(o.stages) == Stage::Gi; };
  row.words = [](const RenderOptions& o) {
    const auto* found = std::ranges::find(stageRows(), lastStage(o.stages), &StageRow::stage).base();
    return std::vector<std::string>{found->name};
  };
  row.copy = [](RenderOptions&, const RenderOptions&) {};
  return row;
}

OptionRow switchRow(const char* name, std::string help, bool on, std::vector<std::string> RawRender::*list) {
  OptionRow row{.name = name, .help = std::move(help), .choices = stageNames(false)};
  for (const StageRow& stage : stageRows()) {
    if (has(stagesUpTo(Stage::Gi), stage.stage) != on) row.examples.emplace_back(stage.name);
  }
  row.add = [list](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option(r.name, raw.*list, r.help)->delimiter(',')->allow_extra_args(false);
  };
  row.isDefault = [on](const RenderOptions& o) { return switchedStages(o.stages, on).empty(); };
  row.words = [on](const RenderOptions& o) { return std::vector{switchedStages(o.stages, on)}; };
  row.copy = [](RenderOptions&, const RenderOptions&) {};
  return row;
}

/// Has no default in RawRender, since --noise, --time and the viewer have defaults of their own. So copied
/// commands always say it.
OptionRow sppRow() {
  OptionRow row =
      memberRow("--spp",
                "samples (camera paths) per pixel, 64 by default; with --noise or --time: at most this many, "
                "by default without limit",
                FRAGTRACE_MEMBER(sampling.spp), {.effect = Effect::Count, .kept = true});
  row.examples = {"1", std::to_string(kMostSamples)};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option(r.name, raw.spp, r.help)->check(wholeNumber(1, kMostSamples));
  };
  row.isDefault = [](const RenderOptions&) { return false; };
  row.words = [](const RenderOptions& o) { return std::vector{std::to_string(o.sampling.spp)}; };
  return row;
}

int parseBounces(const std::string& text) {
  if (text == "unlimited") return kUnlimitedBounces;
  int value = -1;
  if (!CLI::detail::lexical_cast(text, value) || value < 0)
    throw UsageError("--bounces: '" + text + "' is neither a number from 0 on nor 'unlimited'");
  return value;
}

OptionRow bouncesRow() {
  OptionRow row =
      memberRow("--bounces",
                "maximum number of indirect bounces of a path, not counting smooth glass, or 'unlimited'; 0 "
                "is direct light alone",
                FRAGTRACE_MEMBER(sampling.bounces), {.effect = Effect::Picture, .attribute = "bounces"});
  row.choices = {"unlimited"};
  row.open = true;
  row.examples = {"0", "unlimited"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw,
            [](RenderOptions& o, const std::string& text) { o.sampling.bounces = parseBounces(text); });
    app.get_option(r.name)->default_str(std::to_string(raw.options.sampling.bounces));
  };
  row.words = [](const RenderOptions& o) {
    const int bounces = o.sampling.bounces;
    return std::vector<std::string>{bounces == kUnlimitedBounces ? "unlimited" : std::to_string(bounces)};
  };
  row.value = [](const RenderOptions& o) { return AttributeValue(o.sampling.bounces); };
  return row;
}

}  // namespace

std::vector<OptionRow> samplingRows() {
  constexpr OptionTraits kEnd{.effect = Effect::Count, .copied = false, .kept = true};
  constexpr OptionTraits kNoise{.effect = Effect::Noise};
  return {
      stageRow(),
      switchRow(
          "--enable",
          "additional stages and switches to turn on, separated by commas: " + joined(stageNames(false)),
          true, &RawRender::enable),
      switchRow("--disable", "stages and switches to turn off, separated by commas: the names of --enable",
                false, &RawRender::disable),
      sppRow(),
      limit<double>(
          "--noise",
          "render until 95 % of the pixels that can be noisy have an estimated relative error below this, "
          "for example 0.01",
          FRAGTRACE_MEMBER(sampling.noise), {1e-5, 1.0}, kEnd),
      choice(
          "--quality",
          "goal of noise, largest number of samples, and the variance filter, which the options for each "
          "change: "
          "{}; by default good for a .png, .jpg or film for which none of --spp, --noise, --time, --denoise, "
          "--sample-offset, --region, --light-reuse spatial and --debug-view is given, else none",
          FRAGTRACE_MEMBER(sampling.quality), kQualityNames, kEnd),
      limit<double>("--time", "render for this many seconds, and place the samples where they help most",
                    FRAGTRACE_MEMBER(sampling.seconds), {0.01, 1e7}, kEnd),
      number<int>(
          "--sample-offset",
          "index of the first sample in the sample sequence of this seed; for rendering in parts (see merge)",
          FRAGTRACE_MEMBER(sampling.sampleOffset), {0, kMostSamples - 1}, kNoise),
      number<uint32_t>("--seed", "seed of the sample points, 0 to 4294967295",
                       FRAGTRACE_MEMBER(sampling.seed), {0, std::numeric_limits<uint32_t>::max()}, kNoise),
      bouncesRow(),
      number<int>(
          "--camera-rays",
          "camera rays of each sample, which all bring the light that they see and one light sample; the "
          "last alone continues: 1 to 8, or 0: 4 where it pays to choose among many lamps by place, else 1",
          FRAGTRACE_MEMBER(sampling.cameraRays), {0, kMostCameraRays},
          {.effect = Effect::Noise, .renewal = Renewal::Program, .attribute = "camera_rays"}),
      number<int>("--rr-depth", "Russian roulette may end a path from this scattering event on",
                  FRAGTRACE_MEMBER(sampling.rouletteDepth), {1, std::numeric_limits<int>::max() / 4},
                  {.effect = Effect::Noise, .attribute = "rr_depth"}),
      limit<double>(
          "--clamp-indirect",
          "maximum radiance that indirect light (two or more scattering events) adds to a sample; this "
          "removes bright dots but darkens the picture",
          FRAGTRACE_MEMBER(sampling.clampIndirect), {1e-6, 1e30},
          {.effect = Effect::Picture, .renewal = Renewal::Program, .attribute = "clamp_indirect"}),
      choice(
          "--texture-filter",
          "exact reads textures at their full resolution, so that samples alone filter them; cones takes the "
          "mean over what a pixel or a scattered ray sees of them, which has less noise, but blurs",
          FRAGTRACE_MEMBER(sampling.textureFilter), kTextureFilterNames,
          {.effect = Effect::Picture, .renewal = Renewal::Program}),
  };
}

std::vector<OptionRow> deviceRows() {
  constexpr OptionTraits kLoading{.effect = Effect::Method, .renewal = Renewal::Scene};
  constexpr OptionTraits kProgram{.effect = Effect::Method, .renewal = Renewal::Program};
  return {
      choice("--traversal", "how rays find triangles", FRAGTRACE_MEMBER(device.traversal), kTraversalNames,
             kLoading),
      choice("--instancing", "whether copies of a mesh share its triangles",
             FRAGTRACE_MEMBER(device.instancing), kInstancingNames, kLoading),
      choice("--rendering-backend", "how the OpenGL context is created", FRAGTRACE_MEMBER(device.backend),
             kBackendNames, {.effect = Effect::Method, .renewal = Renewal::Program, .kept = true}),
      word("--device",
           "draw on this device: its number in `fragtrace info --devices`, or a part of its name; by default "
           "the first that works",
           FRAGTRACE_MEMBER(device.device),
           {.effect = Effect::Method, .renewal = Renewal::Program, .kept = true}),
      choice("--buffer-reads", "how the shader reads the scene", FRAGTRACE_MEMBER(device.bufferReads),
             kBufferReadsNames, kProgram),
      choice("--texture-reads", "how the shader reads textures: as words of buffers, or from array textures",
             FRAGTRACE_MEMBER(device.textureReads), kTextureReadsNames, kLoading),
      choice("--dispatch", "which shader stage runs the tracer", FRAGTRACE_MEMBER(device.dispatch),
             kDispatchNames, kProgram),
      choice("--tune", "which kind of driver the shaders' text suits; the picture is the same",
             FRAGTRACE_MEMBER(device.tune), kTuneNames, kProgram),
      choice("--vector-width",
             "bits of the vectors that Mesa's software driver computes with; the picture is the same; 512 "
             "can be faster where the processor has AVX-512, but Mesa crashes on some scenes with it",
             FRAGTRACE_MEMBER(device.vectorWidth), kVectorWidthNames, {.effect = Effect::Method}),
      choice(
          "--schedule",
          "how paths are scheduled: each lane of the device traces one pixel at a time (megakernel), or the "
          "rays of many pixels are traced together (wavefront)",
          FRAGTRACE_MEMBER(device.schedule), kScheduleNames, kProgram),
      word("--shader-folder", "read the shaders from this folder instead of the built-in ones",
           FRAGTRACE_MEMBER(device.shaderFolder),
           {.effect = Effect::Method, .renewal = Renewal::Program, .kept = true}, "FOLDER"),
      word("--shader-text",
           "write the shader that traces the picture to this file, for reading: with its comments, and "
           "without what this scene does not need",
           FRAGTRACE_MEMBER(output.shaderText),
           {.effect = Effect::Report, .copied = false, .kept = true, .group = OptionGroup::Output}, "FILE"),
  };
}

}  // namespace fragtrace
