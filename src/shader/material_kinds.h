// SPDX-License-Identifier: MIT
// Kinds of materials that several traits ask for (trait_rows.cpp).
#pragma once

#include "scene/scene.h"

namespace fragtrace {

inline bool dielectricReflects(const Material& m) {
  return m.ior != 1.0f && m.specularFactor > 0.0f &&
         glm::any(glm::greaterThan(m.specularColorFactor, glm::vec3(0.0f)));
}

inline bool isRoughInPlaces(const Material& m) {
  return m.metallicRoughnessTexture.present() || m.specularGlossiness;
}

/// Light goes straight through such a wall, at least in places.
inline bool mayBeClearWall(const Material& m) {
  return m.thicknessFactor <= 0.0f && (isRoughInPlaces(m) || m.mirrorLike());
}

inline bool mayBeRough(const Material& m) { return isRoughInPlaces(m) || m.anisotropic() || !m.mirrorLike(); }

}  // namespace fragtrace
