// SPDX-License-Identifier: MIT
// Rows of closed prisms in a bright world: wedges that are cut into slivers, boxes, and boxes with
// see-through skins.
#pragma once

#include "bench/stress/stress.h"

namespace fragtrace {

/// Closed white wedges of 1 to 60 degrees, turned at random, each face cut into strips of random widths,
/// across or along the crease, once wound alike and once at random; path traced, by a tree and (wedges of
/// fewer strips) as literals. Cases are paths, failures pixels that are not black.
StressOutcome scatterInStrips(const StressSetting& setting);

/// The same in boxes of 12 triangles, up to a thousand times as long as wide, with angles of 89 to 91
/// degrees.
StressOutcome scatterInBoxes(const StressSetting& setting);

/// In cubes on whose walls, or less than an offset away from them, lie see-through skins: BLEND, or MASK that
/// is cut out everywhere.
StressOutcome scatterInSkinnedBoxes(const StressSetting& setting);

}  // namespace fragtrace
