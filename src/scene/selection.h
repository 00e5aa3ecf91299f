// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace fragtrace {

/// A lamp that the user adds to a scene, in the space that the scene is drawn in.
struct AddedLight {
  bool isSun = true;
  glm::dvec2 from{30.0, 45.0};         ///< of a sun: degrees to the right of the front (+Z), and above it
  glm::dvec3 at{0.0};                  ///< centre of an area, metres
  std::optional<glm::dvec3> target{};  ///< point that an area faces; none: straight down
  glm::dvec2 size{1.0};                ///< width and height of an area, metres
  double strength = 3.0;  ///< of a sun: irradiance on a facing surface, W/m^2; of an area: its power, W
  glm::dvec3 color{1.0};  ///< linear

  bool operator==(const AddedLight&) const = default;
};

/// Power of an area that says none, in W.
inline constexpr double kAreaPower = 30.0;

/// The word that takes a texture out of a material.
inline constexpr const char* kNoValue = "none";

/// Numbers, or a word, that stand in place of the file's.
struct SetNumber {
  /// JSON pointer, such as /materials/0/pbrMetallicRoughness/roughnessFactor, or MATERIAL:NAME
  std::string pointer;
  std::vector<double> values;  ///< one, or as many as the array has there; of a word none
  std::string word{};          ///< of a mode: "BLEND", "true"; or kNoValue

  bool operator==(const SetNumber&) const = default;
};

/// The parts of a file that are shown, and what is changed in it. A part is selected by its name or, where
/// none has that name, by its index.
struct SceneSelection {
  std::string scene{};                    ///< empty: the file's default scene
  std::string animation{};                ///< empty: the first one; only with a time
  std::optional<double> animationTime{};  ///< seconds; none: the pose that the file stands in
  std::string camera{};                   ///< name of a camera; empty: the one of the index, or the first
  std::string materialVariant{};          ///< empty: the materials that the file shows by default
  /// Nodes by name (all that have it), JSON pointer or index; they are not drawn, nor what is below them.
  std::vector<std::string> hiddenNodes{};
  /// Materials by name (all that have it) or index, or kAllMaterials: their backs are drawn as their fronts.
  std::vector<std::string> doubleSided{};
  std::vector<AddedLight> lights{};  ///< lamps that the user adds
  std::vector<SetNumber> set{};      ///< numbers that are set; the last one for a place counts
  glm::dvec3 up{0.0, 1.0, 0.0};      ///< turns the whole file, so that this direction, not 0, is +Y

  bool operator==(const SceneSelection&) const = default;
};

inline void takePose(SceneSelection& selection, const SceneSelection& from) {
  selection.animation = from.animation;
  selection.animationTime = from.animationTime;
  selection.hiddenNodes = from.hiddenNodes;
  selection.set = from.set;
}

}  // namespace fragtrace
