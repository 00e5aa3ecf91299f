// SPDX-License-Identifier: MIT
// The settings that undo restores.
#pragma once

#include <vector>

#include "shader/render_options.h"
#include "view/camera_controller.h"

namespace fragtrace {

/// The options in which the sides of the split view may differ.
struct SideOptions {
  StageSet stages = stagesUpTo(Stage::Gi);
  SamplingOptions sampling;  ///< all but the noise, which is shared
  DeviceOptions device;
  DebugView debugView = DebugView::None;
  Denoise denoise = Denoise::None;
  PixelFilter pixelFilter = PixelFilter::Box;
  LightSelection lightSelection = LightSelection::Auto;
  LightReuse lightReuse = LightReuse::None;
  Caustics caustics = Caustics::Auto;
  bool transparentGlass = false;

  bool operator==(const SideOptions&) const = default;
};

/// All that the user sets in a scene: options, the sides that differ in some of them, and the camera.
struct Edit {
  RenderOptions shared;               ///< those of SideOptions do not count
  std::vector<SideOptions> sides{1};  ///< one, or two once the view was split
  CameraPose pose;
  bool posed = false;  ///< the camera is the pose; else what the options choose, to the last bit
  int sceneCamera = -1;
  bool split = false;
  size_t active = 0;  ///< the side that stages and settings are changed of
  bool treeBoxes = false;
  int treeLevel = 4;

  bool operator==(const Edit&) const = default;
};

SideOptions sideOf(const RenderOptions& options);

/// One side, which has these options.
Edit editOf(const RenderOptions& options);

/// Returns all options of a side.
RenderOptions optionsOf(const Edit& edit, size_t side);

/// Splits the view. The second side begins as the first, and keeps what was set there.
void split(Edit& edit);

}  // namespace fragtrace
