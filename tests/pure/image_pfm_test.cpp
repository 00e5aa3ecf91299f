// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "image/files/pfm.h"

namespace fragtrace {
namespace {

std::vector<uint8_t> fileOf(const std::string& text) { return {text.begin(), text.end()}; }

// 1.0f, 2.0f, -0.5f as big-endian bytes
const std::string kBigOne("\x3f\x80\0\0", 4), kBigTwo("\x40\0\0\0", 4), kBigMinusHalf("\xbf\0\0\0", 4);
const std::string kLittleOne("\0\0\x80\x3f", 4), kLittleTwo("\0\0\0\x40", 4), kLittleThree("\0\0\x40\x40", 4);

TEST(ImagePfm, BigEndianColourIsReadBottomRowFirst) {
  const Image image =
      decodePfm(fileOf("PF\n1 2\n1.0\n" + kBigOne + kBigTwo + kBigMinusHalf + kBigTwo + kBigTwo + kBigOne));
  EXPECT_EQ(image.width, 1);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(image.values, (std::vector<float>{2, 2, 1, 1, 2, -0.5F}));
}

TEST(ImagePfm, LittleEndianGreyIsRead) {
  const Image image = decodePfm(fileOf("Pf 2 1 -1e0\n" + kLittleTwo + kLittleOne));
  EXPECT_EQ(image.channels, (std::vector<std::string>{"Y"}));
  EXPECT_EQ(image.values, (std::vector<float>{2, 1}));
}

TEST(ImagePfm, ValuesAreMultipliedByTheScale) {
  EXPECT_EQ(decodePfm(fileOf("Pf 2 1 -2.5\n" + kLittleTwo + kLittleOne)).values,
            (std::vector<float>{5, 2.5}));
}

TEST(ImagePfm, DataThatLooksLikeWhiteSpaceIsKept) {
  const Image image = decodePfm(fileOf("Pf\n1 1\n-1\n" + std::string("\n\n\n\n")));
  EXPECT_EQ(image.values.size(), 1U);
  EXPECT_EQ(decodePfm(fileOf("Pf\r\n1 1\r\n-1\r\n" + kLittleTwo)).values[0], 2);
}

TEST(ImagePfm, WrittenBytesAreTheFormat) {
  const Image image{1, 2, {"Y"}, {1, 2}, {}};
  EXPECT_EQ(encodePfm(image), fileOf("Pf\n1 2\n-1.0\n" + kLittleTwo + kLittleOne));
}

TEST(ImagePfm, EveryFloatSurvivesAndAlphaIsDropped) {
  const float infinity = std::numeric_limits<float>::infinity();
  const Image image{1, 2, {"A", "B", "G", "R"}, {9, 1e-40F, 3e38F, -0.0F, 9, infinity, -1.1F, 0.1F}, {}};
  const Image read = decodePfm(encodePfm(image));
  EXPECT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(read.values, (std::vector<float>{-0.0F, 3e38F, 1e-40F, 0.1F, -1.1F, infinity}));
  EXPECT_TRUE(std::signbit(read.values[0]));
  EXPECT_TRUE(std::isnan(decodePfm(encodePfm({1, 1, {"Y"}, {std::nanf("")}, {}})).values[0]));
}

TEST(ImagePfm, WrongHeadersAndMissingValuesAreErrors) {
  for (const char* header : {"", "PF", "PF\n", "PF\n1 1\n", "PF\n1 1\n-1.0"})
    EXPECT_THROW(decodePfm(fileOf(header)), std::runtime_error) << header;
  for (const std::string header :
       {"PG\n1 1\n-1.0\n", "Pf\n0 1\n-1.0\n", "Pf\n-1 -1\n-1.0\n", "Pf\n1 1\n0\n", "Pf\n1 1\nnan\n",
        "Pf\n1x 1\n-1.0\n", "Pf\n1,0 1\n-1.0\n", "Pf\n99999999999 1\n-1.0\n",
        "Pf\n2147483647 2147483647\n-1.0\n", "Pf\n16384 16384\n-1.0\n", "Pf\n2 1\n-1.0\n", "PF\n1 1\n-1.0\n"})
    EXPECT_THROW(decodePfm(fileOf(header + kBigOne)), std::runtime_error) << header;
}

TEST(ImagePfm, LocaleDoesNotChangeTheNumbers) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const bool comma = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  const Image image = decodePfm(fileOf("Pf\n1 1\n-1.5\n" + kLittleTwo));
  const std::vector<uint8_t> written = encodePfm(image);
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(image.values[0], 3) << "comma locale: " << comma;
  EXPECT_EQ(written, fileOf("Pf\n1 1\n-1.0\n" + kLittleThree));
}

}  // namespace
}  // namespace fragtrace
