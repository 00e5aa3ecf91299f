// SPDX-License-Identifier: MIT
// The layers of pictures that other renderers wrote, under our names.
#pragma once

#include "image/image.h"

namespace fragtrace {

/// R, G, B, A, samples.Y, variance.Y, kObservedChannel and kGuideChannels of a picture file, as far as it has
/// them. Missing guides are taken from its layers of first hits: ours (albedo, normal, depth), or colours and
/// guides of Cycles (ViewLayer.Combined.R, ViewLayer.Noisy Image.R, ViewLayer.Denoising Albedo.R, ...),
/// Mitsuba (albedo.R, sh_normal.X, nn.X, ...) or pbrt (Albedo.R, Ns.X, N.X). Noisy colours of Cycles are
/// preferred to filtered ones, and guides come from the layer of the colours. The result has no channel R if
/// the file has no colour.
Image layersForFilter(const Image& file);

}  // namespace fragtrace
