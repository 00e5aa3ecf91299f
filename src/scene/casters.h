// SPDX-License-Identifier: MIT
// Finds the casters of caustics: surfaces that reflect or refract the light of lamps in single directions.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace fragtrace {

/// Roughness up to which metal and glass make caustics that light paths draw.
inline constexpr float kMostGlossy = 0.3f;

/// Kinds of materials by the caustics that light paths draw of them: of light that scatters at these alone
/// between a lamp and a rough surface (shaders/caustics/form.glsl). Camera paths find the light where
/// textures decide how smooth a surface is, or layers lie above.
enum class Caster {
  None,
  Smooth,  ///< smooth all over, and glass or metal at least in places
  Glossy   ///< has one lobe alone, of metal or glass, and a roughness of at most kMostGlossy
};
Caster casterOf(const Material& material);

/// The kind of each material. Glossy ones are no casters where lamps are so wide that camera paths find their
/// light as well: 0.03 sr, as seen from the casters.
std::vector<Caster> castersOf(const Scene& scene);

/// Returns true if camera paths meet the light of casters so often that a small picture can tell their noise:
/// there are no punctual lights, and where most of the light of emissive triangles meets casters, these
/// triangles fill more than 0.03 sr.
bool areLampsWide(const Scene& scene, const std::vector<Caster>& casters);

/// A ball in local space.
struct Ball {
  glm::vec3 middle{0.0f};
  float radius = 0.0f;
};

/// Returns at most `most` balls that together enclose all casters; casters near each other share one.
/// `casters` is the kind of each material.
std::vector<Ball> casterBalls(const Scene& scene, const std::vector<Caster>& casters, size_t most);

}  // namespace fragtrace
