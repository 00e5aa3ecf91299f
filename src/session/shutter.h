// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>

#include "gltf/gltf.h"
#include "scene/motion/moving_scene.h"
#include "session/setup.h"
#include "shader/render_options.h"

namespace fragtrace {

// The errors of motion in straight segments, as the picture shows them.

/// The scene at a time while the shutter is open, and the camera that sees it.
struct Moment {
  Pose pose;
  Camera camera;
};

/// Moments by their time, 0 where the shutter opens and 1 where it closes.
using Moments = std::map<double, Moment>;

// Opens the shutter: a scene that is loaded at one time of its animation gets the motion around that time.

/// Seconds for which the shutter of a picture is open; 0 where it opens for none.
double shutterSeconds(const RenderOptions& options);

/// Gives the scene the poses that it has while the shutter is open, half of the time before that of the
/// options and half after, and the camera its motion. There are as few segments as keep every vertex that the
/// camera sees within half a pixel of its way. Says in the statistics what moves. The scene has its camera
/// and strokes; `document` is what it was read from. Throws as loadGltf().
void openShutter(LoadedScene& loaded, const RenderOptions& options, std::shared_ptr<KeptDocument>& document,
                 Statistics& stats);

// A camera as options, and one for all pictures of an animation.

/// Seconds that the animation of the options takes; none where its file does not say.
std::optional<double> animationLength(const Scene& scene, const SceneSelection& selection);

/// The error of a time in pictures: those of keys are floats.
inline constexpr double kKeyTimeRounding = 1e-4;

/// A camera as options that place it so.
CameraOverrides asPlaced(const Camera& camera, const BoundsDouble& bounds);

/// Returns the options with one camera by its numbers, where it stands by what the scene holds (no camera in
/// the file, --camera-orbit, --fit), which moves: one that shows the scene as it is over the whole animation,
/// so that machines that draw some of the frames each have the same. Otherwise returns them as they are.
/// Poses the scene some 50 times at the most. `kept` is as loadGltf() wants it. Throws InputError;
/// UsageError, also where there is no animation.
RenderOptions placedForAllPoses(RenderOptions options, std::shared_ptr<KeptDocument>& kept);

}  // namespace fragtrace
