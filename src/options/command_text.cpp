// SPDX-License-Identifier: MIT
#include "options/command_text.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "errors.h"
#include "options/camera_options.h"
#include "options/config_file.h"
#include "options/encoding_options.h"
#include "options/option_text.h"
#include "options/view_options.h"
#include "stage/feature.h"

namespace fragtrace {

namespace {

constexpr size_t kLongestText = size_t(1) << 16;  // bytes

void append(std::string& text, const char* option, const std::string& value, bool isDefault) {
  if (!isDefault) appendOption(text, option, value);
}

/// A choice among names in the order of its values.
template <typename Names, typename Choice>
void appendChoice(std::string& text, const char* option, const Names& names, Choice choice,
                  Choice byDefault) {
  append(text, option, std::string(names[size_t(choice)]), choice == byDefault);
}

std::string stagesText(const StageSet& stages) {
  Stage last = Stage::Flat;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative && has(stages, row.stage)) last = row.stage;
  }
  std::string text;
  for (const bool on : {true, false}) {
    std::string names;
    for (const StageRow& row : stageRows()) {
      if (has(stages, row.stage) == on && has(stagesUpTo(last), row.stage) != on)
        names += (names.empty() ? "" : ",") + std::string(row.name);
    }
    append(text, on ? "--enable" : "--disable", names, names.empty());
  }
  const auto row = std::ranges::find(stageRows(), last, &StageRow::stage);
  append(text, "--stage", row->name, last == Stage::Gi);
  return text;
}

std::string layersText(const RenderOptions& o) {
  std::string names;
  const auto add = [&](std::string_view name) { names += (names.empty() ? "" : ",") + std::string(name); };
  for (const Feature feature : o.output.aovFeatures) add(rowOf(feature).name);
  if (o.output.aovSamples) add("samples");
  if (o.output.aovVariance) add("variance");
  return names;
}

void appendSampling(std::string& text, const RenderOptions& o) {
  const RenderOptions standard;
  appendOption(text, "--spp", std::to_string(o.sampling.spp));
  append(text, "--sample-offset", std::to_string(o.sampling.sampleOffset),
         o.sampling.sampleOffset == standard.sampling.sampleOffset);
  append(text, "--seed", std::to_string(o.sampling.seed), o.sampling.seed == standard.sampling.seed);
  append(text, "--bounces",
         o.sampling.bounces == kUnlimitedBounces ? "unlimited" : std::to_string(o.sampling.bounces),
         o.sampling.bounces == standard.sampling.bounces);
  append(text, "--rr-depth", std::to_string(o.sampling.rouletteDepth),
         o.sampling.rouletteDepth == standard.sampling.rouletteDepth);
  append(text, "--clamp-indirect", exactText(o.sampling.clampIndirect), o.sampling.clampIndirect <= 0.0);
  appendChoice(text, "--light-selection", kLightSelectionNames, o.light.selection, standard.light.selection);
  appendChoice(text, "--light-reuse", kLightReuseNames, o.light.reuse, standard.light.reuse);
  appendChoice(text, "--caustics", kCausticsNames, o.light.caustics, standard.light.caustics);
  appendChoice(text, "--pixel-filter", kPixelFilterNames, o.camera.pixelFilter, standard.camera.pixelFilter);
}

void appendScene(std::string& text, const RenderOptions& o) {
  const RenderOptions standard;
  const SceneSelection& s = o.selection;
  append(text, "--scene", s.scene, s.scene.empty());
  if (s.animationTime) appendOption(text, "--animation-time", exactText(*s.animationTime));
  append(text, "--animation", s.animation, s.animation.empty());
  append(text, "--material-variant", s.materialVariant, s.materialVariant.empty());
  for (const std::string& node : s.hiddenNodes) appendOption(text, "--hide", node);
  append(text, "--hdri-file", o.light.hdriFile.string(), o.light.hdriFile.empty());
  if (o.light.studio) text += " --studio";
  append(text, "--background-blur", exactText(o.light.backgroundBlur), o.light.backgroundBlur <= 0.0);
  if (o.light.shadowCatcher)
    appendOption(text, "--shadow-catcher",
                 o.light.catcherHeight ? exactText(*o.light.catcherHeight) : "bottom");
  append(text, "--hdri-rotation", exactText(o.light.hdriRotationDegrees), o.light.hdriRotationDegrees == 0.0);
  append(text, "--hdri-intensity", exactText(o.light.hdriIntensity),
         o.light.hdriIntensity == standard.light.hdriIntensity);
  const glm::dvec3 color(o.light.backgroundColor.value_or(glm::vec3(0.0f)));
  append(text, "--background-color", exactText(color.r) + "," + exactText(color.g) + "," + exactText(color.b),
         !o.light.backgroundColor);
  if (!o.light.background) text += " --no-background";
  appendChoice(text, "--default-light", kDefaultLightNames, o.light.defaultLight,
               standard.light.defaultLight);
  append(text, "--line-width", exactText(o.camera.lineWidth),
         o.camera.lineWidth == standard.camera.lineWidth);
  appendChoice(text, "--instancing", kInstancingNames, o.device.instancing, standard.device.instancing);
  const InputLimits& limits = o.limits;
  append(text, "--memory-limit", std::to_string(limits.memoryBytes),
         limits.memoryBytes == standard.limits.memoryBytes);
  append(text, "--texture-limit", std::to_string(limits.textureSide),
         limits.textureSide == standard.limits.textureSide);
  if (limits.drawMissingTextures) text += " --missing-textures warn";
  if (limits.allowExternalFiles) text += " --allow-external-files";
}

void appendPicture(std::string& text, const RenderOptions& o) {
  const RenderOptions standard;
  append(text, "--exposure", exactText(o.output.exposure), o.output.exposure == 0.0);
  appendChoice(text, "--tone-map", toneMapNames(), o.output.toneMap, standard.output.toneMap);
  append(text, "--aov", layersText(o), layersText(o).empty());
  appendChoice(text, "--denoise", kDenoiseNames, o.output.denoise, standard.output.denoise);
  append(text, "--oidn-library", o.output.oidnLibrary.string(), o.output.oidnLibrary.empty());
  append(text, "--debug-view", std::string(rowOf(o.output.debugView).name),
         o.output.debugView == DebugView::None);
  if (o.output.treeLevel) appendOption(text, "--tree-level", std::to_string(*o.output.treeLevel));
  appendChoice(text, "--traversal", kTraversalNames, o.device.traversal, standard.device.traversal);
  appendChoice(text, "--rendering-backend", kBackendNames, o.device.backend, standard.device.backend);
  appendChoice(text, "--buffer-reads", kBufferReadsNames, o.device.bufferReads, standard.device.bufferReads);
  appendChoice(text, "--dispatch", kDispatchNames, o.device.dispatch, standard.device.dispatch);
  appendChoice(text, "--vector-width", kVectorWidthNames, o.device.vectorWidth, standard.device.vectorWidth);
  appendChoice(text, "--schedule", kScheduleNames, o.device.schedule, standard.device.schedule);
  append(text, "--shader-folder", o.device.shaderFolder.string(), o.device.shaderFolder.empty());
}

/// What follows "render" or "view".
RenderOptions parseCommand(const std::string& name, std::vector<std::string> words) {
  CLI::App app("", name);
  app.set_help_flag();
  RawView raw;
  raw.render.anyOutput = true;
  addViewOptions(app, raw);
  if (name == "render") {  // its defaults
    const RawRender standard;
    raw.render.denoise = standard.denoise;
    raw.render.defaultLight = standard.defaultLight;
  }
  app.add_option("-o,--output", raw.render.output);
  addHalfOption(app, raw.render.options.output.encoding);
  addPngDepthOption(app, raw.render.options.output.encoding);
  parseWords(app, std::move(words));
  return finishConfigured(raw.render, raw.config, app);
}

}  // namespace

std::string commandText(const RenderOptions& options) {
  std::string text = "fragtrace render";
  const std::string scene = options.scene.string();
  text += " " + quoted(scene.starts_with('-') ? "./" + scene : scene);
  append(text, "--output", options.output.file.string(), options.output.file.empty());
  if (options.output.encoding.half) text += " --half";
  append(text, "--png-depth", std::to_string(options.output.encoding.pngBits),
         options.output.encoding.pngBits == Encoding().pngBits);
  for (const std::string& part : {cameraText(options), stagesText(options.stages)})
    text += (part.empty() ? "" : " ") + part;
  appendSampling(text, options);
  appendScene(text, options);
  appendPicture(text, options);
  return text;
}

RenderOptions withCommandText(const RenderOptions& current, const std::string& text) {
  if (text.size() > kLongestText) throw UsageError("this is longer than any command");
  std::vector<std::string> words = splitWords(text);
  if (words.empty()) throw UsageError("the clipboard is empty");
  if (words.front().starts_with("--")) return withCameraText(current, text);
  const bool isOurs = std::filesystem::path(words.front()).filename() == "fragtrace" && words.size() > 1 &&
                      (words[1] == "render" || words[1] == "view");
  if (!isOurs) throw UsageError("this is no command of fragtrace: " + text);
  RenderOptions options = parseCommand(words[1], {words.begin() + 2, words.end()});
  options.output.file = current.output.file;
  options.output.toStandardOutput = current.output.toStandardOutput;
  options.output.progress = current.output.progress;
  options.camera.resolution = current.camera.resolution;
  options.sampling.spp = current.sampling.spp;
  options.sampling.noise = current.sampling.noise;
  options.sampling.seconds = current.sampling.seconds;
  options.device.backend = current.device.backend;
  options.output.statsFile = current.output.statsFile;
  options.device.shaderFolder = current.device.shaderFolder;
  options.output.quiet = current.output.quiet;
  options.output.verbose = current.output.verbose;
  return options;
}

}  // namespace fragtrace
