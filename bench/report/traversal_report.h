// SPDX-License-Identifier: MIT
// The measurements of `bench traversal`. Each kind of rays is a line of JSON; docs/measurements/figures.md
// explains its members.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/report/json.h"

namespace fragtrace {

/// Returns the millions of rays per second of the median round, or 0 without a round.
double megaRaysPerSecond(size_t rays, const std::vector<double>& ms);

std::string traversalTable(std::span<const Json> kinds);

}  // namespace fragtrace
