// SPDX-License-Identifier: MIT
// Turns a scene on the device into a picture with all content of its file. All front ends that finish
// pictures share this.
#pragma once

#include <optional>

#include "session/picture/checkpoints.h"
#include "session/picture/draw_parts.h"
#include "session/session.h"

namespace fragtrace {

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
