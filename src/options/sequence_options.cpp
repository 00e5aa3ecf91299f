// SPDX-License-Identifier: MIT
#include "options/sequence_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <vector>

#include "errors.h"
#include "options/numbers.h"

namespace fragtrace {

namespace {

constexpr int kMostFrame = 9'999'999;

/// A:B or A:B:STEP.
void parseFrames(const std::string& text, SequenceOptions& sequence) {
  std::vector<int> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    int number = -1;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc() || number < 0 || number > kMostFrame) break;
    numbers.push_back(number);
    if (rest == end) {
      at = end;
      break;
    }
    if (*rest != ':') break;
    at = rest + 1;
  }
  const bool whole = at == end && (numbers.size() == 2 || numbers.size() == 3);
  if (!whole || numbers[1] < numbers[0] || (numbers.size() == 3 && numbers[2] < 1))
    throw UsageError("--frames: '" + text + "' is no A:B or A:B:STEP, such as 0:59, with 0 <= A <= B <= " +
                     std::to_string(kMostFrame));
  sequence.first = numbers[0];
  sequence.last = numbers[1];
  if (numbers.size() == 3) sequence.step = numbers[2];
}

}  // namespace

void addSequenceOptions(CLI::App& app, RawSequence& raw) {
  CLI::Option* frames = app.add_option(
      "--frames", raw.frames,
      "A:B or A:B:STEP: render pictures A to B of the animation (B included), each to --output "
      "with its number in place of ####");
  app.add_option("--fps", raw.fps,
                 "frames per second: picture k of --frames shows the animation at k / FPS seconds")
      ->check(CLI::Range(0.001, 1e6))
      ->capture_default_str();
  app.add_option("--turntable", raw.turntable,
                 "render N pictures, numbers 0 to N - 1, from evenly spaced directions around the focal "
                 "point, each to --output with its number in place of ####")
      ->check(wholeNumber(1, kMostFrame))
      ->excludes(frames);
  app.add_flag("--continue", raw.keep, "with --frames or --turntable: skip pictures that are there already");
}

void finishSequence(const RawSequence& raw, RenderOptions& options) {
  const bool isNumbered = options.output.file.filename().string().find('#') != std::string::npos;
  const bool asked = !raw.frames.empty() || raw.turntable > 0;
  if (!asked) {
    if (raw.keep) throw UsageError("--continue: goes with --frames or --turntable");
    return;
  }
  if (!std::isfinite(raw.fps)) throw UsageError("--fps: not a finite number");
  SequenceOptions sequence;
  sequence.fps = raw.fps;
  sequence.turntable = raw.turntable;
  sequence.keep = raw.keep;
  if (raw.turntable > 0)
    sequence.last = raw.turntable - 1;
  else
    parseFrames(raw.frames, sequence);
  const char* option = raw.turntable > 0 ? "--turntable" : "--frames";
  const auto refuse = [&](const std::string& why) { throw UsageError(std::string(option) + ": " + why); };
  if (!isNumbered) refuse("the name of --output needs #### where the number of the picture goes");
  if (!options.output.statsFile.empty() &&
      options.output.statsFile.filename().string().find('#') == std::string::npos)
    refuse("the name of --stats needs #### where the number of the picture goes");
  if (options.selection.animationTime && raw.turntable == 0)
    refuse("--animation-time is of a single picture");
  if (options.camera.overrides.fit != Fit::None && raw.turntable == 0)
    refuse(
        "--fit would place another camera for each picture; --camera-orbit or --camera-position place one");
  if (options.output.checkpointSeconds > 0.0 || options.output.resume)
    refuse("--checkpoint and --resume are of a single picture; --continue goes on with a sequence");
  if (options.device.traversal == TraversalMethod::Literals)
    refuse("--traversal literals would compile a shader for each picture");
  options.output.sequence = sequence;
}

}  // namespace fragtrace
