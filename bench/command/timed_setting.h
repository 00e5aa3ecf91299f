// SPDX-License-Identifier: MIT
// Settings whose frames are timed in turn: A B A B.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bench/command/configurations.h"
#include "bench/report/frame_report.h"
#include "render/film.h"
#include "session/tracer.h"

namespace CLI {
class App;
}

namespace fragtrace {

/// The length and number of the rounds.
struct FrameTiming {
  int rounds = 10;
  /// A round has as many frames as take this long, unless --spp sets their number.
  double roundSeconds = 0.5;
  int leastFrames = 8;     ///< a round, as long as these take no more than 5 times as long
  int samplesPerDraw = 0;  ///< at most; 0: as many as the renderer puts into a draw
};

/// Adds --rounds, --round-time and --samples-per-draw.
void addTimingOptions(CLI::App& app, FrameTiming& timing);
/// Throws UsageError where a configuration cannot be timed.
void checkTimed(const BenchConfiguration& configuration);

/// One setting on the device, and what was measured of it.
struct TimedSetting {
  BenchConfiguration configuration;
  FrameTiming timing;
  std::shared_ptr<const LoadedScene> loaded;
  Tracer tracer;
  std::unique_ptr<Film> film;  ///< samples from 0 on of the last round
  FrameSetting report;
};

/// Loads and uploads. Throws InputError, UsageError, RenderError.
TimedSetting makeSetting(const Context& context, const BenchConfiguration& configuration,
                         const FrameTiming& timing);

/// Warms up all, then draws round after round in turn.
void measureInTurn(std::span<TimedSetting> settings, bool quiet);

}  // namespace fragtrace
