// SPDX-License-Identifier: MIT
#include <array>
#include <cstdio>

#include "cli/commands.h"
#include "cli/outputs.h"
#include "image/flip.h"
#include "image/image.h"

namespace fragtrace {
namespace {

/// What is printed, and the picture for --outfile.
struct Comparison {
  double value = 0;
  Image map;
};

Comparison compareFiles(const DiffOptions& options) {
  if (options.metric == Metric::Flip) {
    FlipError error = flipError(readDisplayImage(options.picture), readDisplayImage(options.reference));
    return {error.mean, std::move(error.map)};
  }
  const Image picture = readImage(options.picture);
  const Image reference = readImage(options.reference);
  const double value = metricValue(compare(picture, reference), options.metric);
  return {value, options.outfile.empty() ? Image() : differenceImage(picture, reference)};
}

}  // namespace

int runDiff(const DiffOptions& options) {
  checkOutputs(std::array{NamedOutput{"--outfile", options.outfile}},
               std::array{options.picture, options.reference});
  const auto [value, map] = compareFiles(options);
  std::printf("%.9g\n", value);
  if (!options.outfile.empty()) writeImage(options.outfile, map);
  return options.threshold && !isWithin(options.metric, value, *options.threshold) ? 1 : 0;
}

}  // namespace fragtrace
