// SPDX-License-Identifier: MIT
// The numbers of materials and lights that can be set by eye, and what a scene becomes by them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/parts.h"
#include "scene/scene.h"

namespace fragtrace {

/// A number or a colour of a material.
struct Factor {
  const char* label;
  const char* part;    ///< the object of the material that holds it: "", an extension or pbrMetallicRoughness
  const char* member;  ///< its name in there
  size_t width;        ///< numbers in the file; 3 and 4: a linear colour
  float least;
  float most;
  bool logarithmic;
  float* (*at)(Material& material);  ///< the first of these numbers
};
std::span<const Factor> factors();

/// Returns true if the file's material has the object that holds the factor, and the factor is of use.
bool isOffered(const Factor& factor, const Material& material);

/// The numbers of the factor, with its place in the file.
SetNumber numberOf(const Factor& factor, const Material& material);

/// The numbers of a light, at its index among the file's.
SetNumber intensityOf(const LightSource& light, size_t index);
SetNumber colorOf(const LightSource& light, size_t index);

/// The numbers at a place of the file that can be set by eye: a factor or a light's; none: there is none.
std::optional<SetNumber> numberAt(std::span<const Material> materials, std::span<const LightSource> lights,
                                  const std::string& pointer);

/// Sentences about those of these numbers that the loader would not take as they are, or that glTF does not
/// allow.
std::vector<std::string> warningsOf(std::span<const SetNumber> set);

/// Returns true if one of these numbers is of emission, by which a scene may get light of its own, or lose
/// it.
bool setsEmission(std::span<const SetNumber> set);

/// The number of fewest decimal digits that rounds to the same float, so a file gives it back.
double shortest(float value);

/// Sets those numbers that are factors of the material, within the range that the loader takes.
void setFactors(Material& material, std::span<const SetNumber> set);

/// Sets those numbers that belong to the light with this index in the file.
void setLight(LightSource& light, size_t index, std::span<const SetNumber> set);

/// Gives the scene the file's materials and lights (`materials`, `lights`) with the numbers of `set`. Returns
/// false, and changes nothing, if more may have to change: `set` has another number, or a material becomes
/// one of another kind, for which meshes are built otherwise.
bool setByEye(Scene& scene, std::span<const Material> materials, std::span<const LightSource> lights,
              std::span<const SetNumber> set);

}  // namespace fragtrace
