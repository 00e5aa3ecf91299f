// SPDX-License-Identifier: MIT
// Which shaders give back what the facets of rough glass lose.
#pragma once

#include "stage/variant.h"

namespace fragtrace {

/// Whether the tables of src/pack/glass_energy.h say what is lost. What these traits change of the facets is
/// in no table: samples would not follow their density.
inline bool usesGlassTables(const ShaderVariant& v) {
  if (!has(v.traits, Trait::RoughGlass) || !has(v.stages, Stage::EnergyCompensation)) return false;
  return !has(v.traits, Trait::Anisotropy) && !has(v.traits, Trait::Iridescence) &&
         !has(v.traits, Trait::GlassSpecular) && !has(v.traits, Trait::Dispersion) &&
         !has(v.stages, Stage::Schlick);
}

}  // namespace fragtrace
