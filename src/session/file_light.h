// SPDX-License-Identifier: MIT
// The light that a file brings: decided once when it is opened, and the words about it.
#pragma once

#include <memory>
#include <string>

#include "gltf/gltf.h"
#include "pack/own_light.h"
#include "shader/render_options.h"

namespace fragtrace {

/// Decides about the light of the file of this scene. `tree` holds the scene as it stands, or there is none
/// yet. A file that is posed, or changed by the options, is loaded once more as it stands: through
/// `document`, if there is one. Throws as loadGltf() does.
FileLight fileLightOf(const RenderOptions& options, const Scene& scene, const Bvh* tree,
                      std::shared_ptr<KeptDocument>* document);

/// Gives the scene's lamps the units that were decided.
void setLampScale(Scene& scene, double lampScale);

/// The light of its own that counts beside what the options light the scene by.
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

}  // namespace fragtrace
