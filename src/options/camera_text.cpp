// SPDX-License-Identifier: MIT
#include "options/camera_text.h"

#include <CLI/CLI.hpp>

#include "options/option_text.h"
#include "options/parse_render.h"
#include "options/parse_words.h"

namespace fragtrace {

namespace {

constexpr const char* kView[] = {
    "--camera-index",       "--camera",          "--camera-position",   "--camera-orbit",          "--fit",
    "--camera-focal-point", "--camera-view-up",  "--camera-view-angle", "--camera-parallel-scale", "--f-stop",
    "--focus-distance",     "--aperture-blades", "--scene-origin"};
constexpr const char* kSize = "--resolution";

}  // namespace

std::string cameraText(const RenderOptions& options) {
  std::string text;
  for (const char* name : kView) appendRow(text, rowOf(name), options);
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
