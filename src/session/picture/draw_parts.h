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

/// Regions that fill `region` from its top on: whole rows where the side allows. None has more pixels than
/// `mostPixels` or a longer side than `mostSide`; both are at least 1.
std::vector<Region> dividedRegion(const Region& region, int mostSide, uint64_t mostPixels);

/// The parts in which a picture is drawn on this device: one, if possible. Throws UsageError if the options
/// need the whole picture at once.
std::vector<Region> partsOf(const RenderOptions& options, const LoadedScene& loaded);

/// The view of a part of the picture.
View viewOf(const LoadedScene& loaded, const Region& part);

/// Copies `part`, which lies at `corner` of `picture` and has the same channels.
void paste(const Image& part, glm::ivec2 corner, Image& picture);

// Draws the picture of a render and its layers of first hits, in as many parts as necessary. Shows progress
// and stops at interrupts.

/// The task of drawing one picture, and the device that draws it.
struct PictureJob {
  const RenderOptions& options;
  const LoadedScene& loaded;
  const Tracer& tracer;
  bool showsProgress = true;  ///< false where a sequence shows its own
  /// Called with the progress of the samples, 0..1; may be empty.
  std::function<void(double fraction)> told = {};
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

// Estimates the time that the layers of a picture will take, for its progress.

/// The seconds that a sample of each layer takes in all pixels, measured in the middle of the first part: of
/// AOVs, then of light groups. Compiles all layers. The film is empty afterwards.
std::vector<double> measureAovs(const PictureJob& job, Film& film, const View& view, Statistics& stats);

/// Returns the seconds that the layers from `first` on will take if the picture has `samples` samples.
double secondsOfAovs(const PictureJob& job, const DrawingPlan& plan, size_t first, int samples);

/// The time that layers will take at least: those of an adaptive picture have the fewest samples of any
/// pixel, a number that is not yet known.
double secondsOfAovs(const PictureJob& job, const DrawingPlan& plan);

}  // namespace fragtrace
