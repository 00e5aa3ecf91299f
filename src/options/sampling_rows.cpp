// SPDX-License-Identifier: MIT
#include <algorithm>

#include "options/option_row.h"
#include "options/row_makers.h"
#include "options/stage_names.h"

namespace fragtrace {

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
          "last alone goes on: 1 to 8, or 0: 4 where it pays to choose among many lamps by place, else 1",
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

}  // namespace fragtrace
