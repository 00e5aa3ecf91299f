// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "image/image.h"
#include "render/film.h"
#include "session/session.h"
#include "session/setup.h"
#include "session/tracer.h"

namespace fragtrace {

// Divides a picture into parts if a film of all of it would be too large for the device or for
// --memory-limit. Each part has the samples of the whole.

/// The parts in which a picture is drawn on this device: one, if possible. Throws UsageError if the options
/// need the whole picture at once.
std::vector<Region> partsOf(const RenderOptions& options, const LoadedScene& loaded);

/// The view of a part of the picture.
View viewOf(const LoadedScene& loaded, const Region& part);

// Draws the picture of a render and its layers of first hits, in as many parts as necessary. Shows progress
// and stops at interrupts.

/// The task of drawing one picture, and the device that draws it.
struct PictureJob {
  const RenderOptions& options;
  const LoadedScene& loaded;
  const Tracer& tracer;
  bool showsProgress = true;  ///< false for one of many pictures
  /// Called with the progress of the samples, 0..1; may be empty.
  std::function<void(double fraction)> told = {};
  SequenceProgress* sequence = nullptr;  ///< that of which it is a picture; null: of none
};

/// Everything that is made and measured before the first sample that counts.
struct DrawingPlan {
  std::vector<Region> parts;
  Film film;                         ///< film of the first part, empty
  std::vector<double> layerSeconds;  ///< time of one sample of each layer in all pixels
};

/// Compiles all programs, so that none fails later, starts the filter's thread, and fills in statistics.
/// Throws UsageError, RenderError.
DrawingPlan planDrawing(const PictureJob& job, Device& device, Statistics& stats);

class CheckpointKeeper;

/// Draws all parts and joins them, from the checkpoint that the options ask for
/// (session/picture/checkpoints.h). The statistics say how far it came. An interrupt leaves out the remaining
/// parts, which stay black. Throws InputError and UsageError for the checkpoint, RenderError.
Image drawPicture(const PictureJob& job, DrawingPlan& plan, Statistics& stats, CheckpointKeeper& keeper);

/// Adds the layers of first hits, the parts of the light and the light groups, drawn with the picture's
/// samples: for an adaptive picture those that all pixels have, for an interrupted one a few, since the user
/// waits. Throws RenderError.
void addAovs(Image& picture, const PictureJob& job, const DrawingPlan& plan, Statistics& stats);

/// Says what is odd about the picture, or about that layer of it. Throws RenderError if the driver ended
/// loops early, which makes pictures wrong.
void sayWhatWentWrong(const RenderOptions& options, const FilmTotals& film, const std::string& layer = {});

}  // namespace fragtrace
