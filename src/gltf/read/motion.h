// SPDX-License-Identifier: MIT
// Takes skins, animations and material variants, which may move or swap parts of a file, out of the document
// before tinygltf sees it. tinygltf would refuse more of them than necessary.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/parts.h"

namespace fragtrace {

class Diagnostics;

/// glTF 2.0, section 3.7.3: indices of nodes, and of an accessor of one matrix a joint.
struct Skin {
  std::vector<int> joints;
  int inverseBindMatrices = -1;  ///< none: all are the identity
};

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

/// Takes the skins out of a document that has passed the schema. The document keeps none.
std::vector<Skin> takeSkins(nlohmann::json& root);
std::vector<Animation> takeAnimations(nlohmann::json& root);

/// The names of an array's elements, "" where one has none.
std::vector<std::string> namesOf(const nlohmann::json& array);

/// The time of an animation's last key in seconds, by the accessors of its times; none if one does not say
/// it.
std::optional<double> durationOf(const nlohmann::json& animation, const nlohmann::json& accessors);

/// Makes the chosen scene the default one and gives primitives the materials of the chosen variant
/// (KHR_materials_variants). Throws UsageError.
void applySelection(nlohmann::json& root, const SceneSelection& selection, Diagnostics& diagnostics);

}  // namespace fragtrace
