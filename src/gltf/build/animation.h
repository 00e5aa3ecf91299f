// SPDX-License-Identifier: MIT
// Animations (glTF 2.0, section 3.11 and appendix C), at one moment.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "gltf/read/document.h"

namespace fragtrace {

enum class Interpolation { Step, Linear, CubicSpline };

/// Keys of a sampler: `width` numbers each; with a cubic spline three times as many, in-tangent, value,
/// out-tangent.
struct Keyframes {
  Interpolation interpolation = Interpolation::Linear;
  bool isRotation = false;  ///< unit quaternions, x y z w
  size_t width = 1;
  std::vector<float> times;  ///< seconds, never falling
  std::vector<float> values;
  bool isScale = false;  ///< scales keep their signs where motion is continued
};

/// The numbers at that time; before the first key and after the last theirs. Of keys at the same time the
/// last counts.
std::vector<double> valuesAt(const Keyframes& keys, double seconds);

/// The numbers at a time while a shutter is open. At a cut, which keys at the same time make and each key of
/// steps, the motion at the picture's moment continues as it would without the cut: the same way, mirrored at
/// the cut. So it does before the first key of all that is played and after the last one.
std::vector<double> valuesWhileOpen(const Keyframes& keys, double seconds, const OpenShutter& shutter);

/// Returns true if an animation drives the transforms and weights of nodes alone, none of which has a matrix.
bool drivesNodesAlone(const Animation& animation, const nlohmann::json& root);

/// Writes what the animation makes of the file at that time: node transforms, morph weights, and all else
/// that the loader reads as numbers (KHR_animation_pointer). They go into `changed`, a copy of the document's
/// JSON that is to be parsed again; null, which drivesNodesAlone() allows: into the document's model. What it
/// cannot drive is warned about. Throws InputError.
void applyAnimation(Document& document, const Animation& animation, double seconds,
                    const std::optional<OpenShutter>& shutter, const nlohmann::json& root,
                    nlohmann::json* changed);

}  // namespace fragtrace
