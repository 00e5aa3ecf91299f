// SPDX-License-Identifier: MIT
// Says why a picture shows nothing, or is as good as black.
#pragma once

#include <string>

#include "image/image.h"
#include "session/setup.h"

namespace fragtrace {

/// A drawn picture, linear, with what was drawn.
struct DrawnView {
  const RenderOptions& options;
  const LoadedScene& loaded;  ///< its geometry may be gone
  const Image& picture;
  const Statistics& stats;
};

/// The reason why the view shows nothing of the scene, or why 99 % of its pixels are black, and the option
/// that changes it; empty: it is neither. The reason is looked for in the file, which is loaded once more.
std::string whyNothingIsSeen(const DrawnView& view);

}  // namespace fragtrace
