// SPDX-License-Identifier: MIT
// Files for the viewer: scenes and thumbnails, read in the background, and the picture to compare with.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <vector>

#include "image/image.h"
#include "session/setup.h"
#include "view/background.h"
#include "view/exchange.h"

namespace fragtrace {

/// A load that has ended: the scene, or why there is none.
struct LoadResult {
  ViewedScene viewed;  ///< with the options of the load; only these without a scene
  std::unique_ptr<LoadedScene> scene;
  std::shared_ptr<KeptDocument> document;  ///< the document for poses, if it is animated
  std::exception_ptr error;
};

/// Loads a scene, and reports its progress.
LoadResult loadViewed(const RenderOptions& options, Exchange& exchange, const BackgroundJob& job);

/// Delivers a small picture of each environment (empty: the studio).
void makeThumbnails(const std::vector<std::filesystem::path>& files, uint64_t memoryLimit, Exchange& exchange,
                    const BackgroundJob& job);

/// A picture that the viewer compares with: linear R, G, B, and A where it has that. Throws InputError for
/// what is no picture of linear radiance (.exr, .hdr, .pfm) or too large.
Image readReference(const std::filesystem::path& path, uint64_t memoryLimit);

}  // namespace fragtrace
