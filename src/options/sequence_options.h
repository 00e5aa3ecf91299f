// SPDX-License-Identifier: MIT
// The options of a numbered sequence of pictures.
#pragma once

#include <string>

#include "stage/render_options.h"

namespace CLI {
class App;
}

namespace fragtrace {

/// As the library parses them.
struct RawSequence {
  std::string frames;
  double fps = 24.0;
  int turntable = 0;
  bool keep = false;
};

/// --frames, --fps, --turntable and --continue.
void addSequenceOptions(CLI::App& app, RawSequence& raw);

/// Throws UsageError for numbers that are no sequence, and for options that it does not go with.
void finishSequence(const RawSequence& raw, RenderOptions& options);

}  // namespace fragtrace
