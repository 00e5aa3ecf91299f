// SPDX-License-Identifier: MIT
// Alpha that hides nothing: exporters write BLEND and MASK where pictures have no alpha.
#pragma once

#include <cstdint>
#include <span>

namespace fragtrace {

struct Scene;

/// Returns true unless the encoded picture has no alpha for certain: a .jpg, or a .png without a channel and
/// a colour of alpha.
bool mayHaveAlpha(std::span<const uint8_t> encoded);

/// Sets Material::leastAlpha by the pictures and the vertex colours of the materials.
void settleLeastAlpha(Scene& scene);

}  // namespace fragtrace
