// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "bvh/outlines.h"
#include "session/picture/draw_samples.h"
#include "session/statistics.h"
#include "shader/render_options.h"

namespace fragtrace {

// One picture of `render`, from the scene on the device to its file.

struct Video;

/// A finished picture goes to a video, or to the output of the options.
struct Destination {
  std::string name;        ///< the name in messages
  Video* video = nullptr;  ///< none: the output of the options
};

/// A picture is written, written as far as it was drawn, or not written.
enum class Outcome : uint8_t { Complete, Partial, None };

/// Loads the scene of the options, draws it and writes the picture. The device keeps its context, which is
/// opened where there is none yet. Throws InputError, UsageError, RenderError, ContextError.
Outcome drawScene(const RenderOptions& asked, const Destination& destination, Device& device,
                  Statistics& stats, bool showsProgress);

/// The name of the output in messages.
std::string nameOf(const OutputOptions& output);

}  // namespace fragtrace
