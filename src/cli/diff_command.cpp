// SPDX-License-Identifier: MIT
#include <cstdio>

#include "cli/commands.h"
#include "image/image.h"

namespace fragtrace {

int runDiff(const DiffOptions& options) {
  const Image picture = readImage(options.picture);
  const Image reference = readImage(options.reference);
  const double value = metricValue(compare(picture, reference), options.metric);
  std::printf("%.9g\n", value);
  if (!options.outfile.empty()) writeImage(options.outfile, differenceImage(picture, reference));
  return options.threshold && !isWithin(options.metric, value, *options.threshold) ? 1 : 0;
}

}  // namespace fragtrace
