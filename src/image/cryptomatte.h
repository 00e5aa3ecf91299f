// SPDX-License-Identifier: MIT
// Cryptomatte 1.2.0 (Friedman and Jones, Fully Automatic ID Mattes with Support for Motion Blur and
// Transparency, 2015): the layers NAME00, NAME01 and NAME02 of an .exr tell which names a pixel shows, and
// how large the share of each is. Programs for compositing make masks of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace fragtrace {

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
