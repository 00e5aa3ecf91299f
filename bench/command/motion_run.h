// SPDX-License-Identifier: MIT
// The viewer's tracing thread driven without a window while something moves, and what its pictures cost.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "options/view_options.h"
#include "view/view_state.h"

namespace fragtrace {

/// Brings what moves to its place at a time in seconds. A path of the camera begins near `start`, the scene's
/// own.
using Motion = std::function<void(ViewState& state, const CameraPose& start, double seconds)>;

/// All of these begin again after `period` seconds. Of the camera, "orbit": a turn about the focal point;
/// "dolly": towards it by half of the distance and back; else a file of camera options, as the viewer copies
/// these, a line a place: through all of them and back to the first. Before a camera at rest, "sun": the sun
/// from 2 to 60 degrees and back; "roughness": that of all materials from 0.1 to 0.9 and back; "color": all
/// base colours round the circle of hues. Throws UsageError, InputError.
Motion motionOf(const std::string& name, double period, const RenderOptions& options);

struct MotionPlan {
  ViewOptions view;
  glm::ivec2 size{1280, 720};
  Motion move;
  double intervalMs = 1000.0 / 60;  ///< from one move to the next
  int warmUp = 20;                  ///< pictures that do not count
  int pictures = 100;
  int compared = 0;  ///< number of pictures, evenly spread, that are kept
};

/// A picture, and the options that `render` draws it with.
struct KeptPicture {
  Image image;
  RenderOptions options;
};

/// Over the pictures that count.
struct MotionFigures {
  double seconds = 0.0;  ///< seconds that all pictures took
  int pictures = 0;
  double pixels = 0.0;      ///< pixels of all pictures
  double cpuMs = 0.0;       ///< CPU time of the tracing thread
  double movedBytes = 0.0;  ///< between host and device
  PassTimes passes{};
  std::vector<double> latencyMs{};  ///< from a move to the first picture that answers it
  std::vector<double> gapMs{};      ///< from picture to picture
  std::vector<KeptPicture> kept{};
};

/// False from goOn(fraction) ends it. Throws what the tracing thread failed with.
MotionFigures runMotion(const MotionPlan& plan, const std::function<bool(double fraction)>& goOn);

}  // namespace fragtrace
