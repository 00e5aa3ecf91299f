// SPDX-License-Identifier: MIT
// Names of a picture's channels: its colour, its alpha, and the guides of filters.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "image/image.h"

namespace fragtrace {

/// The guides by which filters distinguish surfaces, as means over the samples of a pixel: albedo, the share
/// of the pixel that shows a surface, normal, and depth in metres along the view axis
/// (shaders/integrators/guide.glsl).
inline constexpr std::array kGuideChannels{"denoising.albedo.R", "denoising.albedo.G", "denoising.albedo.B",
                                           "denoising.albedo.A", "denoising.normal.X", "denoising.normal.Y",
                                           "denoising.normal.Z", "denoising.depth.Z"};

/// One observation of the variance (observedVariance() of render/film/noise.h).
inline constexpr const char* kObservedChannel = "denoising.observed.Y";

/// Returns true if 16-bit floats, with their 11 bits of precision up to 65504, suffice for a channel of that
/// name: colours (.R .G .B .A), normals and roughness. All others keep 32 bits: numbers of samples, depths,
/// variances, texture coordinates, and the identifiers of Cryptomatte.
bool isStoredAsHalf(std::string_view channel);

/// The layer of a light group: "light_" and its name, with _ in place of characters that programs for
/// compositing do not take in names.
std::string lightLayer(std::string_view group);

/// The index of the channel of that exact name.
std::optional<size_t> findChannel(const Image& image, std::string_view name);

/// The indices of R, G and B; a grey picture (Y, or only one channel besides A) gives the same index three
/// times; nothing when there is no colour.
std::optional<std::array<size_t, 3>> findColorChannels(const Image& image);

/// Adds as many channels of `from`, which has the same size, as there are names; they get these names.
void appendChannels(Image& image, const Image& from, const std::vector<std::string>& names);

/// The channels of these names, in their order. Throws std::out_of_range where one is missing.
Image onlyChannels(const Image& image, const std::vector<std::string>& names);

/// Puts the first three channels of a picture of the same size in the place of the first three.
void replaceColor(Image& image, const Image& color);

/// The picture without its channel A. Premultiplied colour then lies over black. Unchanged when there is no
/// A.
Image withoutAlpha(const Image& image);

}  // namespace fragtrace
