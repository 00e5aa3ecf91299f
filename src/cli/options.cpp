// SPDX-License-Identifier: MIT
#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "cli/choose.h"
#include "cli/config_file.h"
#include "cli/denoise_options.h"
#include "cli/input_options.h"
#include "cli/render_options.h"
#include "cli/suggestion.h"
#include "image/format.h"
#include "image/image.h"

namespace fragtrace {

namespace {

std::vector<std::string> argumentsOf(int argc, const char* const* argv) {
  std::vector<std::string> arguments = withNumbersSettled({argv + std::min(argc, 1), argv + argc});
  std::ranges::reverse(arguments);  // last first, as the library wants them
  return arguments;
}

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// The library would call an unknown command an argument too many.
void checkCommand(const CLI::App& app, std::optional<std::string> word) {
  const std::vector<std::string> names = commandNames(app);
  if (!word || word->starts_with('-') || std::ranges::find(names, *word) != names.end()) return;
  throw UsageError("'" + *word + "' is no command of " + app.get_name() + ": " + joined(names));
}

/// What the library calls arguments that were not expected.
std::string whatIsUnknown(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  const std::vector<std::string> left = app.remaining(true);
  const auto option =
      std::ranges::find_if(left, [](const std::string& word) { return word.starts_with('-'); });
  if (option == left.end()) return "'" + left.front() + "' is an argument too many; --help says more";
  std::vector<std::string> known;
  for (const CLI::Option* one : command->get_options()) known.push_back(one->get_name());
  const std::string unknown = option->substr(0, option->find('='));
  const std::string meant = suggestedOption(unknown, known);
  return unknown + " is no option of " + command->get_name() +
         (meant.empty() ? "; --help lists them" : "; did you mean " + meant + "?");
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
  std::string infoInstancing = "auto";
  std::string picture;
  std::string reference;
  std::string metric = "rmse";
  std::string outfile;

  CLI::App& render = *app.add_subcommand("render", "render a scene to a file");
  render.add_option("file", raw.scene, ".gltf or .glb file")->required();
  render.add_option("-o,--output", raw.output,
                    "picture: .png .jpg (tone-mapped, sRGB), .exr .hdr .pfm (linear radiance); required");
  addRenderOptions(render, raw);
  addDenoiseOption(render, raw);
  std::string config;
  addConfigOption(render, config);
  RawView rawView;
  CLI::App& view = *app.add_subcommand("view", "show a scene in a window");
  addViewOptions(view, rawView);
  CLI::App& info = *app.add_subcommand("info", "say what is in a scene");
  info.add_option("file", infoScene, ".gltf or .glb file")->required();
  info.add_flag("--json", line.info.json, "as JSON");
  addSelectionOptions(info, line.info.selection);
  info.add_option("--instancing", infoInstancing, joined(kInstancingNames) + ": as render's")
      ->capture_default_str();
  addInputOptions(info, line.info.limits);
  CLI::App& diff = *app.add_subcommand("diff", "compare a picture with a reference");
  diff.add_option("picture", picture)->required();
  diff.add_option("reference", reference)->required();
  diff.add_option("--metric", metric, "rmse, mse, relmse, psnr, max, flip")->capture_default_str();
  diff.add_option("--threshold", line.diff.threshold, "status 1 when the metric is worse than this");
  diff.add_option("--outfile", outfile, "picture of the absolute differences, or of the FLIP error");

  std::vector<std::string> parts;
  std::string mergedName;
  CLI::App& merge = *app.add_subcommand("merge", "join .exr parts of one render (--sample-offset)");
  merge.add_option("parts", parts, ".exr files of render, same settings and seed")->required();
  merge.add_option("-o,--output", mergedName, "the .exr to write")->required();
  RawRender rawMerge;
  merge
      .add_option("--denoise", rawMerge.denoise,
                  joined(kDenoiseNames) + ": filter the noise out of the joined picture, as denoise does")
      ->capture_default_str();
  addFileFilterOptions(merge, rawMerge);
  RawDenoise rawDenoise;
  CLI::App& denoise = *app.add_subcommand("denoise", "filter the noise out of a picture");
  addDenoiseCommandOptions(denoise, rawDenoise);

  CLI::App& bench = *app.add_subcommand("bench", "measure speed and error");
  bench.require_subcommand(1);
  RawBenchError rawError;
  CLI::App& benchError = *bench.add_subcommand("error", "error against samples and time");
  addBenchErrorOptions(benchError, rawError);
  RawBenchFrame rawFrame;
  CLI::App& benchFrame = *bench.add_subcommand("frame", "frame times of sets of options, in turn");
  addBenchFrameOptions(benchFrame, rawFrame);
  RawBenchReport rawReport;
  CLI::App& benchReport = *bench.add_subcommand("report", "the report's table of frame times, measured here");
  addBenchReportOptions(benchReport, rawReport);
  RawBenchVariants rawVariants;
  CLI::App& benchVariants =
      *bench.add_subcommand("variants", "what leaving out what a scene does not need saves");
  addBenchVariantsOptions(benchVariants, rawVariants);
  RawBenchScale rawScale;
  CLI::App& benchScale =
      *bench.add_subcommand("scale", "1 thousand to 10 million triangles: time and memory");
  addBenchScaleOptions(benchScale, rawScale);
  RawBenchTraversal rawTraversal;
  CLI::App& benchTraversal = *bench.add_subcommand("traversal", "rays a second, nothing shaded");
  addBenchTraversalOptions(benchTraversal, rawTraversal);
  RawBenchStart rawStart;
  CLI::App& benchStart = *bench.add_subcommand("start", "what waits for what from a cold start to a picture");
  addBenchStartOptions(benchStart, rawStart);
  RawBenchStress rawStress;
  CLI::App& benchStress = *bench.add_subcommand("stress", "what breaks ray tracers, as rates of failure");
  addBenchStressOptions(benchStress, rawStress);

  const auto word = [&](int i) { return i < argc ? std::optional<std::string>(argv[i]) : std::nullopt; };
  checkCommand(app, word(1));
  if (word(1) == "bench") checkCommand(bench, word(2));
  try {
    app.parse(argumentsOf(argc, argv));
  } catch (const CLI::Success& success) {
    app.exit(success, std::cout, std::cerr);
    return std::nullopt;
  } catch (const CLI::ExtrasError&) {
    throw UsageError(whatIsUnknown(app));
  } catch (const CLI::ParseError& error) {
    throw UsageError(std::string(error.what()) + "; --help says more");
  }

  if (render.parsed()) {
    line.command = Command::Render;
    line.render = finishConfigured(raw, config, render);
    if (line.render.output.empty()) throw UsageError("--output is required; --help says more");
  } else if (view.parsed()) {
    line.command = Command::View;
    line.view = finishView(rawView, view);
  } else if (info.parsed()) {
    line.command = Command::Info;
    line.info.scene = infoScene;
    line.info.instancing = choose<Instancing>("--instancing", infoInstancing, kInstancingNames);
  } else if (benchError.parsed()) {
    line.command = Command::BenchError;
    line.benchError = finishBenchError(rawError, benchError);
  } else if (benchFrame.parsed()) {
    line.command = Command::BenchFrame;
    line.benchFrame = finishBenchFrame(rawFrame, benchFrame);
  } else if (benchReport.parsed()) {
    line.command = Command::BenchReport;
    line.benchReport = finishBenchReport(rawReport, benchReport);
  } else if (benchVariants.parsed()) {
    line.command = Command::BenchVariants;
    line.benchVariants = finishBenchVariants(rawVariants, benchVariants);
  } else if (benchScale.parsed()) {
    line.command = Command::BenchScale;
    line.benchScale = finishBenchScale(rawScale);
  } else if (benchTraversal.parsed()) {
    line.command = Command::BenchTraversal;
    line.benchTraversal = finishBenchTraversal(rawTraversal);
  } else if (benchStart.parsed()) {
    line.command = Command::BenchStart;
    line.benchStart = finishBenchStart(rawStart);
  } else if (benchStress.parsed()) {
    line.command = Command::BenchStress;
    line.benchStress = finishBenchStress(rawStress);
  } else if (merge.parsed()) {
    line.command = Command::Merge;
    line.merge.parts.assign(parts.begin(), parts.end());
    line.merge.output = mergedName;
    if (formatOfName(mergedName) != ImageFormat::OpenExr)
      throw UsageError("--output: '" + mergedName + "' does not end in .exr");
    line.merge.filter = finishRender(rawMerge);
  } else if (denoise.parsed()) {
    line.command = Command::Denoise;
    line.denoise = finishDenoise(rawDenoise);
  } else {
    line.command = Command::Diff;
    line.diff.picture = picture;
    line.diff.reference = reference;
    line.diff.metric = choose<Metric>("--metric", metric, metricNames());
    line.diff.outfile = outfile;
    if (line.diff.threshold && !std::isfinite(*line.diff.threshold))
      throw UsageError("--threshold: not a finite number");
    if (!outfile.empty() && !isWritableImageName(outfile)) {
      throw UsageError("--outfile: '" + outfile + "' ends in none of .png, .jpg, .exr, .hdr, .pfm");
    }
  }
  return line;
}

}  // namespace fragtrace
