// SPDX-License-Identifier: MIT
// Tests the values of decoded pictures, down to the stored integers; samples made by Pillow, not by the
// library under test.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/errors.h"
#include "image/files/header.h"
#include "image/files/whole_file.h"
#include "image/image.h"
#include "image_samples.h"
#include "image_test_folder.h"

namespace fragtrace {
namespace {

using Texels = std::vector<uint16_t>;
using Encoded = std::span<const uint8_t>;

constexpr uint16_t from8(int value) { return uint16_t(value * 257); }

/// The texels with 16 bits a channel, whatever they are kept in.
Texels texelsOf(const TexelImage& image) {
  if (const auto* wide = std::get_if<std::span<const uint16_t>>(&image.rgba))
    return {wide->begin(), wide->end()};
  Texels texels;
  for (const uint8_t value : std::get<std::span<const uint8_t>>(image.rgba)) texels.push_back(from8(value));
  return texels;
}

Texels texelsOf(Encoded bytes) { return texelsOf(decodeTexels(bytes, "sample")); }

std::string errorOf(Encoded bytes) {
  try {
    decodeTexels(bytes, "wood.png");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

using ImageRead = ImageTestFolder;

TEST(ImageTexels, RgbaPngIsNotMultipliedByItsAlpha) {
  EXPECT_EQ(texelsOf(samples::kRgba8Png),
            (Texels{from8(200), from8(100), from8(50), from8(128), from8(10), from8(20), from8(30), 0}));
}

TEST(ImageTexels, SixteenBitPngKeepsEveryBit) {
  EXPECT_EQ(texelsOf(samples::kRgb16Png),
            (Texels{0x0001, 0x1234, 0xffff, 65535, 0x8000, 0xabcd, 0x00ff, 65535}));
  EXPECT_EQ(texelsOf(samples::kGrey16Png),
            (Texels{0x1234, 0x1234, 0x1234, 65535, 0xfedc, 0xfedc, 0xfedc, 65535}));
}

TEST(ImageTexels, TexelsHaveSixteenBitsOnlyWhereTheFileHasMoreThanEight) {
  const auto isWide = [](Encoded bytes) {
    return std::holds_alternative<std::span<const uint16_t>>(decodeTexels(bytes, "sample").rgba);
  };
  for (const Encoded wide : {Encoded(samples::kRgb16Png), Encoded(samples::kGrey16Png)})
    EXPECT_TRUE(isWide(wide));
  for (const Encoded narrow :
       {Encoded(samples::kRgba8Png), Encoded(samples::kGrey1Png), Encoded(samples::kPalettePng),
        Encoded(samples::kGreyJpeg), Encoded(samples::kRgbaWebP)})
    EXPECT_FALSE(isWide(narrow));
}

TEST(ImageTexels, GreyBecomesRgbAndTheFirstRowIsTheTop) {
  const TexelImage image = decodeTexels(samples::kGrey8Png, "sample");
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(texelsOf(image), (Texels{0, 0, 0, 65535, from8(128), from8(128), from8(128), 65535, 65535, 65535,
                                     65535, 65535, from8(1), from8(1), from8(1), 65535}));
}

TEST(ImageTexels, OneBitPngIsBlackAndWhite) {
  EXPECT_EQ(texelsOf(samples::kGrey1Png), (Texels{65535, 65535, 65535, 65535, 0, 0, 0, 65535}));
}

TEST(ImageTexels, GreyWithAlphaKeepsBoth) {
  EXPECT_EQ(texelsOf(samples::kGreyAlpha8Png), (Texels{from8(200), from8(200), from8(200), from8(64),
                                                       from8(100), from8(100), from8(100), 65535}));
}

TEST(ImageTexels, PaletteIsLookedUp) {
  EXPECT_EQ(texelsOf(samples::kPalettePng),
            (Texels{from8(7), from8(8), from8(9), 65535, from8(255), from8(128), 0, 65535}));
  EXPECT_EQ(texelsOf(samples::kPaletteAlphaPng),
            (Texels{from8(7), from8(8), from8(9), 65535, from8(255), from8(128), 0, from8(51)}));
}

TEST(ImageTexels, WebPIsNotMultipliedByItsAlpha) {
  // OpenImageIO multiplies, and leaves 8 bits to divide again: at alpha 128 two steps of 255.
  const Texels texels = texelsOf(samples::kRgbaWebP);
  const Texels expected{from8(200), from8(100), from8(50), from8(128)};
  ASSERT_EQ(texels.size(), 8U);
  for (size_t i = 0; i < texels.size(); ++i)
    EXPECT_NEAR(texels[i], expected[i % 4], i % 4 == 3 ? 0 : from8(2));
}

TEST(ImageTexels, GreyJpegBecomesRgb) {
  const Texels texels = texelsOf(samples::kGreyJpeg);
  ASSERT_EQ(texels.size(), 8U * 8U * 4U);
  for (size_t i = 0; i < texels.size(); ++i)
    EXPECT_NEAR(texels[i], i % 4 == 3 ? 65535 : from8(100), i % 4 == 3 ? 0 : from8(1));
}

TEST(ImageTexels, CmykJpegBecomesRgb) {
  const Texels texels = texelsOf(samples::kCmykJpeg);
  ASSERT_EQ(texels.size(), 8U * 8U * 4U);
  const double white = 1 - 26.0 / 255;
  EXPECT_NEAR(texels[0] / 65535.0, 0.8 * white, 0.015);
  EXPECT_NEAR(texels[1] / 65535.0, 0.6 * white, 0.015);
  EXPECT_NEAR(texels[2] / 65535.0, 0.4 * white, 0.015);
  EXPECT_EQ(texels[3], 65535);
}

TEST(ImageTexels, JpegIsNearThePictureItWasMadeOf) {
  for (const Encoded jpeg : {Encoded(samples::kGradientJpeg), Encoded(samples::kProgressiveJpeg)}) {
    const Texels texels = texelsOf(jpeg);
    const Texels exact = texelsOf(samples::kGradientPng);
    ASSERT_EQ(texels.size(), exact.size());
    double sum = 0;
    for (size_t i = 0; i < exact.size(); ++i) sum += (texels[i] - double(exact[i])) / 65535;
    EXPECT_NEAR(sum / double(exact.size()), 0, 0.01);
  }
}

TEST(ImageTexels, EveryTruncationIsAnErrorThatNamesThePicture) {
  for (const Encoded whole :
       {Encoded(samples::kGradientPng), Encoded(samples::kGradientJpeg), Encoded(samples::kProgressiveJpeg),
        Encoded(samples::kRgba8Png), Encoded(samples::kRgbaWebP)}) {
    ASSERT_EQ(errorOf(whole), "");
    // The padding byte of a WebP holds nothing of the picture.
    const size_t end = whole[0] == 'R' ? whole.size() - 1 : whole.size();
    for (size_t size = 0; size < end; size += size < 64 ? 1 : 13)
      EXPECT_NE(errorOf(whole.first(size)).find("wood.png"), std::string::npos)
          << size << " of " << whole.size();
  }
}

TEST(ImageTexels, JpegIsCompleteOnlyWithItsEndMarker) {
  const Encoded whole = samples::kProgressiveJpeg;
  EXPECT_TRUE(readJpegFrame(whole).complete);
  for (size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(readJpegFrame(whole.first(size)).complete) << size;
}

TEST(ImageTexels, WrongProfileAndTruncationOfPngPrintNothing) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(texelsOf(samples::kBadProfilePng), (Texels{from8(1), from8(2), from8(3), 65535}));
  EXPECT_NE(errorOf(Encoded(samples::kGradientPng).first(200)).find("truncated"), std::string::npos);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ImageTexels, PngIsCompleteOnlyWithItsEndChunk) {
  const Encoded whole = samples::kPaletteAlphaPng;
  EXPECT_TRUE(isCompletePng(whole));
  for (size_t size = 0; size < whole.size(); ++size) EXPECT_FALSE(isCompletePng(whole.first(size))) << size;
}

TEST(ImageTexels, WhatIsNoPictureIsRefused) {
  const uint8_t text[] = {'h', 'e', 'l', 'l', 'o', ' ', 'w', 'o', 'r', 'l', 'd', '!'};
  EXPECT_NE(errorOf(text).find("wood.png"), std::string::npos);
  EXPECT_NE(errorOf({}).find("empty"), std::string::npos);
}

TEST(ImageTexels, AbsurdSizeIsRefused) { EXPECT_NE(errorOf(samples::kHugePng), ""); }

TEST_F(ImageRead, PngIsScaledToOneAndNotMultipliedByItsAlpha) {
  replaceFile(folder / "a.png", samples::kRgba8Png);
  const Image image = readImage(folder / "a.png");
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  const int stored[] = {200, 100, 50, 128, 10, 20, 30, 0};
  ASSERT_EQ(image.values.size(), std::size(stored));
  for (size_t i = 0; i < image.values.size(); ++i)
    EXPECT_NEAR(image.values[i], float(stored[i]) / 255, 1e-6F);
}

TEST_F(ImageRead, HdrMantissasAreSharedExponentFractionsOfTheTopRowFirst) {
  // Ward: value = mantissa / 256 * 2^(exponent - 128).
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n";
  std::vector<uint8_t> bytes(header.begin(), header.end());
  bytes.insert(bytes.end(), {128, 64, 255, 129, 0, 0, 0, 0});
  replaceFile(folder / "a.hdr", bytes);
  EXPECT_EQ(readImage(folder / "a.hdr").values, (std::vector<float>{1, 0.5F, 255.0F / 128, 0, 0, 0}));
}

TEST_F(ImageRead, FormatIsToldByTheBytesAndNotByTheName) {
  replaceFile(folder / "picture of snow.jpg", samples::kRgba8Png);
  EXPECT_EQ(readImage(folder / "picture of snow.jpg").width, 2);
  replaceFile(folder / "none", samples::kGreyJpeg);
  EXPECT_EQ(readImage(folder / "none").width, 8);
}

TEST_F(ImageRead, MissingFileAndFolderAreErrorsWithPathAndReason) {
  for (const auto& path : {folder / "missing.exr", folder}) {
    try {
      readImage(path);
      FAIL() << path;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
      EXPECT_NE(std::string(error.what()).find(path == folder ? "folder" : "No such file"),
                std::string::npos);
    }
  }
}

}  // namespace
}  // namespace fragtrace
