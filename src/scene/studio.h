// SPDX-License-Identifier: MIT
// The built-in environment: a key, a fill and a rim light as soft boxes in front of a grey gradient.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "image/image.h"

namespace fragtrace {

/// Soft: a grey backdrop; white: a bright room with dark panels at both sides; dark: a dark room with bright
/// edges.
enum class StudioLook : uint8_t { Soft, White, Dark };
inline constexpr std::array<std::string_view, 3> kStudioLookNames{"soft", "white", "dark"};

/// The map that lights the scene: equirectangular (docs/design/conventions.md) with R, G, B. The key stands
/// left of a camera that looks along -Z, the fill right of it, the rim light behind the scene. A white
/// diffuse surface has a radiance of about 0.75 towards that camera.
Image studioLight(StudioLook look = StudioLook::Soft);

/// The map that the camera sees behind the scene: the gradient alone, one texel wide.
Image studioBackdrop(StudioLook look = StudioLook::Soft);

}  // namespace fragtrace
