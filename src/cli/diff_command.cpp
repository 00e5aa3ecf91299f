// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "base/report.h"
#include "cli/commands.h"
#include "image/compare/bias.h"
#include "image/compare/difference.h"
#include "image/compare/flip.h"
#include "image/display/tone_map.h"
#include "image/image.h"
#include "options/library/option_facts.h"
#include "options/numbers.h"
#include "options/option_text.h"
#include "options/parse_render.h"
#include "session/outputs.h"

namespace fragtrace {
namespace {

struct DiffOptions {
  std::filesystem::path picture;
  std::filesystem::path reference;
  Metric metric = Metric::Rmse;
  std::optional<double> threshold;
  std::filesystem::path outfile;
  int tile = kBiasTile;
  OcioView view;
};

/// The number, the lines that explain it, and the picture for --outfile.
struct Comparison {
  double value = 0;
  std::string more;
  Image map;
};

/// The lines below the chance.
std::string describe(const BiasTest& test, int side) {
  std::string text = std::to_string(test.noisy) + " of " + std::to_string(test.tiles) + " tiles of " +
                     std::to_string(side) + " x " + std::to_string(side) + " pixels have noise\n";
  if (std::isnan(test.chance))
    return text + "a value is not finite in the tile at " + std::to_string(test.place[0]) + "," +
           std::to_string(test.place[1]) + "\n";
  if (test.noisy == 0) return text;
  std::array<char, 32> smallest{};
  std::snprintf(smallest.data(), smallest.size(), "%.3g", test.smallest);
  text += "smallest p: " + std::string(smallest.data()) + ", in the tile at " +
          std::to_string(test.place[0]) + "," + std::to_string(test.place[1]) +
          "\ntiles by p, in tenths from 0 to 1:";
  for (const int count : test.histogram) text += " " + std::to_string(count);
  return text + "\n";
}

/// Reads a picture, and says how its values were changed.
Image readSaid(const DiffOptions& options, const std::filesystem::path& path) {
  Image image = options.view.isAsked() ? readDisplayImage(path, options.view) : readImage(path);
  for (const std::string& note : image.notes) reportMessage(path.string() + ": " + note);
  return image;
}

Comparison compareFiles(const DiffOptions& options) {
  if (options.metric == Metric::Flip) {
    FlipError error = flipError(readDisplayImage(options.picture, options.view),
                                readDisplayImage(options.reference, options.view));
    return {error.mean, {}, std::move(error.map)};
  }
  const Image picture = readSaid(options, options.picture);
  const Image reference = readSaid(options, options.reference);
  if (options.metric == Metric::Bias) {
    BiasTest test = testBias(picture, reference, options.tile);
    return {test.chance, describe(test, options.tile), std::move(test.map)};
  }
  const double value = metricValue(compare(picture, reference), options.metric);
  return {value, {}, options.outfile.empty() ? Image() : differenceImage(picture, reference)};
}

/// Warns of stored values that mean different things.
void warnOfKinds(const DiffOptions& options) {
  const bool ofDisplay = isDisplayFormat(options.picture);
  if (options.metric == Metric::Flip || options.view.isAsked() ||
      ofDisplay == isDisplayFormat(options.reference))
    return;
  const auto kind = [](const std::filesystem::path& path) {
    return path.string() + (isDisplayFormat(path) ? " holds sRGB values" : " holds linear radiance");
  };
  std::fprintf(stderr, "fragtrace: warning: %s, and %s: only --metric flip compares them as they look\n",
               kind(options.picture).c_str(), kind(options.reference).c_str());
}

/// Says what the number is, to one who reads it in a terminal.
std::string explanation(const DiffOptions& options) {
  const std::string name(metricNames()[size_t(options.metric)]);
  const bool comparesValues = options.metric != Metric::Flip && options.metric != Metric::Bias;
  const char* values = !comparesValues          ? ""
                       : options.view.isAsked() ? "\nvalues: what the view shows, from 0 to 1"
                       : isDisplayFormat(options.picture)
                           ? "\nvalues: sRGB from 0 to 1; a step of 8 bits is 0.004"
                           : "\nvalues: linear radiance";
  return name + ": " + meaningOf(options.metric) + values + "\n";
}

int runDiff(const DiffOptions& options) {
  checkOutputs(std::array{NamedOutput{"--outfile", options.outfile}},
               std::array{options.picture, options.reference});
  const auto [value, more, map] = compareFiles(options);
  warnOfKinds(options);
  std::printf("%.9g\n", value);
  if (isatty(STDOUT_FILENO) != 0) std::printf("%s", explanation(options).c_str());
  std::printf("%s", more.c_str());
  if (!options.outfile.empty()) writeImage(options.outfile, map);
  return options.threshold && !isWithin(options.metric, value, *options.threshold) ? 1 : 0;
}

}  // namespace

RunCommand addDiff(CLI::App& app) {
  struct Raw {
    DiffOptions options;
    std::string metric = "rmse";
    RawRender render;
  };
  const auto raw = std::make_shared<Raw>();
  app.add_option("picture", raw->options.picture, "picture to compare")->type_name("FILE")->required();
  app.add_option("reference", raw->options.reference, "reference picture, of the same size")
      ->type_name("FILE")
      ->required();
  app.add_option(
         "--metric", raw->metric,
         "error metric: rmse, mse, relmse, psnr, max, flip, or bias, the chance that two .exr with --aov "
         "variance have the same limit")
      ->capture_default_str()
      ->check(withChoices(metricNames()));
  app.add_option("--threshold", raw->options.threshold, "exit with status 1 if the error is worse than this")
      ->check(realNumber());
  app.add_option("--outfile", raw->options.outfile,
                 "write a picture of the absolute differences, of the FLIP error, or of the tiles' bias")
      ->type_name("FILE");
  const CLI::Option* tile =
      app.add_option("--tile", raw->options.tile, "pixels of a side of the tiles that --metric bias compares")
          ->capture_default_str()
          ->check(wholeNumber(1, 65536));
  addOption(app, "--ocio-view", raw->render,
            "compare linear pictures as this view of an OpenColorIO configuration shows them");
  for (const char* name : {"--ocio-config", "--ocio-display", "--ocio-look", "--ocio-input"})
    addOption(app, name, raw->render);
  return [raw, tile] {
    DiffOptions options = raw->options;
    checkView(raw->render.options.output);
    options.view = raw->render.options.output.ocio;
    options.metric = choose<Metric>("--metric", raw->metric, metricNames());
    if (tile->count() > 0 && options.metric != Metric::Bias)
      throw UsageError("--tile: only --metric bias compares tiles");
    if (options.view.isAsked() && options.metric == Metric::Bias)
      throw UsageError("--ocio-view: --metric bias compares linear radiance");
    if (!options.outfile.empty() && !isWritableImageName(options.outfile)) {
      throw UsageError("--outfile: '" + options.outfile.string() +
                       "' ends in none of .png, .jpg, .exr, .hdr, .pfm");
    }
    return runDiff(options);
  };
}

}  // namespace fragtrace
