// SPDX-License-Identifier: MIT
// The benchmarks: one row each.
#pragma once

#include <array>

#include "options/command.h"

namespace fragtrace {

RunCommand addBenchError(CLI::App& app);
RunCommand addBenchFrame(CLI::App& app);
RunCommand addBenchReport(CLI::App& app);
RunCommand addBenchVariants(CLI::App& app);
RunCommand addBenchScale(CLI::App& app);
RunCommand addBenchTraversal(CLI::App& app);
RunCommand addBenchStart(CLI::App& app);
RunCommand addBenchStress(CLI::App& app);

/// In the order of --help.
inline constexpr std::array kBenchRows{
    CommandRow{"error", "error against samples and time", addBenchError},
    CommandRow{"frame", "frame times of sets of options, in turn", addBenchFrame},
    CommandRow{"report", "the report's table of frame times, measured here", addBenchReport},
    CommandRow{"variants", "what leaving out what a scene does not need saves", addBenchVariants},
    CommandRow{"scale", "1 thousand to 10 million triangles: time and memory", addBenchScale},
    CommandRow{"traversal", "rays a second, nothing shaded", addBenchTraversal},
    CommandRow{"start", "what waits for what from a cold start to a picture", addBenchStart},
    CommandRow{"stress", "what breaks ray tracers, as rates of failure", addBenchStress},
};

}  // namespace fragtrace
