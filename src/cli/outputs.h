// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>

#include "scene/scene.h"
#include "stage/options.h"

namespace fragtrace {

/// Before long work: throws RenderError when an output cannot be written, UsageError when one is a file that
/// the render reads, or both are one file.
void checkOutputs(const RenderOptions& options);

/// The same for the pictures that the scene refers to, once it is loaded.
void checkOutputs(const RenderOptions& options, const Scene& scene);

}  // namespace fragtrace
