// SPDX-License-Identifier: MIT
// A picture's options as a command, both ways: what the viewer copies and pastes.
#pragma once

#include <string>

#include "shader/render_options.h"

namespace fragtrace {

/// Returns the `fragtrace render` command of the options' picture, with all options that change it. Every
/// number reads back as itself.
std::string commandText(const RenderOptions& options);

/// The options of a whole command of `render` or `view`, or, where the text begins with an option, the
/// current ones with the camera of that text. Device, output, samples and size stay the current ones.
/// Throws UsageError, InputError (of --config).
RenderOptions withCommandText(const RenderOptions& current, const std::string& text);

/// The camera, origin and resolution of the options as text for the command line; every number reads back as
/// itself.
std::string cameraText(const RenderOptions& options);

/// The same without the resolution.
std::string viewText(const RenderOptions& options);

/// The options with all that cameraText() writes taken from such a text; an option that it does not name is
/// as by default, but a resolution stays. Throws UsageError.
RenderOptions withCameraText(RenderOptions options, const std::string& text);

}  // namespace fragtrace
