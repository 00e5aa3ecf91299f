// SPDX-License-Identifier: MIT
// The row of wedges that are cut into slivers: whoever is inside sees none of the bright world.
#pragma once

#include "stress/stress.h"

namespace fragtrace {

/// Closed white wedges of 1 to 60 degrees, turned at random, each face cut into strips of random widths,
/// across or along the crease; path traced, by a tree and (wedges of fewer strips) as literals. Cases are
/// paths, failures pixels that are not black.
StressOutcome scatterInStrips(const StressSetting& setting);

}  // namespace fragtrace
