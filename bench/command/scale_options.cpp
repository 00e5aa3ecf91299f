// SPDX-License-Identifier: MIT
#include "bench/command/scale_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "options/choose.h"
#include "options/numbers.h"

namespace fragtrace {

namespace {

constexpr size_t kFewest = 100;
constexpr size_t kMost = 100000000;

const std::vector<std::string>& traversalNames() {
  static const std::vector<std::string> names{"iterative", "bvh", "front-to-back"};
  return names;
}

}  // namespace

void addBenchScaleOptions(CLI::App& app, RawBenchScale& raw) {
  BenchScaleOptions& o = raw.options;
  app.add_option("--from", o.from, "triangles of the smallest scene")
      ->check(wholeNumber(kFewest, kMost))
      ->capture_default_str();
  app.add_option("--to", o.to, "triangles of the largest scene")
      ->check(wholeNumber(kFewest, kMost))
      ->capture_default_str();
  app.add_option("--per-decade", o.perDecade, "number of sizes per factor of ten")
      ->check(wholeNumber(1, 10))
      ->capture_default_str();
  addOption(app, "--resolution", raw.render, "WIDTH,HEIGHT of the picture in pixels")
      ->check(wholeNumber(8, 4096));
  raw.render.options.camera.resolution = glm::ivec2(500, 500);
  app.add_option("--traversals", raw.traversals,
                 "traversals to measure: " + joined(traversalNames()) + "; ratios are to the first")
      ->delimiter(',');
  app.add_option("--rounds", o.rounds, "rounds of timing")
      ->check(wholeNumber(1, 1000))
      ->capture_default_str();
  app.add_option("--longest", o.longest,
                 "skip the iterative traversal if its frame takes longer than this many seconds")
      ->check(CLI::Range(0.001, 1e6))
      ->capture_default_str();
  app.add_option("--json", o.json, "write all measurements to this file, one JSON line per size")
      ->type_name("FILE");
  app.add_option("--chart", o.chart, "write a chart of time against triangles, an .svg")->type_name("FILE");
  addDeviceOptions(app, raw.render);
}

BenchScaleOptions finishBenchScale(const RawBenchScale& raw) {
  BenchScaleOptions options = raw.options;
  RawRender render = raw.render;
  render.stage = "flat";
  options.render = finishRender(render);
  if (options.to < options.from) throw UsageError("--to: is below --from");
  for (const std::string& name : raw.traversals) {
    const int index = choose<int>("--traversals", name, traversalNames());
    if (std::ranges::count(raw.traversals, name) > 1)
      throw UsageError("--traversals: '" + name + "' stands twice");
    options.traversals.push_back(TraversalMethod(index + int(TraversalMethod::Iterative)));
  }
  options.traversalNames = raw.traversals;
  if (!options.chart.empty() && options.chart.extension() != ".svg")
    throw UsageError("--chart: '" + options.chart.string() + "' does not end in .svg");
  return options;
}

std::vector<size_t> sizesOf(const BenchScaleOptions& options) {
  std::vector<size_t> sizes;
  for (int i = 0;; ++i) {
    const double size = double(options.from) * std::pow(10.0, double(i) / options.perDecade);
    // What is left to the last one is not worth a size of its own.
    if (size > 0.95 * double(options.to)) break;
    sizes.push_back(size_t(std::llround(size)));
  }
  sizes.push_back(options.to);
  return sizes;
}

}  // namespace fragtrace
