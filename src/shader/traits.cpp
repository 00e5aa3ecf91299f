// SPDX-License-Identifier: MIT
#include "shader/traits.h"

#include <algorithm>
#include <stdexcept>

namespace fragtrace {

bool isOfMaterial(const TraitRow& row, const Material& material, const Coordinates& coordinates) {
  if (row.ofMaterial) return row.ofMaterial(material, coordinates);
  return std::ranges::any_of(row.textures,
                             [&](auto texture) { return texture && (material.*texture).present(); });
}

bool readsTexcoords(const TraitRow& row) { return row.texcoords || row.textures.front(); }

const TraitRow& traitOfTexture(TextureRef Material::*texture) {
  for (const TraitRow& row : traitRows()) {
    if (std::ranges::find(row.textures, texture) != row.textures.end()) return row;
  }
  throw std::logic_error("a texture of kTextureRefs is in no row of traitRows()");
}

TraitSet withNeeded(Trait trait) {
  TraitSet set;
  set.set(size_t(trait));
  for (TraitSet before; before != set;) {
    before = set;
    for (const TraitRow& row : traitRows()) {
      if (has(before, row.trait)) set |= row.needs;
    }
  }
  const TraitSet needed = set;
  for (const TraitRow& row : traitRows()) {
    if (!has(needed, row.trait)) continue;
    set |= row.brings;
    if (readsTexcoords(row)) set.set(size_t(Trait::Texcoords));
  }
  return set;
}

}  // namespace fragtrace
