// SPDX-License-Identifier: MIT
// The built-in environment: a key, a fill and a rim light as soft boxes in front of a grey gradient.
#pragma once

#include "image/image.h"

namespace fragtrace {

/// The map that lights the scene: equirectangular (docs/design/conventions.md) with R, G, B. The key stands
/// left of a camera that looks along -Z, the fill right of it, the rim light behind the scene. A white
/// diffuse surface has a radiance of about 0.75 towards that camera.
Image studioLight();

/// The map that the camera sees behind the scene: the gradient alone, one texel wide.
Image studioBackdrop();

}  // namespace fragtrace
