// SPDX-License-Identifier: MIT
// Which channels of a picture are its colour and its alpha.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "image/image.h"

namespace fragtrace {

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
