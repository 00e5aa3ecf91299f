// SPDX-License-Identifier: MIT
// A camera as options, and one for all pictures of an animation.
#pragma once

#include <memory>

#include "gltf/gltf.h"
#include "shader/render_options.h"

namespace fragtrace {

/// Seconds that the animation of the options takes; none where its file does not say.
std::optional<double> animationLength(const Scene& scene, const SceneSelection& selection);

/// A camera as options that place it so.
CameraOverrides asPlaced(const Camera& camera, const BoundsDouble& bounds);

/// Returns the options with one camera by its numbers, where it stands by what the scene holds (no camera in
/// the file, --camera-orbit, --fit), which moves: one that shows the scene as it is over the whole animation,
/// so that machines that draw some of the frames each have the same. Otherwise returns them as they are.
/// Poses the scene some 50 times at the most. `kept` is as loadGltf() wants it. Throws InputError;
/// UsageError, also where there is no animation.
RenderOptions placedForAllPoses(RenderOptions options, std::shared_ptr<KeptDocument>& kept);

}  // namespace fragtrace
