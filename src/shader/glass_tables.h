// SPDX-License-Identifier: MIT
// Decides which shaders compensate the light that the facets of rough glass lose.
#pragma once

#include "shader/variant.h"

namespace fragtrace {

/// Returns true if the tables of src/pack/glass_energy.cpp hold for the loss. No table knows the facets that
/// these traits change, and samples would not follow their density.
inline bool usesGlassTables(const ShaderVariant& v) {
  if (!has(v.traits, Trait::RoughGlass) || !has(v.stages, Stage::EnergyCompensation)) return false;
  return !has(v.traits, Trait::Anisotropy) && !has(v.traits, Trait::Iridescence) &&
         !has(v.traits, Trait::GlassSpecular) && !has(v.traits, Trait::Dispersion) &&
         !has(v.stages, Stage::Schlick);
}

}  // namespace fragtrace
