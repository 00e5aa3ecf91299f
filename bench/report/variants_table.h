// SPDX-License-Identifier: MIT
// What `bench variants` found out, as a table for people.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/report/frame_report.h"

namespace fragtrace {

/// Whether it is faster without something: "saves", "costs", or "no difference" where the middle half of the
/// ratios holds 1.
std::string gainText(const std::vector<double>& withMs, const std::vector<double>& withoutMs);

/// The first setting is the scene's own variant, each other has something turned on; `notForced` holds what
/// could not be, and why.
std::string variantsTable(const BenchMachine& machine, const std::vector<FrameSetting>& settings,
                          const std::vector<std::pair<std::string, std::string>>& notForced);

}  // namespace fragtrace
