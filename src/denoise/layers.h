// SPDX-License-Identifier: MIT
// The layers of pictures that other renderers wrote, under our names.
#pragma once

#include "image/image.h"

namespace fragtrace {

/// R, G, B, A, samples.Y, variance.Y, kObservedChannel and kGuideChannels of a picture file, as far as it has
/// them. Guides that it lacks are its layers of first hits: ours (albedo, normal, depth), or
/// colours and guides of Cycles (ViewLayer.Combined.R, ViewLayer.Noisy Image.R, ViewLayer.Denoising Albedo.R,
/// ...), Mitsuba (albedo.R, sh_normal.X, nn.X, ...) or pbrt (Albedo.R, Ns.X, N.X). Noisy colours of Cycles
/// are taken before filtered ones; guides of the layer that the colours are of. Without a channel R where the
/// file has no colour.
Image layersForFilter(const Image& file);

}  // namespace fragtrace
