// SPDX-License-Identifier: MIT
// Tiny encoded pictures, written by image_make_samples.py, which says what they show.
#pragma once

#include "image/files/whole_file.h"

namespace fragtrace::samples {

inline std::vector<uint8_t> sample(const char* name) {
  return readWholeFile(std::filesystem::path(FRAGTRACE_SAMPLES) / name);
}

inline const auto kRgba8Png = sample("rgba8.png");
inline const auto kRgb16Png = sample("rgb16.png");
inline const auto kGrey16Png = sample("grey16.png");
inline const auto kGrey8Png = sample("grey8.png");
inline const auto kGrey1Png = sample("grey1.png");
inline const auto kGreyAlpha8Png = sample("grey-alpha8.png");
inline const auto kPalettePng = sample("palette.png");
inline const auto kPaletteAlphaPng = sample("palette-alpha.png");
inline const auto kBadProfilePng = sample("bad-profile.png");
inline const auto kHugePng = sample("huge.png");
inline const auto kGradientPng = sample("gradient.png");
inline const auto kGradientJpeg = sample("gradient.jpg");
inline const auto kProgressiveJpeg = sample("progressive.jpg");
inline const auto kGreyJpeg = sample("grey.jpg");
inline const auto kCmykJpeg = sample("cmyk.jpg");
inline const auto kRgbaWebP = sample("rgba.webp");

}  // namespace fragtrace::samples
