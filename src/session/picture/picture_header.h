// SPDX-License-Identifier: MIT
// The camera and the colours in the header of an .exr, as standard attributes of OpenEXR.
#pragma once

#include <glm/glm.hpp>

#include "image/image.h"
#include "scene/scene.h"

namespace fragtrace {

/// Sets worldToCamera and worldToNDC, and screenWindowWidth of a perspective; of cameras that are not
/// rectilinear worldToCamera alone. `size` is that of the whole picture, even if the image is a part of it.
/// Matrices are for row vectors, (x, y, z, 1) M, of metres in world space. A camera's x is right, y up, and z
/// the direction of view. NDC is (0, 0) at the upper left corner of the picture and (1, 1) at the lower
/// right, after division by w.
void setCamera(Image& image, const Camera& camera, glm::ivec2 size);

/// Sets chromaticities: the primaries of Rec. 709 and sRGB, and their white, D65.
void setChromaticities(Image& image);

}  // namespace fragtrace
