// SPDX-License-Identifier: MIT
// What `bench traversal` measured. A kind of rays is the line of JSON that is written of it;
// docs/measurements/figures.md explains its members.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/report/json.h"

namespace fragtrace {

/// Of the median round; 0 without any.
double megaRaysPerSecond(size_t rays, const std::vector<double>& ms);

std::string traversalTable(std::span<const Json> kinds);

}  // namespace fragtrace
