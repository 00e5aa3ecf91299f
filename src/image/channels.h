// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace fragtrace {

// Names of a picture's channels: its colour, its alpha, and the guides of filters.

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

/// The layer of a light group: "light_" and its name, with _ instead of characters that programs for
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

// Cryptomatte 1.2.0 (Friedman and Jones, Fully Automatic ID Mattes with Support for Motion Blur and
// Transparency, 2015): the layers NAME00, NAME01 and NAME02 of an .exr tell which names a pixel shows, and
// how large the share of each is. Programs for compositing make masks of them.

/// The names that a pixel can hold, two in each layer of four channels.
inline constexpr int kMatteRanks = 6;

/// MurmurHash3_x86_32 (Appleby) with the seed 0.
uint32_t murmurHash3(std::string_view text);

/// The number of a name: the bits of the float in the picture, which is finite and not denormal.
uint32_t matteId(std::string_view name);

/// A name among the samples of a pixel.
struct MatteShare {
  uint32_t id = 0;
  uint32_t samples = 0;
};

/// The channels of a pixel, pairs of id and share in descending order of the shares. Names beyond kMatteRanks
/// are left out. `samples`: all that the pixel has.
void appendRanks(std::span<const MatteShare> shares, uint32_t samples, std::vector<float>& values);

/// The names of these channels: NAME00.R, NAME00.G, ...
std::vector<std::string> matteChannels(const std::string& layer);

/// Writes the attributes of a Cryptomatte into the picture, with the numbers of all names.
void setManifest(Image& image, const std::string& layer, std::span<const std::string> names);

/// Returns true if the picture has such attributes.
bool holdsMattes(const Image& image);

}  // namespace fragtrace
