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

/// What was measured, as JSON: of the parts before the one under way, and how long drawing has taken.
std::string measuredText(const Statistics& before, const RenderTimes& now);

/// Puts back what measuredText() was given. Throws std::runtime_error.
void restoreMeasured(const std::string& text, Statistics& stats);

/// The checkpoint to go on from. None: the picture begins anew, which is said. Throws UsageError with what
/// differs when it is one of another job, InputError naming the file when it is broken.
std::optional<Checkpoint> readCheckpoint(const PictureJob& job, const DrawingPlan& plan);

/// Whether --resume finds nothing to do: the output is there, whole, and no checkpoint beside it; says so.
/// Says also when there is a checkpoint that is not asked for. Throws UsageError when the picture that is
/// there has other samples.
bool isFinished(const RenderOptions& options);

/// Writes a checkpoint each time that --checkpoint says, and when a render is stopped.
class CheckpointKeeper {
 public:
  explicit CheckpointKeeper(const RenderOptions& options);

  /// Whether a checkpoint is wanted now; makes those that follow wait again.
  bool isDue();
  /// Whether a render that is stopped leaves one.
  bool isKept() const { return kept_; }
  /// Where that is not possible, the checkpoint before stays; says so once.
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
