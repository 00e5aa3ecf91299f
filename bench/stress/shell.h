// SPDX-License-Identifier: MIT
// Rows of closed shells in a bright world: whoever is inside sees none of it.
#pragma once

#include "bench/stress/stress.h"

namespace fragtrace {

/// A black shell of 80,000 triangles; cases are camera rays, failures those that meet nothing.
StressOutcome lookOutOfBlackShell(const StressSetting& setting);
/// The same at (148376, 1234, -223423), in coordinates that are rounded there.
StressOutcome lookOutOfFarShell(const StressSetting& setting);
/// A white one with one point of its surface at the origin, path traced; cases are paths, failures pixels
/// that are not black.
StressOutcome scatterInWhiteShell(const StressSetting& setting);
/// Inside white shells of spikes, instances of one mesh, turned, evenly scaled and up to a kilometre away;
/// the same cases and failures.
StressOutcome scatterInSharedShells(const StressSetting& setting);

}  // namespace fragtrace
