// SPDX-License-Identifier: MIT
#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "errors.h"
#include "image/format.h"

namespace fragtrace {

namespace {

/// Option values as the library parses them, before they become RenderOptions.
struct RawRender {
  std::string scene;
  std::string output;
  std::vector<int> resolution;
  std::string stage = "gi";
  std::vector<std::string> enable;
  std::vector<std::string> disable;
  std::string bounces = "16";
  std::vector<double> position;
  std::vector<double> focalPoint;
  std::vector<double> viewUp;
  std::vector<double> backgroundColor;
  std::string hdriFile;
  std::string pixelFilter = "box";
  std::string toneMap = "neutral";
  std::string traversal = "auto";
  std::string backend = "auto";
  std::string reads = "auto";
  std::string statsFile;
  std::string shaderFolder;
  std::vector<std::string> aov;
  std::string fresnel = "exact";
  std::string compensation = "on";
  std::string sampler = "sobol";
  bool noBackground = false;
  bool noDefaultLight = false;
};

template <typename Name>
std::string joined(const std::vector<Name>& names) {
  std::string text;
  for (const Name& name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

std::vector<std::string> stageNames(bool cumulativeOnly) {
  std::vector<std::string> names;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative || !cumulativeOnly) names.emplace_back(row.name);
  }
  return names;
}

/// The value of a name in a list of names whose order is that of the values.
template <typename Value, typename Names>
Value choose(const char* option, const std::string& name, const Names& names) {
  int index = 0;
  std::vector<std::string> all;
  for (const auto& candidate : names) {
    if (name == candidate) return Value(index);
    all.emplace_back(candidate);
    ++index;
  }
  throw UsageError(std::string(option) + ": '" + name + "' is none of " + joined(all));
}

Stage stageNamed(const char* option, const std::string& name) {
  const std::optional<Stage> stage = parseStage(name);
  if (!stage)
    throw UsageError(std::string(option) + ": '" + name + "' is none of " + joined(stageNames(false)));
  return *stage;
}

std::optional<glm::dvec3> vectorOf(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return glm::dvec3(values[0], values[1], values[2]);
}

int parseBounces(const std::string& text) {
  if (text == "unlimited") return kUnlimitedBounces;
  int value = -1;
  if (!CLI::detail::lexical_cast(text, value) || value < 0) {
    throw UsageError("--bounces: '" + text + "' is neither a number from 0 on nor 'unlimited'");
  }
  return value;
}

void checkFinite(const RenderOptions& o) {
  const auto check = [](const char* option, double value) {
    if (!std::isfinite(value)) throw UsageError(std::string(option) + ": not a finite number");
  };
  const auto checkVector = [&](const char* option, const std::optional<glm::dvec3>& v) {
    for (int i = 0; v && i < 3; ++i) check(option, (*v)[i]);
  };
  check("--exposure", o.exposure);
  check("--hdri-rotation", o.hdriRotationDegrees);
  checkVector("--camera-position", o.camera.position);
  checkVector("--camera-focal-point", o.camera.focalPoint);
  checkVector("--camera-view-up", o.camera.viewUp);
  checkVector("--background-color", glm::dvec3(o.backgroundColor));
  if (o.camera.viewUp && *o.camera.viewUp == glm::dvec3(0.0)) throw UsageError("--camera-view-up: is zero");
  constexpr double kFarthest = 1e9;  // metres, as for scenes
  for (const auto& place : {o.camera.position, o.camera.focalPoint}) {
    if (place && glm::length(*place) > kFarthest)
      throw UsageError("camera: farther than 1e9 m from the origin");
  }
  if (glm::any(glm::lessThan(o.backgroundColor, glm::vec3(0.0f))))
    throw UsageError("--background-color: below 0");
}

RenderOptions finish(const RawRender& raw, RenderOptions o) {
  o.scene = raw.scene;
  o.output = raw.output;
  if (!isWritableImageName(o.output)) {
    throw UsageError("--output: '" + raw.output + "' ends in none of .png, .jpg, .exr, .hdr, .pfm");
  }
  if (!raw.resolution.empty()) o.resolution = glm::ivec2(raw.resolution[0], raw.resolution[1]);
  o.stages = stagesUpTo(choose<Stage>("--stage", raw.stage, stageNames(true)));
  if (choose<int>("--fresnel", raw.fresnel, std::vector<std::string>{"exact", "schlick"}) == 1) {
    o.stages.set(size_t(Stage::Schlick));
  }
  if (choose<int>("--energy-compensation", raw.compensation, std::vector<std::string>{"on", "off"}) == 1) {
    o.stages.reset(size_t(Stage::EnergyCompensation));
  }
  if (choose<int>("--sampler", raw.sampler, std::vector<std::string>{"sobol", "random"}) == 1) {
    o.stages.reset(size_t(Stage::Sobol));
  }
  for (const std::string& name : raw.enable) o.stages.set(size_t(stageNamed("--enable", name)));
  for (const std::string& name : raw.disable) o.stages.reset(size_t(stageNamed("--disable", name)));
  o.bounces = parseBounces(raw.bounces);
  o.camera.position = vectorOf(raw.position);
  o.camera.focalPoint = vectorOf(raw.focalPoint);
  o.camera.viewUp = vectorOf(raw.viewUp);
  if (auto color = vectorOf(raw.backgroundColor)) o.backgroundColor = glm::vec3(*color);
  o.hdriFile = raw.hdriFile;
  o.background = !raw.noBackground;
  o.defaultLight = !raw.noDefaultLight;
  if (raw.pixelFilter != "box") throw UsageError("--pixel-filter: '" + raw.pixelFilter + "' is none of box");
  o.toneMap = choose<ToneMap>("--tone-map", raw.toneMap, toneMapNames());
  o.traversal = choose<TraversalMethod>(
      "--traversal", raw.traversal, std::vector<std::string>{"auto", "iterative", "bvh", "front-to-back"});
  o.backend =
      choose<Backend>("--rendering-backend", raw.backend, std::vector<std::string>{"auto", "egl", "osmesa"});
  o.bufferReads =
      choose<BufferReads>("--buffer-reads", raw.reads, std::vector<std::string>{"auto", "ssbo", "image"});
  o.statsFile = raw.statsFile;
  o.shaderFolder = raw.shaderFolder;
  for (const std::string& name : raw.aov) {
    (choose<int>("--aov", name, std::vector<std::string>{"samples", "variance"}) == 0 ? o.aovSamples
                                                                                      : o.aovVariance) = true;
  }
  if (!raw.aov.empty() && formatOfName(o.output) != ImageFormat::OpenExr) {
    throw UsageError("--aov: only .exr files hold more layers");
  }
  checkFinite(o);
  return o;
}

void addRenderOptions(CLI::App& app, RawRender& raw, RenderOptions& o) {
  const int kMost = std::numeric_limits<int>::max() / 4;
  app.add_option("scene", raw.scene, ".gltf or .glb file")->required();
  app.add_option("-o,--output", raw.output,
                 "picture: .png .jpg (tone-mapped, sRGB), .exr .hdr .pfm (linear radiance)")
      ->required();
  app.add_option("--resolution", raw.resolution,
                 "WIDTH,HEIGHT; default 1280,720, or 720 high at the camera's aspect ratio")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(1, 65536));
  app.add_option("--stage", raw.stage, joined(stageNames(true)) + "; each turns on itself and all before it")
      ->capture_default_str();
  app.add_option("--enable", raw.enable, "switches over that: " + joined(stageNames(false)))
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--disable", raw.disable, "switches off, over that")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--spp", o.spp, "camera paths a pixel")->check(CLI::Range(1, kMost))->capture_default_str();
  app.add_option("--sampler", raw.sampler, "sobol, random: where sample points come from")
      ->capture_default_str();
  app.add_option("--seed", o.seed, "of the sample points, 0 to 4294967295")->capture_default_str();
  app.add_option("--bounces", raw.bounces, "scatterings of a path, or 'unlimited'")->capture_default_str();
  app.add_option("--rr-depth", o.rouletteDepth, "Russian roulette from this scattering on")
      ->check(CLI::Range(1, kMost))
      ->capture_default_str();
  app.add_option("--fresnel", raw.fresnel, "exact, schlick: of glass")->capture_default_str();
  app.add_option("--energy-compensation", raw.compensation, "on, off: of rough surfaces in gi")
      ->capture_default_str();
  app.add_option("--camera-index", o.cameraIndex,
                 "camera of the scene, from 0; default: the first, else one that frames it");
  app.add_option("--camera-position", raw.position, "X,Y,Z in world space")->delimiter(',')->expected(3);
  app.add_option("--camera-focal-point", raw.focalPoint, "X,Y,Z")->delimiter(',')->expected(3);
  app.add_option("--camera-view-up", raw.viewUp, "X,Y,Z")->delimiter(',')->expected(3);
  app.add_option("--camera-view-angle", o.camera.viewAngleDegrees, "vertical, in degrees");
  app.add_option("--hdri-file", raw.hdriFile, "equirectangular environment: .hdr, .exr, .pfm");
  app.add_option("--hdri-rotation", o.hdriRotationDegrees, "degrees about +Y")->capture_default_str();
  app.add_flag("--no-background", raw.noBackground, "camera rays that miss see nothing; alpha is written");
  app.add_option("--background-color", raw.backgroundColor, "R,G,B, linear; seen by camera rays only")
      ->delimiter(',')
      ->expected(3);
  app.add_flag("--no-default-light", raw.noDefaultLight, "a scene without any light stays dark");
  app.add_option("--pixel-filter", raw.pixelFilter, "box")->capture_default_str();
  app.add_option("--aov", raw.aov, "samples, variance: more layers in an .exr")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--exposure", o.exposure, "EV, for .png and .jpg")->capture_default_str();
  app.add_option("--tone-map", raw.toneMap, "linear, reinhard, aces, agx, neutral, for .png and .jpg")
      ->capture_default_str();
  app.add_option("--traversal", raw.traversal, "auto, iterative, bvh, front-to-back: how rays find triangles")
      ->capture_default_str();
  app.add_option("--rendering-backend", raw.backend, "auto, egl, osmesa")->capture_default_str();
  app.add_option("--buffer-reads", raw.reads, "auto, ssbo, image: how the shader reads the scene")
      ->capture_default_str();
  app.add_option("--stats", raw.statsFile, "JSON file for the statistics");
  app.add_option("--shader-folder", raw.shaderFolder,
                 "read the shaders from here in place of the built-in ones");
  app.add_flag("--quiet", o.quiet, "print nothing but errors");
  app.add_flag("--verbose", o.verbose, "print what is chosen and what it takes");
}

/// Numbers such as "-.5,0,1" look like short options to the library; a zero before the point settles it.
std::vector<std::string> argumentsOf(int argc, const char* const* argv) {
  std::vector<std::string> arguments;
  for (int i = argc - 1; i > 0; --i) {
    std::string argument = argv[i];
    if (argument.starts_with("-.") && argument.size() > 2 &&
        std::isdigit(static_cast<unsigned char>(argument[2]))) {
      argument.insert(1, "0");
    }
    arguments.push_back(std::move(argument));
  }
  return arguments;  // last first, as the library wants them
}

}  // namespace

std::optional<CommandLine> parseCommandLine(int argc, const char* const* argv) {
  CLI::App app("A real-time ray tracer for glTF whose tracing runs in an OpenGL fragment shader.",
               "fragtrace");
  app.set_version_flag("--version", std::string("fragtrace ") + FRAGTRACE_VERSION);
  app.require_subcommand(1);
  CommandLine line;
  RawRender raw;
  std::string infoScene;
  std::string picture;
  std::string reference;
  std::string metric = "rmse";
  std::string outfile;

  CLI::App& render = *app.add_subcommand("render", "render a scene to a file");
  addRenderOptions(render, raw, line.render);
  CLI::App& info = *app.add_subcommand("info", "say what is in a scene");
  info.add_option("scene", infoScene, ".gltf or .glb file")->required();
  info.add_flag("--json", line.info.json, "as JSON");
  CLI::App& diff = *app.add_subcommand("diff", "compare a picture with a reference");
  diff.add_option("picture", picture)->required();
  diff.add_option("reference", reference)->required();
  diff.add_option("--metric", metric, "rmse, mse, relmse, psnr, max, flip")->capture_default_str();
  diff.add_option("--threshold", line.diff.threshold, "status 1 when the metric is worse than this");
  diff.add_option("--outfile", outfile, "picture of the absolute differences, or of the FLIP error");

  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  if (argc > 1 && argv[1][0] != '-' &&
      std::find(commands.begin(), commands.end(), argv[1]) == commands.end()) {
    throw UsageError("'" + std::string(argv[1]) + "' is no command: " + joined(commands));
  }
  try {
    app.parse(argumentsOf(argc, argv));
  } catch (const CLI::Success& success) {
    app.exit(success, std::cout, std::cerr);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw UsageError(std::string(error.what()) + "; --help says more");
  }

  if (render.parsed()) {
    line.command = Command::Render;
    line.render = finish(raw, line.render);
  } else if (info.parsed()) {
    line.command = Command::Info;
    line.info.scene = infoScene;
  } else {
    line.command = Command::Diff;
    line.diff.picture = picture;
    line.diff.reference = reference;
    line.diff.metric = choose<Metric>("--metric", metric, metricNames());
    line.diff.outfile = outfile;
    if (!outfile.empty() && !isWritableImageName(outfile)) {
      throw UsageError("--outfile: '" + outfile + "' ends in none of .png, .jpg, .exr, .hdr, .pfm");
    }
  }
  return line;
}

}  // namespace fragtrace
