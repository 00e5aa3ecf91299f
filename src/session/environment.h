// SPDX-License-Identifier: MIT
#pragma once

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "gltf/gltf.h"
#include "image/image.h"
#include "pack/gpu_scene.h"
#include "pack/own_light.h"
#include "scene/fit.h"
#include "scene/scene.h"
#include "shader/render_options.h"

namespace fragtrace {

// The light that a file brings: decided once when it is opened, and the words about it.

/// Decides about the light of the file of this scene. `tree` holds the scene as it stands, or there is none
/// yet. A file that is posed, or changed by the options, is loaded once more as it stands: through
/// `document`, if there is one. Throws as loadGltf() does.
FileLight fileLightOf(const RenderOptions& options, const Scene& scene, const Bvh* tree,
                      std::shared_ptr<KeptDocument>* document);

/// Gives the scene's lamps the units that were decided.
void setLampScale(Scene& scene, double lampScale);

/// The light of its own that counts besides what the options light the scene by.
OwnLight countedLight(const RenderOptions& options, const FileLight& light);

/// The exposure that the file's light asks for, in stops; 0: it needs none, or other light is there.
double exposureOf(const RenderOptions& options, const FileLight& light);

/// The options with that exposure, unless they give one.
RenderOptions exposed(RenderOptions options, const FileLight& light);

/// Says who lights the scene: always, or where it is neither the user nor all that the file needs; and how
/// lamps and exposure are taken.
void sayLight(const RenderOptions& options, const FileLight& light, bool always);

/// The reason of a default light, for the statistics; empty: the scene has none.
std::string defaultLightReason(const RenderOptions& options, const FileLight& light);

// The surroundings of a scene, by the options: a map that is read, the studio, a default light.

/// The map of the options' file. Throws InputError.
LinearImage readMap(const RenderOptions& options);

/// The surroundings of a scene with such a light of its own; `map` is what readMap() gives, or invalid
/// without a file. Says warnings, and adds them to `warnings`. Throws InputError.
Environment makeEnvironment(const RenderOptions& options, std::future<LinearImage>& map, OwnLight light,
                            std::vector<std::string>& warnings);

/// Says that the sky is dark, since the sun is below the horizon; empty: it is not.
std::string whyDark(const SkyOptions& sky);

/// The sky of the options. Says that it is dark, and adds a warning to `warnings` at night.
Environment skyOf(const RenderOptions& options, std::vector<std::string>& warnings);

// The lights whose shadows a shadow catcher shows.

/// Returns true if the camera is to be moved until the shadow on the catcher is in the picture, too.
inline bool fitsShadow(const RenderOptions& options, const CameraOverrides& overrides) {
  return overrides.fitShadow && options.light.shadowCatcher && has(options.stages, Stage::Gi);
}

/// The environment, coarsely, and the punctual lights, as the plane of that height (Y, metres) gets them in
/// the middle of the scene.
std::vector<PlaneLight> caughtLights(const Scene& scene, const Environment& environment,
                                     const RenderOptions& options, double height);

// The ground that a scene stands on (--ground).

/// Adds a level square, which is seen from above, a little below the bottom of the bounds (world space), and
/// so large that it ends at the horizon. The scene's own bounds do not hold it, so nothing is framed by it.
/// Does nothing without --ground, or to a scene that shows nothing.
void addGround(Scene& scene, const RenderOptions& options, const BoundsDouble& bounds);

}  // namespace fragtrace
