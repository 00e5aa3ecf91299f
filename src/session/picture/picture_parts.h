// SPDX-License-Identifier: MIT
// Divides a picture into parts if a film of all of it would be too large for the device or for
// --memory-limit. Each part has the samples of the whole.
#pragma once

#include <vector>

#include "image/image.h"
#include "session/setup.h"

namespace fragtrace {

/// Regions that fill `region` from its top on: whole rows where the side allows. None has more pixels than
/// `mostPixels` or a longer side than `mostSide`; both are at least 1.
std::vector<Region> dividedRegion(const Region& region, int mostSide, uint64_t mostPixels);

/// The parts in which a picture is drawn on this device: one, if possible. Throws UsageError if the options
/// need the whole picture at once.
std::vector<Region> partsOf(const RenderOptions& options, const LoadedScene& loaded);

/// The view of a part of the picture.
View viewOf(const LoadedScene& loaded, const Region& part);

/// Copies `part`, which lies at `corner` of `picture` and has the same channels.
void paste(const Image& part, glm::ivec2 corner, Image& picture);

}  // namespace fragtrace
