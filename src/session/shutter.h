// SPDX-License-Identifier: MIT
// Opens the shutter: a scene that is loaded at one time of its animation gets the motion around that time.
#pragma once

#include <memory>

#include "session/setup.h"

namespace fragtrace {

/// Seconds for which the shutter of a picture is open; 0 where it opens for none.
double shutterSeconds(const RenderOptions& options);

/// Gives the scene the poses that it has while the shutter is open, half of the time before that of the
/// options and half after, and the camera its motion. There are as few segments as keep every vertex that the
/// camera sees within half a pixel of its way. Says in the statistics what moves. The scene has its camera
/// and strokes; `document` is what it was read from. Throws as loadGltf().
void openShutter(LoadedScene& loaded, const RenderOptions& options, std::shared_ptr<KeptDocument>& document,
                 Statistics& stats);

}  // namespace fragtrace
