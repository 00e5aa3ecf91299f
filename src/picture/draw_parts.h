// SPDX-License-Identifier: MIT
// The picture of a render and its layers of first hits, drawn in as many parts as it takes; shows progress
// and stops at interrupts.
#pragma once

#include <functional>
#include <vector>

#include "picture/picture_parts.h"
#include "render/film.h"
#include "session/tracer.h"

namespace fragtrace {

/// The task of drawing one picture, and the device that draws it.
struct PictureJob {
  const RenderOptions& options;
  const LoadedScene& loaded;
  const Tracer& tracer;
  bool showsProgress = true;  ///< of this picture alone; a sequence shows its own
  /// Told how far the samples are, 0..1; may be none.
  std::function<void(double fraction)> told = {};
};

/// Everything that is made and measured before the first sample that counts.
struct DrawingPlan {
  std::vector<Region> parts;
  Film film;                         ///< of the first part, empty
  std::vector<double> layerSeconds;  ///< that a sample of each layer takes in all pixels of the picture
};

/// Compiles all programs, so that none fails later; fills in the statistics of that.
/// Throws UsageError, RenderError.
DrawingPlan planDrawing(const PictureJob& job, Statistics& stats);

class CheckpointKeeper;

/// Draws all parts and joins them, from the checkpoint on that the options ask for (picture/checkpoints.h);
/// the statistics say how far it came. An interrupt leaves out the parts to come, which are black.
/// Throws InputError and UsageError for the checkpoint, RenderError.
Image drawPicture(const PictureJob& job, DrawingPlan& plan, Statistics& stats, CheckpointKeeper& keeper);

/// Adds the layers of first hits, drawn with the picture's samples: of an adaptive one those that all pixels
/// have, of an interrupted one a few, since somebody waits. Throws RenderError.
void addFeatures(Image& picture, const PictureJob& job, const DrawingPlan& plan, Statistics& stats);

/// Says what is odd about what was drawn: the picture, or that layer of it. Throws RenderError when the
/// driver ended loops early, which makes pictures wrong.
void sayWhatWentWrong(const RenderOptions& options, const FilmTotals& film, const std::string& layer = {});

}  // namespace fragtrace
