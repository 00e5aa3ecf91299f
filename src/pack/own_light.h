// SPDX-License-Identifier: MIT
// Decides if a scene lights itself.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace fragtrace {

enum class OwnLight : uint8_t {
  None,    ///< neither punctual lights nor emission
  Dim,     ///< emissive textures alone, which leave all that they do not cover nearly black
  Enough,  ///< lights, emission without a texture, or textures that shine
};

/// Returns true if emissive textures are the only light that the scene has.
bool shinesByTexturesAlone(const Scene& scene);

/// Emissive textures are dim when their light, spread over the box around the scene, is less than a radiance
/// of 0.01. They are decoded to find that out if nothing else shines. Throws InputError for a picture that
/// cannot be decoded.
OwnLight ownLight(const Scene& scene);

}  // namespace fragtrace
