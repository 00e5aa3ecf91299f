// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "image/image.h"
#include "render/film.h"
#include "session/picture/checkpoints.h"
#include "session/picture/draw_parts.h"
#include "session/session.h"
#include "session/setup.h"
#include "shader/render_options.h"

namespace fragtrace {

// Draws the samples of a picture, with readings of the film for a filter, and its layers of first hits.

/// The result of drawing, before it is a picture.
struct Drawing {
  FilmPixels pixels;
  std::vector<double> variance;  ///< a better estimate than the pixels' own; may be empty
  std::vector<double> observed;  ///< observedVariance(); may be empty
};

/// A film that gets samples, and the copies of it that were read on the way.
struct SampledFilm {
  Film film;
  std::vector<FilmPixels> looks;  ///< copies of the film at a quarter and at half of the samples
  int fewest = 0;                 ///< samples that each pixel has
};

/// Returns true if the film is read on the way, which tells how fast the sequence converges: where the
/// picture is filtered, or a file of it may be (`--aov denoising`).
bool looksOnTheWay(const RenderOptions& options);

/// Adds samples up to options.spp and reads the film. False if progress stopped it.
bool drawAllSamples(Renderer& renderer, SampledFilm& sampled, const RenderOptions& options, const View& view,
                    RenderTimes& times, const Renderer::Progress& progress, Drawing& drawing);

/// The drawing as a picture, with all layers that the options ask for and that their filter needs, except
/// layers of first hits. withSamples: samples.Y is added even if nobody asks for it.
Image pictureOf(const Drawing& drawing, const RenderOptions& options, bool withSamples = false);

/// The number of samples of layers that nobody has asked for, or for which the user waits.
inline constexpr int kFewLayerSamples = 16;

/// Returns the number of samples of a layer, for a picture with `ofPicture` samples: a filter needs no more
/// than a few.
int samplesOfLayer(const RenderOptions& options, Aov aov, int ofPicture);

/// A layer, with its time and its counts.
struct LayerDraw {
  Image image;  ///< its channels have the names that they have in a file
  bool complete = true;
  double compileMs = 0.0;
  RenderTimes times;
  FilmTotals totals;
};

/// Has the renderer draw this variant, and compiles it if it is new. Returns the milliseconds that this took.
double useOrCompile(Renderer& renderer, const ShaderVariant& variant, Film& film, const View& view);

/// Draws a layer; an incomplete one if progress stopped it. That of a variant without an AOV is R, G and B.
/// The renderer keeps that variant. Compiles the variant if it is new.
LayerDraw drawLayer(glm::ivec2 size, Renderer& renderer, const ShaderVariant& variant, const View& view,
                    int samples, const Renderer::Progress& progress = Renderer::toTheEnd);

// Turns a scene on the device into a picture with all content of its file. All front ends that finish
// pictures share this.

/// Draws the picture's samples, and says what is odd about them. Its layers need `plan` later. Nothing if the
/// thread was interrupted more than `most` times. Throws what planDrawing() and drawPicture() throw.
std::optional<Image> drawSamples(const PictureJob& job, DrawingPlan& plan, Device& device,
                                 CheckpointKeeper& keeper, int most, Statistics& stats);

/// Adds layers, filters, and puts the provenance into the picture of drawSamples(). False if the thread was
/// interrupted more than `most` times. Throws RenderError; the picture then keeps what was done.
bool finishPicture(Image& picture, const PictureJob& job, const DrawingPlan& plan, Device& device, int most,
                   Statistics& stats);

/// Says how much light --bounces has cut, and what ended the samples, where that is worth a line.
void sayHowItEnded(const RenderOptions& options, const Statistics& stats);

}  // namespace fragtrace
