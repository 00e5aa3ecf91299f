// SPDX-License-Identifier: MIT
// The memory that a picture takes while it is drawn, filtered and written.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shader/render_options.h"

namespace fragtrace {

/// The number of channels of the picture in an .exr; an upper bound for other formats.
size_t channelsOf(const RenderOptions& options);

/// Throws UsageError where the film of a picture of that size would take more than --memory-limit.
void checkFilmMemory(const RenderOptions& options, glm::ivec2 size);

/// The largest film beside a picture of that size within --memory-limit, in pixels, at least 1; as many as
/// the picture has where all of it fits. Throws UsageError where not even a small film does.
uint64_t mostFilmPixels(const RenderOptions& options, glm::ivec2 size);

}  // namespace fragtrace
