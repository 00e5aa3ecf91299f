// SPDX-License-Identifier: MIT
#include "options/view_options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "base/errors.h"
#include "image/files/whole_file.h"
#include "options/option_row.h"
#include "options/parse_render.h"

namespace fragtrace {

namespace {

/// Relative error that the picture converges to before the program rests.
constexpr double kNoise = 0.005;
/// The largest side. Drivers can draw it, and X servers take more.
constexpr int kMostWindowPixels = 16384;

}  // namespace

void addViewOptions(CLI::App& app, RawView& raw) {
  RenderOptions& shown = raw.render.options;
  shown.output.denoise = Denoise::Variance;
  addOption(app, "file", raw.render, "scene: a .gltf or .glb file; without one, the window waits for a file");
  app.add_option("others", raw.others,
                 "more models, which Left and Right show instead of those of the folder")
      ->type_name("FILE");
  addOptions(app, OptionGroup::Tracing, raw.render);
  addOptions(app, OptionGroup::Filter, raw.render);
  app.remove_option(app.get_option("--stats"));  // there is no end that they could be of
  const auto describe = [&](const char* name, const char* text) { app.get_option(name)->description(text); };
  describe("--spp", "samples per pixel after which rendering stops; by default without limit");
  describe("--noise",
           "rendering stops once 95 % of the pixels have an estimated relative error below this, by default "
           "0.005");
  describe("--time", "seconds of rendering after which rendering stops");
  describe(
      "--denoise",
      "filter that removes noise while the samples are few: none, variance, oidn, auto; it fades out between "
      "64 and 256 samples per pixel");
  describe("--resolution",
           "WIDTH,HEIGHT of the picture in pixels, at most 16384 each; by default the window has 1280,720");
  addOption(app, "--trace-file", raw.render);
  addConfigOption(app, raw.config);
  app.add_option("--reference", raw.reference,
                 "picture to compare with, shown as side B of the split view; a .png or .jpg is compared in "
                 "the colours of a display, others in linear ones; without --resolution, the picture of the "
                 "scene has the size of this one")
      ->type_name("FILE");
  app.add_flag("--no-config", raw.noConfig, "leave out your defaults (fragtrace/view.json)");
  app.add_flag("--no-panel", raw.noPanel, "begin with the panel closed");
  app.add_flag("--watch", raw.watch,
               "reload the scene or the shaders of --shader-folder when a file changes");
  app.add_option("--status-file", raw.statusFile,
                 "JSON file in which the viewer keeps its current state, for scripts that control it")
      ->type_name("FILE");
}

ViewOptions finishView(RawView& raw, CLI::App& command, const std::filesystem::path& defaults) {
  ViewOptions options;
  raw.render.anyOutput = true;
  const RawView before = raw;
  std::set<const CLI::Option*> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() > 0) given.insert(option);
  }
  const bool hasDefaults = !raw.noConfig && std::filesystem::exists(defaults);
  try {
    options.render =
        finishConfigured(raw.render, raw.config, command, hasDefaults ? defaults : std::filesystem::path());
  } catch (const std::exception& error) {
    if (!hasDefaults) throw;
    raw = before;
    for (CLI::Option* option : command.get_options()) {
      if (!given.contains(option)) option->clear();
    }
    options.render =
        finishConfigured(raw.render, raw.config, command);  // throws where the defaults are right
    const std::string reason = error.what();
    const bool isNamed = reason.find(defaults.string()) != std::string::npos;
    options.warning =
        "the viewer's defaults are left out: " + (isNamed ? "" : defaults.string() + ": ") + reason;
  }
  const glm::ivec2 size = options.render.camera.resolution.value_or(glm::ivec2(1));
  if (size.x > kMostWindowPixels || size.y > kMostWindowPixels)
    throw UsageError("--resolution: the viewer's picture has at most " + std::to_string(kMostWindowPixels) +
                     " pixels a side");
  if (!raw.render.spp) options.render.sampling.spp = kMostSamples - options.render.sampling.sampleOffset;
  if (options.render.sampling.noise <= 0.0) options.render.sampling.noise = kNoise;
  options.watch = raw.watch;
  options.statusFile = raw.statusFile;
  options.reference = raw.reference;
  options.panel = !raw.noPanel;
  options.others.assign(raw.others.begin(), raw.others.end());
  return options;
}

std::filesystem::path userFile(const char* variable, const char* usual, const char* name) {
  const auto folder = [](const char* of) {
    const char* value = std::getenv(of);
    return std::filesystem::path(value ? value : "");
  };
  if (const std::filesystem::path own = folder(variable); own.is_absolute()) return own / "fragtrace" / name;
  const std::filesystem::path home = folder("HOME");
  return home.is_absolute() ? home / usual / "fragtrace" / name : std::filesystem::path();
}

void writeJson(const std::filesystem::path& file, const std::string& json) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) throw RenderError(file.parent_path().string() + ": " + error.message());
  replaceFile(file, {reinterpret_cast<const uint8_t*>(json.data()), json.size()});
}

std::filesystem::path defaultsFile() { return userFile("XDG_CONFIG_HOME", ".config", "view.json"); }

void keepDefaults(const std::filesystem::path& file, RenderOptions options) {
  constexpr std::array kKept{"denoise",        "tone-map",         "hdri-file",    "hdri-rotation",
                             "hdri-intensity", "studio",           "sky",          "sun-elevation",
                             "sun-azimuth",    "background-color", "no-background"};
  if (file.empty()) throw RenderError("there is no home folder");
  using Json = nlohmann::ordered_json;
  Json json = Json::object();
  try {
    if (std::ifstream stream(file); stream) json = Json::parse(stream);
  } catch (const Json::exception& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  if (!json.is_object()) throw InputError(file.string() + ": is no JSON object");
  if (!options.light.hdriFile.empty())
    options.light.hdriFile = std::filesystem::absolute(options.light.hdriFile);
  for (const std::string name : kKept) {
    const OptionRow& row = rowOf("--" + name);
    json.erase(name);
    if (row.isDefault(options) && name != "denoise") continue;  // whose default is another one in the viewer
    const std::vector<std::string> words = row.words(options);
    json[name] = words.empty() ? Json(true) : Json(words.front());
  }
  writeJson(file, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace fragtrace
