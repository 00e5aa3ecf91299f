// SPDX-License-Identifier: MIT
// The checkpoint next to a picture in progress. It is written now and then, read by the render that
// continues, and removed when the picture is there.
#pragma once

#include <optional>

#include "render/film/checkpoint.h"
#include "session/picture/draw_parts.h"

namespace fragtrace {

/// JSON of everything on which a picture's samples depend, one member for each setting: settingsText(), the
/// samples asked for, the shader variant and the parts.
std::string jobText(const PictureJob& job, const DrawingPlan& plan);

/// The measurements as JSON: those of the parts before the current one, and the time that drawing has taken.
std::string measuredText(const Statistics& before, const RenderTimes& now);

/// Restores what measuredText() saved. Throws std::runtime_error.
void restoreMeasured(const std::string& text, Statistics& stats);

/// The checkpoint from which to continue. None: the picture begins again, and a message says so. Throws
/// UsageError that names the differences if it belongs to another job, and InputError that names the file if
/// it is broken.
std::optional<Checkpoint> readCheckpoint(const PictureJob& job, const DrawingPlan& plan);

/// Returns true if --resume finds nothing to do: the output is there, whole, and no checkpoint next to it;
/// says so. It also says when there is a checkpoint that is not asked for. Throws UsageError when the picture
/// that is there has other samples.
bool isFinished(const RenderOptions& options);

/// Writes a checkpoint at each interval of --checkpoint, and when a render is stopped.
class CheckpointKeeper {
 public:
  explicit CheckpointKeeper(const RenderOptions& options);

  /// Returns true if a checkpoint is wanted now; the next one is then due an interval later.
  bool isDue();
  /// Returns true if a render that is stopped leaves a checkpoint.
  bool isKept() const { return kept_; }
  /// Writes the checkpoint. Where that is not possible, the one before stays; says so once.
  void write(const Checkpoint& checkpoint);
  /// Removes the checkpoint, since the picture is there. Throws RenderError.
  void remove() const;

 private:
  RenderOptions options_;
  bool failed_ = false;
  std::filesystem::path path_;
  double period_;
  bool kept_;
  double last_;
};

}  // namespace fragtrace
