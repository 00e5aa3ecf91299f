// SPDX-License-Identifier: MIT
// Headers of encoded pictures: what they say of good ones, and that nothing in them is believed.
#include <gtest/gtest.h>

#include <random>
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

using Bytes = std::vector<uint8_t>;

std::string refusalOf(std::span<const uint8_t> bytes) {
  try {
    readImageHeader(bytes);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::string word(uint32_t value) {
  return {char(value), char(value >> 8), char(value >> 16), char(value >> 24)};
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + word(uint32_t(value.size())) + value;
}

std::string window(uint32_t left, uint32_t top, uint32_t right, uint32_t bottom) {
  return word(left) + word(top) + word(right) + word(bottom);
}

/// An OpenEXR header of one channel, and `rest` behind it.
Bytes exr(const std::string& dataWindow, const std::string& displayWindow, const std::string& rest,
          uint32_t version = 2, const std::string& more = "") {
  const std::string channel = std::string("Y") + '\0' + word(2) + word(0) + word(1) + word(1) + '\0';
  const std::string text = "\x76\x2f\x31\x01" + word(version) + attribute("channels", "chlist", channel) +
                           attribute("compression", "compression", std::string(1, '\3')) +
                           attribute("dataWindow", "box2i", dataWindow) +
                           attribute("displayWindow", "box2i", displayWindow) + more + '\0' + rest;
  return {text.begin(), text.end()};
}

Bytes bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

void expectSize(std::span<const uint8_t> bytes, int width, int height) {
  const ImageHeader header = readImageHeader(bytes);
  EXPECT_EQ(header.width, width);
  EXPECT_EQ(header.height, height);
}

TEST(ImageHeaders, SayTheSizeThatTheDecoderFinds) {
  expectSize(samples::kRgba8Png, 2, 1);
  expectSize(samples::kGradientPng, 32, 32);
  expectSize(samples::kGreyJpeg, 8, 8);
  expectSize(samples::kProgressiveJpeg, 32, 32);
  expectSize(samples::kRgbaWebP, 2, 1);
  expectSize(bytesOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n12345678"), 1, 2);
  expectSize(bytesOf("#?RADIANCE\n\n-X 2 +Y 1\n12345678"), 2, 1);
  expectSize(exr(window(0, 0, 19, 9), window(0, 0, 31, 15), std::string(16, 'x')), 32, 16);
}

TEST(ImageHeaders, AnOpenExrOf54BytesThatAsksForGigabytesIsRefused) {
  const std::string start = "\x76\x2f\x31\x01" + word(2) + std::string("channels\0chlist\0", 16);
  for (const uint32_t size : {0x7fffffffu, 0xffffffffu, 0xfffffff0u}) {
    std::string text = start + word(size);
    text.resize(54, 'x');
    EXPECT_EQ(refusalOf(bytesOf(text)), "the OpenEXR header is wrong or truncated");
  }
  // The window of a header that is whole: 16,384 x 16,384 floats in a few bytes.
  const std::string large = window(0, 0, 16383, 16383);
  EXPECT_EQ(refusalOf(exr(large, large, std::string(1000, 'x'))), "the file is truncated");
  EXPECT_EQ(refusalOf(exr(large, large, std::string(1024 * 16, 'x'))), "");
}

TEST(ImageHeaders, OpenExrWindowsThatWrapRoundOrLieOutsideAreRefused) {
  const std::string rest(4096, 'x');
  const std::string good = window(0, 0, 15, 15);
  for (const std::string& bad :
       {window(0x80000000, 0, 0x7fffffff, 15), window(5, 5, 4, 4), window(0, 0, 0xffffffff, 0xffffffff),
        window(0x7fffffff, 0, 0x80000000, 0), std::string("short")}) {
    EXPECT_NE(refusalOf(exr(bad, good, rest)), "");
    EXPECT_NE(refusalOf(exr(good, bad, rest)), "");
  }
  EXPECT_EQ(refusalOf(exr(window(0, 0, 16, 15), good, rest)), "");
  EXPECT_EQ(readImageHeader(exr(window(0, 0, 16, 15), good, rest)).overscan, glm::ivec2(17, 16));
  EXPECT_EQ(refusalOf(exr(window(16, 0, 16, 15), good, rest)),
            "its data window is outside of its display window");
  EXPECT_EQ(refusalOf(exr(good, good, rest, 2 | 0x800)), "deep OpenEXR pictures are not supported");
  EXPECT_NE(refusalOf(exr(good, good, rest, 2 | 0x200)), "");
  EXPECT_NE(
      refusalOf(exr(good, good, rest, 2 | 0x200, attribute("tiles", "tiledesc", word(0) + word(0) + "x"))),
      "");
}

TEST(ImageHeaders, HdrLinesMustBeThere) {
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  EXPECT_EQ(refusalOf(bytesOf(head + "-Y 100000 +X 1\nxxxx")), "the file is truncated");
  EXPECT_NE(refusalOf(bytesOf(head + "-Y 100000 +X 100000\n" + std::string(400000, 'x'))), "");
  for (const char* resolution :
       {"-Y -5 +X 5\n", "-Y 5\n", "+X 5 -X 5\n", "-Z 5 +X 5\n", "-Y 99999999999 +X 1\n", "\n", "-Y +X\n"})
    EXPECT_NE(refusalOf(bytesOf(head + resolution + std::string(100, 'x'))), "") << resolution;
  EXPECT_NE(refusalOf(bytesOf("#?RADIANCE\n")), "");
}

TEST(ImageHeaders, AJpegOfThousandsOfEmptyScansIsRefused) {
  // 38 kB: each scan is 10 bytes, and would go over 268 million pixels.
  const auto marker = [](int kind, const std::string& body) {
    const size_t size = body.size() + 2;
    return std::string{char(0xff), char(kind), char(size >> 8), char(size)} + body;
  };
  const std::string frame = marker(0xc2, std::string("\x08\x40\x00\x40\x00\x01\x01\x11\x00", 9));
  std::string text = "\xff\xd8" + frame;
  const auto scan = marker(0xda, std::string("\x01\x01\x00\x01\x01\x00", 6));
  EXPECT_EQ(refusalOf(bytesOf(text + scan + "\xff\xd9")), "");
  for (int i = 0; i < 3800; ++i) text += scan;
  EXPECT_EQ(refusalOf(bytesOf(text + "\xff\xd9")), "3800 scans over 16384 x 16384 pixels are not supported");
}

TEST(ImageHeaders, AnyByteOfAHeaderMayBeAnything) {
  std::mt19937 random(1);
  const std::vector<Bytes> seeds = {
      Bytes(std::begin(samples::kRgba8Png), std::end(samples::kRgba8Png)),
      Bytes(std::begin(samples::kProgressiveJpeg), std::end(samples::kProgressiveJpeg)),
      Bytes(std::begin(samples::kRgbaWebP), std::end(samples::kRgbaWebP)),
      bytesOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n12345678"),
      bytesOf("PF\n2 1\n-1.0\n012345678901234567890123"),
      exr(window(0, 0, 19, 9), window(0, 0, 31, 15), std::string(16, 'x'))};
  for (const Bytes& seed : seeds) {
    for (int round = 0; round < 2000; ++round) {
      Bytes changed = seed;
      for (int i = 0; i < 3; ++i) changed[random() % changed.size()] = uint8_t(random());
      changed.resize(round % 2 == 0 ? changed.size() : random() % changed.size() + 1);
      try {
        const ImageHeader header = readImageHeader(changed);
        EXPECT_GT(header.width, 0);
        EXPECT_GT(header.height, 0);
        EXPECT_LE(int64_t(header.width) * header.height, kMaximumPixels);
      } catch (const std::runtime_error&) {
        continue;
      }
    }
  }
}

TEST(MemoryBudgets, CountWithoutWrappingRound) {
  MemoryBudget budget(1000);
  budget.take(600);
  EXPECT_EQ(budget.left(), 400U);
  EXPECT_THROW(budget.take(401), std::runtime_error);
  EXPECT_THROW(budget.take(UINT64_MAX), std::runtime_error);
  EXPECT_THROW(budget.take(UINT64_MAX - 599), std::runtime_error);
  budget.take(400);
  EXPECT_EQ(budget.left(), 0U);
}

using ImageLimits = ImageTestFolder;

TEST_F(ImageLimits, APictureLargerThanTheMemoryLimitIsRefusedByName) {
  replaceFile(folder / "a.png", samples::kGradientPng);
  EXPECT_EQ(readImage(folder / "a.png", 20000).width, 32);
  try {
    readImage(folder / "a.png", 16000);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a.png"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("--memory-limit"), std::string::npos) << error.what();
  }
}

TEST_F(ImageLimits, DevicesAreNotRead) { EXPECT_THROW(readWholeFile("/dev/zero"), InputError); }

}  // namespace
}  // namespace fragtrace
