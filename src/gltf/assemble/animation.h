// SPDX-License-Identifier: MIT
// Animations (glTF 2.0, section 3.11 and appendix C), at one moment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gltf/read/document.h"

namespace fragtrace {

/// The property that a channel of an animation drives, and its accessors.
struct Channel {
  std::string place;    ///< JSON pointer of the channel
  std::string target;   ///< JSON pointer of the numbers that it drives; empty: none that we know
  std::string sampler;  ///< JSON pointer
  std::string interpolation;
  int input = -1;  ///< none: the sampler does not exist
  int output = -1;
};

struct Animation {
  std::string name;
  std::vector<Channel> channels;
};

/// Takes the animations out of a document that has passed the schema, before tinygltf, which would refuse
/// more of them than necessary, sees it.
std::vector<Animation> takeAnimations(nlohmann::json& root);

/// The time of an animation's last key in seconds, by the accessors of its times; none if one does not say
/// it.
std::optional<double> durationOf(const nlohmann::json& animation, const nlohmann::json& accessors);

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

/// Returns true if a pointer is to the transform or the weights of a node that has no matrix.
bool isMemberOfNode(const std::string& pointer, const nlohmann::json& root);

/// Writes what the animation makes of the file at that time: node transforms, morph weights, and all else
/// that the loader reads as numbers (KHR_animation_pointer). They go into the document's JSON; `inModel`:
/// those of isMemberOfNode() into its model. What it cannot drive is warned about. Throws InputError.
void applyAnimation(Document& document, const Animation& animation, double seconds,
                    const std::optional<OpenShutter>& shutter, bool inModel);

}  // namespace fragtrace
