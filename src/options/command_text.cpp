// SPDX-License-Identifier: MIT
#include "options/command_text.h"

#include <CLI/CLI.hpp>
#include <utility>

#include "base/errors.h"
#include "options/option_row.h"
#include "options/option_text.h"
#include "options/parse_render.h"
#include "options/view_options.h"

namespace fragtrace {

namespace {

constexpr size_t kLongestText = size_t(1) << 16;  // bytes

/// Parses the words that follow "render" or "view".
RenderOptions parseCommand(const std::string& name, std::vector<std::string> words) {
  CLI::App app("", name);
  app.set_help_flag();
  RawView raw;
  raw.render.anyOutput = true;
  addViewOptions(app, raw);
  app.remove_option(app.get_option("others"));
  if (name == "render") raw.render.options.output.denoise = RenderOptions().output.denoise;  // its default
  addOption(app, "--output", raw.render);
  addOptions(app, OptionGroup::Encoding, raw.render);
  parseWords(app, std::move(words));
  return finishConfigured(raw.render, raw.config, app);
}

constexpr const char* kView[] = {"--camera-index",
                                 "--camera",
                                 "--camera-position",
                                 "--camera-orbit",
                                 "--fit",
                                 "--camera-focal-point",
                                 "--camera-view-up",
                                 "--camera-view-angle",
                                 "--camera-parallel-scale",
                                 "--camera-type",
                                 "--lens-shift",
                                 "--f-stop",
                                 "--focus-distance",
                                 "--aperture-blades",
                                 "--scene-origin"};
constexpr const char* kSize = "--resolution";

}  // namespace

std::string commandText(const RenderOptions& options) {
  const std::string scene = options.scene.string();
  std::string text = "fragtrace render " + quoted(scene.starts_with('-') ? "./" + scene : scene);
  for (const OptionRow& row : optionRows()) {
    if (row.traits.copied && row.name[0] == '-') appendRow(text, row, options);
  }
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
  for (const OptionRow& row : optionRows()) {
    if (row.traits.kept) row.copy(options, current);
  }
  return options;
}

std::string viewText(const RenderOptions& options) {
  std::string text;
  for (const char* name : kView) appendRow(text, rowOf(name), options);
  return text;
}

std::string cameraText(const RenderOptions& options) {
  std::string text = viewText(options);
  appendRow(text, rowOf(kSize), options);
  return text;
}

RenderOptions withCameraText(RenderOptions options, const std::string& text) {
  CLI::App app;
  app.set_help_flag();
  RawRender raw{.options = std::move(options)};
  for (const char* name : kView) {
    rowOf(name).copy(raw.options, RenderOptions());
    addOption(app, name, raw);
  }
  addOption(app, kSize, raw);
  parseWords(app, splitWords(text));
  return raw.options;
}

}  // namespace fragtrace
