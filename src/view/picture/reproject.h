// SPDX-License-Identifier: MIT
// What a camera that moves has already seen: the samples of the picture before, taken over where the picture
// now shows the same surfaces.
#pragma once

#include "image/image.h"
#include "scene/camera.h"

namespace fragtrace {

/// A picture with the layers samples.Y, variance.Y and kGuideChannels, as an .exr of `render` has them
/// (docs/design/output.md), and who saw it.
struct SeenPicture {
  Image layers;
  Camera camera;
};

/// `now` with the samples of `past` added to its own: of each pixel's first hit, where the past picture has
/// that point, at the same depth, with a normal and an albedo alike. Past light is divided by the past albedo
/// and multiplied by the present one, so that textures stay sharp. A pixel's past counts as the samples that
/// it had, but at most `most`: its reflections were seen from elsewhere. Means, counts and variances are
/// joined as if all samples had been seen (Chan, Golub and LeVeque, 1979). Background takes nothing over.
Image withPast(const SeenPicture& now, const SeenPicture& past, double most);

}  // namespace fragtrace
