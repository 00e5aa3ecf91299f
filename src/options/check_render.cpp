// SPDX-License-Identifier: MIT
#include "options/check_render.h"

#include <algorithm>
#include <array>
#include <optional>

#include <glm/gtx/component_wise.hpp>

#include "base/errors.h"
#include "image/files/video_format.h"
#include "image/format.h"
#include "image/image.h"
#include "options/option_row.h"
#include "options/option_text.h"
#include "options/parse_render.h"

namespace fragtrace {

namespace {

using Options = RenderOptions;

/// Is said where the option is given and the condition holds.
struct VainRow {
  const char* option;
  bool (*isVain)(const Options&);
  const char* why;
};

/// Returns true if a file is written whose name ends so.
bool writes(const Options& o, std::initializer_list<ImageFormat> formats) {
  const auto format = o.output.file.empty() ? std::nullopt : formatOfName(o.output.file);
  return format && std::ranges::find(formats, *format) != formats.end();
}

bool isLinear(const Options& o) {
  return writes(o, {ImageFormat::OpenExr, ImageFormat::Hdr, ImageFormat::Pfm});
}

bool hasNoAlpha(const Options& o) {
  if (writes(o, {ImageFormat::Hdr, ImageFormat::Pfm})) return true;
  return holdsDisplay(o.output.file) && !holdsDisplayAlpha(o.output.file);
}

bool isVideo(const Options& o) { return videoFormatOf(o.output.file) != nullptr; }

bool hasNoSky(const Options& o) { return !o.light.sky.on; }

constexpr const char* kNoSky = "there is no --sky";

constexpr VainRow kRows[] = {
    {"--fps",
     [](const Options& o) {
       // The options of a frame have its time instead of --frames.
       const bool isFrame = o.selection.animationTime.has_value();
       return !o.output.sequence.frames && !isFrame && !isVideo(o) && o.camera.shutter <= 0.0;
     },
     "goes with --frames, --shutter, or with a video"},
    {"--background-blur", [](const Options& o) { return o.light.hdriFile.empty() && !o.light.sky.on; },
     "there is no --hdri-file and no --sky to blur"},
    {"--sun-elevation", hasNoSky, kNoSky},
    {"--sun-azimuth", hasNoSky, kNoSky},
    {"--sun-time", hasNoSky, kNoSky},
    {"--sky-turbidity", hasNoSky, kNoSky},
    {"--ground-albedo", hasNoSky, kNoSky},
    {"--fog-density", [](const Options& o) { return !has(o.stages, Stage::Gi); }, "only stage gi has it"},
    {"--no-background", hasNoAlpha,
     "a file of this format has no alpha, so the background is black; .png, .exr and .mov have it"},
    {"--background-color", [](const Options& o) { return !o.light.background; }, "--no-background hides it"},
    {"--background-color", [](const Options& o) { return glm::compMax(*o.light.backgroundColor) > 1.0f; },
     "values above 1 are brighter than white; divide values from 0 to 255 by 255"},
    {"--transparent-glass", [](const Options& o) { return o.light.background && !o.light.backgroundColor; },
     "goes with --no-background or --background-color: glass shows the environment else"},
    {"--turn", [](const Options& o) { return o.output.sequence.turntable == 0; }, "goes with --turntable"},
    {"--alpha", [](const Options& o) { return o.light.background || !holdsDisplayAlpha(o.output.file); },
     "changes a .png with --no-background only"},
    {"--no-dither",
     [](const Options& o) {
       return isLinear(o) || (writes(o, {ImageFormat::Png}) && o.output.encoding.pngBits == 16);
     },
     "changes .png and .jpg of 8 bits only"},
    {"--exposure", isLinear, "changes .png and .jpg only; this file holds linear radiance"},
    {"--ocio-view", isLinear, "changes .png and .jpg only; this file holds linear radiance"},
    {"--tone-map", [](const Options& o) { return o.output.ocio.isAsked(); }, "--ocio-view takes its place"},
    {"--tone-map", isLinear, "changes .png and .jpg only; this file holds linear radiance"},
    {"--output",
     [](const Options& o) {
       return !isSequence(o) && o.output.file.filename().string().find('#') != std::string::npos;
     },
     "# stands for a number or name only with --frames, --turntable or --material-variant all"},
};

}  // namespace

std::vector<std::string> vainOptions(const RenderOptions& options) {
  std::vector<std::string> sentences;
  for (const VainRow& row : kRows) {
    if (!rowOf(row.option).isDefault(options) && row.isVain(options))
      sentences.push_back(std::string(row.option) + ": " + row.why);
  }
  return sentences;
}

namespace {

/// The options that the samples depend on.
RenderOptions sampledPart(const RenderOptions& options) {
  RenderOptions part = withoutEffects(
      options, {Effect::Report, Effect::Method, Effect::Layers, Effect::Count, Effect::Display});
  // The heat map shows the way through the tree.
  if (options.output.debugView == DebugView::Visits) part.device.traversal = options.device.traversal;
  return part;
}

/// The options that the limit of many samples depends on.
RenderOptions shownPart(const RenderOptions& options) {
  return withoutEffects(sampledPart(options), {Effect::Noise});
}

}  // namespace

bool showSame(const RenderOptions& a, const RenderOptions& b) { return shownPart(a) == shownPart(b); }

bool drawSameSamples(const RenderOptions& a, const RenderOptions& b) {
  return sampledPart(a) == sampledPart(b);
}

std::string whyWithoutNoise(const RenderOptions& options) {
  if (!has(options.stages, Stage::Gi)) return "stages before gi have no noise but at edges";
  if (options.output.debugView != DebugView::None) return "a debug view shows what was drawn";
  return "";
}

// Options that depend on others.

namespace {

void switchStages(const std::vector<std::string>& on, const std::vector<std::string>& off, StageSet& stages) {
  for (const std::string& name : on) stages.set(size_t(stageNamed("--enable", name)));
  for (const std::string& name : off) stages.reset(size_t(stageNamed("--disable", name)));
}

StageSet stagesOf(const RawRender& raw) {
  StageSet stages = stagesUpTo(choose<Stage>("--stage", raw.stage, stageNames(true)));
  switchStages(raw.fileEnable, raw.fileDisable, stages);
  switchStages(raw.enable, raw.disable, stages);
  return stages;
}

struct QualityGoal {
  double noise = 0.0;
  int mostSamples = 0;
};

/// By Quality. A draft has the samples that a picture of that kind needs at least; the variance filter takes
/// most of what noise is left.
constexpr std::array<QualityGoal, 4> kGoals{{{}, {0.2, 16}, {0.1, 512}, {0.03, 4096}}};

/// Options that say how a picture is sampled or filtered.
constexpr std::initializer_list<const char*> kOwnQuality{
    "--quality", "--spp",           "--noise",      "--time",       "--denoise",
    "--region",  "--sample-offset", "--debug-view", "--count-work", "--tree-level"};

/// Returns true if the picture is for the eye, and no option says how it is sampled or filtered.
bool hasGoodQuality(const RawRender& raw, const RenderOptions& o) {
  const bool isOwn =
      std::ranges::any_of(kOwnQuality, [&](const char* name) { return raw.given.contains(name); });
  const bool isForTheEye = holdsDisplay(o.output.file) && has(o.stages, Stage::Gi);
  return raw.hasQuality && isForTheEye && !isOwn && o.light.reuse != LightReuse::Spatial;
}

/// Settles --shop: it says what no other option of the same subject has said.
void settleShop(const RawRender& raw, RenderOptions& o) {
  if (!raw.shop) return;
  const auto none = [&](std::initializer_list<const char*> names) {
    return std::ranges::none_of(names, [&](const char* name) { return raw.given.contains(name); });
  };
  if (none({"--hdri-file", "--sky", "--default-light", "--no-default-light"})) o.light.studio = true;
  if (none({"--background-color", "--no-background", "--background-blur"}))
    o.light.backgroundColor = glm::vec3(1.0f);
  const bool isInAir = none({"--fog-density", "--volume"}) && o.output.lightGroups.empty();
  if (isInAir && none({"--shadow-catcher", "--ground"}) && o.light.caustics != Caustics::On)
    o.light.shadowCatcher = true;
  const bool isFramed = !isRectilinear(o.camera.overrides.type.value_or(CameraType::Perspective)) ||
                        !none({"--fill", "--camera", "--camera-index", "--camera-position",
                               "--camera-parallel-scale", "--lens-shift"});
  if (!isFramed) o.camera.overrides.fill = 0.85;
  if (none({"--alpha"}) && !o.light.background && holdsDisplayAlpha(o.output.file))
    o.output.alpha = AlphaOf::Display;
  if (raw.hasQuality && none(kOwnQuality) && o.light.reuse != LightReuse::Spatial)
    o.sampling.quality = Quality::Good;
  o.light.transparentGlass = true;
}

/// Settles --quality: what other options say stays as they say it. Returns the largest number of samples, or
/// none.
std::optional<int> settleQuality(const RawRender& raw, RenderOptions& o) {
  if (hasGoodQuality(raw, o)) o.sampling.quality = Quality::Good;
  if (o.sampling.quality == Quality::None) return raw.spp;
  const QualityGoal& goal = kGoals[size_t(o.sampling.quality)];
  if (!isAdaptive(o)) o.sampling.noise = goal.noise;
  if (!raw.given.contains("--denoise")) o.output.denoise = Denoise::Variance;
  return raw.spp.value_or(goal.mostSamples);
}

/// The samples that were asked for, or those that the end of the render needs.
int samplesOf(const RenderOptions& options, std::optional<int> asked) {
  const SamplingOptions& o = options.sampling;
  const bool adaptive = isAdaptive(options);
  const int spp = asked.value_or(adaptive ? kMostSamples : o.spp);
  // The least is two halves of two samples, since one sample says nothing of its error.
  if (adaptive && o.sampleOffset > 0)
    throw UsageError("--sample-offset: adaptive pictures (--noise, --time) are no parts of a render");
  if (adaptive && spp < 4) throw UsageError("--spp: --noise and --time need at least 4");
  if (int64_t(o.sampleOffset) + spp > kMostSamples && !adaptive)
    throw UsageError("--sample-offset: with --spp it goes beyond sample " + std::to_string(kMostSamples));
  return spp;
}

/// Settles --output -, which writes the picture to standard output, and --format of a file with any name.
void chooseFormat(OutputOptions& o) {
  if (o.file != "-") {
    if (o.format.empty() || o.file.empty()) return;
    if (o.format.starts_with("rgb")) throw UsageError("--format: " + o.format + " needs --output -");
    if (o.sequence.frames || o.sequence.turntable > 0 || o.checkpointSeconds > 0.0 || o.resume)
      throw UsageError(
          "--format: of a file with any name goes neither with --frames or --turntable, nor "
          "with --checkpoint or --resume");
    o.place = o.file;
    o.file += "." + o.format;
    return;
  }
  const auto refuse = [](const std::string& why) { throw UsageError("--output -: " + why); };
  if (o.format.empty()) refuse("needs --format, one of " + joined(rowOf("--format").examples));
  if (o.checkpointSeconds > 0.0 || o.resume) refuse("--checkpoint and --resume need a file");
  if (o.statsFile == "-") refuse("standard output takes the picture or the statistics (--stats -), not both");
  o.toStandardOutput = true;
  o.file = "standard output." + o.format;
}

/// The light of groups adds up where it is one sum over all lights.
void checkLightGroups(const RenderOptions& o) {
  if (o.output.lightGroups.empty()) return;
  const std::string light = "--aov light:" + o.output.lightGroups.front() + ": ";
  if (!has(o.stages, Stage::Gi)) throw UsageError(light + "only stage gi has it");
  const auto refuse = [&](bool given, const char* option, const char* why) {
    if (given) throw UsageError(light + "not with " + option + ", " + why);
  };
  refuse(o.light.shadowCatcher, "--shadow-catcher", "whose shadows are a share of all light");
  refuse(o.light.reuse != LightReuse::None, "--light-reuse", "which chooses light samples by their light");
  refuse(o.output.debugView != DebugView::None, "--debug-view", "which shows no light");
}

void checkOutput(const RenderOptions& o, bool anyOutput) {
  const OutputOptions& out = o.output;
  const bool isVideo = videoFormatOf(out.file) != nullptr;
  if (isVideo && !isSequence(o) && !anyOutput)
    throw UsageError("--output: '" + out.file.string() +
                     "' is a video; `render` makes one with --turntable 96 or --frames 0:95 (`info` says "
                     "which frames an animation has)");
  if (!out.file.empty() && !out.toStandardOutput && !isVideo && !isWritableImageName(out.file))
    throw UsageError("--output: '" + out.file.string() +
                     "' ends in none of .png, .jpg, .exr, .hdr, .pfm, nor, for a sequence, in .mp4, .webm, "
                     ".gif, .mov");
  const auto part = std::ranges::find_if(out.aovs, isLightPart);
  if (part != out.aovs.end() && !has(o.stages, Stage::Gi))
    throw UsageError("--aov " + std::string(rowOf(*part).name) + ": only stage gi has it");
  checkLightGroups(o);
  const bool hasLayers = !out.aovs.empty() || !out.lightGroups.empty() || out.aovSamples || out.aovVariance;
  if (hasLayers && !anyOutput && formatOfName(out.file) != ImageFormat::OpenExr)
    throw UsageError("--aov: only .exr files hold more layers");
  if (out.countWork && isAdaptive(o))
    throw UsageError("--count-work: draws the samples of --spp, not those of --noise and --time");
  if (out.treeLevel && !out.file.empty() && !holdsDisplay(out.file))
    throw UsageError("--tree-level: boxes are drawn over a .png, .jpg or video only");
}

void checkLens(const LensOptions& lens) {
  if (lens.blades == 1 || lens.blades == 2) throw UsageError("--aperture-blades: neither 0 nor 3 or more");
  if (!lens.fStop && lens.focusDistance) throw UsageError("--focus-distance: goes with --f-stop");
  if (!lens.fStop && lens.blades > 0) throw UsageError("--aperture-blades: goes with --f-stop");
}

/// Refuses ways to draw that know one moment alone.
void checkShutter(const RenderOptions& o) {
  if (o.camera.shutter <= 0.0) return;
  if (!isSequence(o) && !o.selection.animationTime)
    throw UsageError("--shutter: goes with --frames, --turntable or --animation-time");
  const auto refuse = [](bool given, const char* option, const char* why) {
    if (given) throw UsageError(std::string("--shutter: not with ") + option + ", " + why);
  };
  refuse(o.light.reuse == LightReuse::Spatial, "--light-reuse spatial",
         "whose pixels take light of other moments");
  refuse(o.light.caustics == Caustics::On, "--caustics on", "whose light paths know one moment");
  if (o.output.sequence.turntable > 0)
    return refuse(o.output.sequence.turn == Turn::Object, "--turn object", "whose light would have to turn");
  const char* const noTree = "which has no tree for each moment";
  refuse(o.device.traversal == TraversalMethod::Iterative, "--traversal iterative", noTree);
  refuse(o.device.traversal == TraversalMethod::Literals, "--traversal literals", noTree);
}

/// Panoramas and fisheyes lack some of what other cameras have.
void checkCamera(const RenderOptions& o) {
  const CameraOverrides& asked = o.camera.overrides;
  if (!asked.type) return;
  const CameraType type = *asked.type;
  const std::string a = std::string(kCameraTypeNames[size_t(type)]);
  const auto refuse = [&](bool given, const char* option, const char* whose) {
    if (given) throw UsageError(std::string(option) + ": is of " + whose + ", not of --camera-type " + a);
  };
  const bool hasAngle = type == CameraType::Perspective || type == CameraType::Fisheye;
  refuse(asked.viewAngleDegrees && !hasAngle, "--camera-view-angle", "perspective and fisheye cameras");
  refuse(asked.parallelScale && type != CameraType::Orthographic, "--camera-parallel-scale",
         "orthographic cameras");
  refuse(o.camera.lens.fStop && type != CameraType::Perspective, "--f-stop", "perspective cameras");
  if (isRectilinear(type)) return;
  const char* const others = "perspective and orthographic cameras";
  refuse(asked.lensShift.has_value(), "--lens-shift", others);
  refuse(asked.fit, "--fit", others);
  refuse(asked.fitShadow, "--fit-shadow", others);
  refuse(!asked.fitTo.empty(), "--fit-to", others);
  refuse(asked.fill.has_value(), "--fill", others);
  refuse(o.output.treeLevel.has_value(), "--tree-level", others);
  refuse(asked.orbit && asked.orbit->zoom != 1.0 && type == CameraType::Panorama,
         "--camera-orbit with a zoom", "other cameras");
}

void checkFog(const RenderOptions& o) {
  for (const char* name : {"--fog-color", "--fog-anisotropy", "--fog-height", "--fog-distance"}) {
    if (o.fog.density <= 0.0 && !rowOf(name).isDefault(o))
      throw UsageError(std::string(name) + ": goes with --fog-density");
  }
  if (o.fog.density > 0.0 && o.light.shadowCatcher)
    throw UsageError(
        "--fog-density: cannot be combined with --shadow-catcher, whose plane stands in clear air");
}

void checkVolume(const RenderOptions& o) {
  if (!o.volume.file.empty() && o.light.shadowCatcher)
    throw UsageError("--volume: cannot be combined with --shadow-catcher, whose plane stands in clear air");
}

void checkGround(const RenderOptions& o) {
  if (o.light.ground && o.light.shadowCatcher)
    throw UsageError("--ground: there is --shadow-catcher, too, whose plane is not seen");
}

void checkStudio(const LightOptions& o) {
  if (o.studio && !o.hdriFile.empty()) throw UsageError("--studio: there is an --hdri-file, too");
  if (o.studio && o.backgroundBlur > 0.0)
    throw UsageError("--background-blur: the backdrop of --studio has nothing to blur");
}

void checkSky(const RenderOptions& o) {
  const SkyOptions& sky = o.light.sky;
  if (sky.on && !o.light.hdriFile.empty()) throw UsageError("--sky: there is an --hdri-file, too");
  if (sky.on && o.light.studio) throw UsageError("--sky: there is --studio, too");
  if (!sky.time.empty() && !sky.place)
    throw UsageError("--sun-time: goes with --sun-place LAT,LON, from where the sun is seen");
  if (sky.place && sky.time.empty()) throw UsageError("--sun-place: goes with --sun-time");
  for (const char* name : {"--sun-elevation", "--sun-azimuth"}) {
    if (!sky.time.empty() && !rowOf(name).isDefault(o))
      throw UsageError(std::string(name) + ": --sun-time says where the sun is");
  }
}

/// Refuses --caustics on with options that light paths do not support; auto then uses camera paths alone.
void checkLightPaths(const RenderOptions& o) {
  if (o.light.caustics != Caustics::On) return;
  if (o.sampling.clampIndirect > 0.0)
    throw UsageError("--caustics on: light paths cannot be clamped (--clamp-indirect)");
  if (o.light.shadowCatcher)
    throw UsageError("--caustics on: a shadow catcher shows no caustics (--shadow-catcher)");
  if (o.camera.overrides.type == CameraType::Panorama && o.camera.pixelFilter != PixelFilter::Box)
    throw UsageError("--caustics on: light paths of a panorama need --pixel-filter box");
  if (std::ranges::any_of(o.output.aovs, isLightPart))
    throw UsageError("--caustics on: emission, diffuse and specular (--aov) would not add up to the picture");
}

/// Refuses options next to spatial reuse. Pixels take light samples of others in the same pass of the whole
/// picture, so their errors are alike.
void checkReuse(const RenderOptions& o) {
  if (o.light.reuse != LightReuse::Spatial) return;
  const std::string refused = "--light-reuse spatial: not with ";
  if (o.camera.region) throw UsageError(refused + "--region: pixels take light from others");
  if (isAdaptive(o)) throw UsageError(refused + "--noise, --time: all pixels need as many samples");
  if (o.output.denoise != Denoise::None)
    throw UsageError(refused + "--denoise: a filter takes what pixels share for the picture");
  if (std::ranges::any_of(o.output.aovs, isLightPart))
    throw UsageError(refused + "emission, diffuse, specular (--aov): they would not add up to the picture");
}

bool isNumbered(const std::filesystem::path& file) {
  return file.filename().string().find('#') != std::string::npos;
}

/// Checks that names of files have a place for the variant. Throws UsageError.
void checkVariants(const OutputOptions& o) {
  for (const auto& [name, file] : {std::pair("--output", &o.file), std::pair("--stats", &o.statsFile)}) {
    if (!file->empty() && !isNumbered(*file))
      throw UsageError("--material-variant all: the name of " + std::string(name) +
                       " needs # where the name of the variant goes");
  }
}

}  // namespace

void checkView(const OutputOptions& o) {
  for (const auto& [option, name] : {std::pair("--ocio-config", &o.ocio.config),
                                     {"--ocio-display", &o.ocio.display},
                                     {"--ocio-look", &o.ocio.look},
                                     {"--ocio-input", &o.ocio.input}}) {
    if (!o.ocio.isAsked() && !name->empty())
      throw UsageError(std::string(option) + ": goes with --ocio-view");
  }
}

RenderOptions finishRender(const RawRender& raw) {
  RenderOptions o = raw.options;
  chooseFormat(o.output);
  o.stages = stagesOf(raw);
  if (raw.noDefaultLight) o.light.defaultLight = DefaultLight::None;
  settleShop(raw, o);
  if (raw.given.contains("--studio-look")) o.light.studio = true;
  const std::optional<int> most = settleQuality(raw, o);
  o.sampling.spp = samplesOf(o, most);
  checkLens(o.camera.lens);
  checkCamera(o);
  if (raw.given.contains("--focal-length") &&
      o.camera.overrides.type.value_or(CameraType::Perspective) != CameraType::Perspective)
    throw UsageError("--focal-length: is of perspective cameras");
  checkShutter(o);
  checkStudio(o.light);
  checkGround(o);
  checkSky(o);
  checkFog(o);
  checkVolume(o);
  checkOutput(o, raw.anyOutput);
  checkView(o.output);
  if (o.output.ocio.isAsked() && pageOf(o))
    throw UsageError(
        "--ocio-view: not with --background-color, whose colour no view may change (--no-background)");
  checkLightPaths(o);
  checkReuse(o);
  return o;
}

void checkEncoding(const Encoding& encoding, const std::filesystem::path& output) {
  const auto format = formatOfName(output);
  if (encoding.half && format != ImageFormat::OpenExr)
    throw UsageError("--half: only .exr files hold 16-bit floats");
  if (encoding.pngBits != Encoding().pngBits && format != ImageFormat::Png)
    throw UsageError("--png-depth: '" + output.string() + "' is no .png");
}

namespace {

/// Returns why the pictures of a sequence cannot go where they are to go; empty: they can.
std::string whyNotTo(const RenderOptions& options) {
  const OutputOptions& out = options.output;
  const VideoFormat* const video = videoFormatOf(out.file);
  if (out.toStandardOutput && !pixelFormOf(out.file))
    return "--output - takes one picture of this format; --format rgb24 or rgba64 writes all of them, one "
           "after the other";
  if (video == nullptr && !out.toStandardOutput) {
    const bool isNamed = isNumbered(out.file);
    return isNamed ? "" : "the name of --output needs #### where the number of the picture goes";
  }
  if (out.sequence.keep)
    return "--continue: goes with numbered pictures (#### in the name of a .png); what is one file is drawn "
           "as a whole";
  const auto isOdd = [](const glm::ivec2& size) { return size.x % 2 != 0 || size.y % 2 != 0; };
  if (video == nullptr || !video->evenSize) return "";
  const std::string even = ": width and height of a " + std::string(video->extension) +
                           " are even (.webm, .mov and .gif may be odd)";
  if (options.camera.region) return isOdd(options.camera.region->size) ? "--region" + even : "";
  if (options.camera.resolution && isOdd(*options.camera.resolution)) return "--resolution" + even;
  return "";
}

}  // namespace

void checkSequence(const RenderOptions& options) {
  const SequenceOptions& sequence = options.output.sequence;
  const bool allVariants = options.selection.materialVariant == kAllVariants;
  if (!isSequence(options)) {
    if (allVariants) checkVariants(options.output);
    if (sequence.keep) throw UsageError("--continue: goes with --frames or --turntable");
    return;
  }
  const bool isTurntable = sequence.turntable > 0;
  const auto refuse = [&](const std::string& why) {
    throw UsageError(std::string(isTurntable ? "--turntable" : "--frames") + ": " + why);
  };
  if (isTurntable && sequence.frames && sequence.frames->last >= sequence.turntable)
    throw UsageError("--frames: --turntable " + std::to_string(sequence.turntable) + " has pictures 0 to " +
                     std::to_string(sequence.turntable - 1));
  if (allVariants) refuse("goes with one variant, not with --material-variant all");
  if (const std::string reason = whyNotTo(options); !reason.empty()) refuse(reason);
  if (!options.output.statsFile.empty() && !isNumbered(options.output.statsFile))
    refuse("the name of --stats needs #### where the number of the picture goes");
  if (options.selection.animationTime && !isTurntable) refuse("--animation-time is of a single picture");
  if (options.output.checkpointSeconds > 0.0 || options.output.resume)
    refuse("--checkpoint and --resume are of a single picture; --continue is of numbered pictures");
  if (options.device.traversal == TraversalMethod::Literals)
    refuse("--traversal literals would compile a shader for each picture");
}

}  // namespace fragtrace
