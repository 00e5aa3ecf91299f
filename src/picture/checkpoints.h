// SPDX-License-Identifier: MIT
// The checkpoint beside a picture that is being drawn: written now and then, read by the render that goes on,
// removed when the picture is there.
#pragma once

#include <functional>
#include <optional>

#include "film/checkpoint.h"
#include "picture/draw_parts.h"

namespace fragtrace {

/// JSON of all that a picture's samples depend on, one member a setting: settingsText(), the samples asked
/// for, the shader variant and the parts.
std::string jobText(const PictureJob& job, const DrawingPlan& plan);

/// The measurements as JSON: those of the parts before the current one, and the time that drawing has taken.
std::string measuredText(const Statistics& before, const RenderTimes& now);

/// Puts back what measuredText() was given. Throws std::runtime_error.
void restoreMeasured(const std::string& text, Statistics& stats);

/// The checkpoint to go on from. None: the picture begins anew, which is said. Throws UsageError with what
/// differs when it is one of another job, InputError naming the file when it is broken.
std::optional<Checkpoint> readCheckpoint(const PictureJob& job, const DrawingPlan& plan);

/// Returns true if --resume finds nothing to do: the output is there, whole, and no checkpoint beside it;
/// says so. It also says when there is a checkpoint that is not asked for. Throws UsageError when the picture
/// that is there has other samples.
bool isFinished(const RenderOptions& options);

/// Writes a checkpoint each time that --checkpoint says, and when a render is stopped.
class CheckpointKeeper {
 public:
  explicit CheckpointKeeper(const RenderOptions& options);

  /// Returns true if a checkpoint is wanted now; the next one is then due an interval later.
  bool isDue();
  /// Returns true if a render that is stopped leaves a checkpoint.
  bool isKept() const { return kept_; }
  /// Writes the checkpoint. Where that is not possible, the one before stays; says so once.
  void write(const Checkpoint& checkpoint);
  /// The picture is there. Throws RenderError.
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
