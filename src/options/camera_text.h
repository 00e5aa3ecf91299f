// SPDX-License-Identifier: MIT
// From where a scene is seen, as text of options that gives the same view.
#pragma once

#include <string>

#include "shader/render_options.h"

namespace fragtrace {

/// The camera, origin and resolution of the options as text for the command line; every number reads back as
/// itself.
std::string cameraText(const RenderOptions& options);

/// The options with all that cameraText() writes taken from such a text; an option that it does not name is
/// as by default, but a resolution stays. Throws UsageError.
RenderOptions withCameraText(RenderOptions options, const std::string& text);

}  // namespace fragtrace
