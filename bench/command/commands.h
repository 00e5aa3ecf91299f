// SPDX-License-Identifier: MIT
// The benchmarks: one row each.
#pragma once

#include <array>
#include <memory>

#include "cli/command_line.h"

namespace fragtrace {

RunCommand addBenchError(CLI::App& app);
RunCommand addBenchFrame(CLI::App& app);
RunCommand addBenchTraversal(CLI::App& app);
RunCommand addBenchStart(CLI::App& app);
RunCommand addBenchMotion(CLI::App& app);
RunCommand addBenchStress(CLI::App& app);

/// The benchmarks, in the order of --help.
inline constexpr std::array kBenchRows{
    CommandRow{"error", "measure error as a function of samples and time", addBenchError},
    CommandRow{"frame", "measure frame times of several settings in turn", addBenchFrame},
    CommandRow{"traversal", "measure rays per second without shading", addBenchTraversal},
    CommandRow{"start", "measure the steps from a cold start to a written picture", addBenchStart},
    CommandRow{"motion", "measure the viewer's pictures while something moves", addBenchMotion},
    CommandRow{"stress", "measure failure rates in cases that break ray tracers", addBenchStress},
};

/// A benchmark: declares its options, and once they are parsed settles and runs them.
template <typename Options>
RunCommand commandOf(CLI::App& app, void (*declare)(CLI::App&, Options&),
                     void (*settle)(const CLI::App&, Options&), int (*run)(const Options&)) {
  const auto options = std::make_shared<Options>();
  declare(app, *options);
  return [=, &app] {
    settle(app, *options);
    return run(*options);
  };
}

}  // namespace fragtrace
