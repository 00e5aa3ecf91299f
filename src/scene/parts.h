// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

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

/// Numbers, or a word, that replace the file's.
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

// Parts of a file that the user names: scenes, animations, material variants, cameras.

/// Text from a file may hold line ends, commands to a terminal, or marks that turn the direction of writing.
/// Each of these becomes a question mark.
std::string withoutControls(std::string_view text);

/// Text from a file in quotes, shortened; control characters become question marks.
std::string inQuotes(std::string_view text);

/// Parts of a file by index and, where they have one, name: 0 "walk", 1, 2 "run". Of many, those whose names
/// are most like the wanted one.
std::string listOfParts(const std::vector<std::string>& names, std::string_view wanted = {});

/// Those of these names that are most like the wanted one: "bolt", "bolts".
std::string nearestInQuotes(std::vector<std::string> names, std::string_view wanted);

/// Returns true if the texts differ in the case of ASCII letters at most.
bool isSameButForCase(std::string_view a, std::string_view b);

/// The index of the part that the user named: by its name, else by its index, else by the only name that is
/// the same without regard to case; none if there is no such part.
std::optional<size_t> findPart(const std::string& wanted, const std::vector<std::string>& names);

/// Does the same, but throws UsageError, which begins with `option` and lists the names.
size_t indexOfPart(const char* option, const std::string& wanted, const std::vector<std::string>& names);

/// The word by which the user asks for all materials.
inline constexpr const char* kAllMaterials = "all";

/// The word by which the user asks for all animations at once.
inline constexpr const char* kAllAnimations = "all";

/// The indices of the animations that the user named: the first where none is named, all of them by
/// kAllAnimations, unless one is called so. None where the file has none and none is named. Throws
/// UsageError.
std::vector<size_t> chosenAnimations(const std::string& wanted, const std::vector<std::string>& names);

}  // namespace fragtrace
