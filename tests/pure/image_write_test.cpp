// SPDX-License-Identifier: MIT
// Round trips of every written format, and what is left behind when writing fails.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <thread>
#include <utility>

#include "base/errors.h"
#include "image/channels.h"
#include "image/files/process.h"
#include "image/files/whole_file.h"
#include "image/image.h"
#include "image_test_folder.h"

namespace fragtrace {
namespace {

using ImageWrite = ImageTestFolder;
using Names = std::vector<std::string>;

/// Smooth in 0..1, different in every channel and pixel.
Image smoothPicture(int width, int height, Names channels) {
  Image image{width, height, std::move(channels), {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (size_t c = 0; c < image.channelCount(); ++c)
        image.values.push_back(0.5F + 0.5F * std::sin(0.21F * float(x) + 0.13F * float(y) + 1.7F * float(c)));
  return image;
}

float largestDifference(const Image& a, const Image& b) {
  EXPECT_EQ(a.values.size(), b.values.size());
  float largest = 0;
  for (size_t i = 0; i < std::min(a.values.size(), b.values.size()); ++i)
    largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
  return largest;
}

Image written(const std::filesystem::path& path, const Image& image) {
  writeImage(path, image);
  return readImage(path);
}

TEST_F(ImageWrite, ExrKeepsEveryFloatEveryChannelAndTheAttributes) {
  Image image = smoothPicture(33, 17, {"R", "G", "B", "A", "albedo.R", "depth.Z"});
  image.values[0] = 1e-40F;
  image.values[1] = -3e38F;
  image.values[2] = std::numeric_limits<float>::infinity();
  image.attributes = {{"fragtrace:scene", "Cornell box, ä"}, {"fragtrace:note", "two\nlines"}};
  const Image read = written(folder / "a.exr", image);
  ASSERT_EQ(read.width, 33);
  ASSERT_EQ(read.height, 17);
  for (size_t c = 0; c < image.channelCount(); ++c) {
    const auto found = findChannel(read, image.channels[c]);
    ASSERT_TRUE(found) << image.channels[c];
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 33; ++x)
        ASSERT_EQ(read.pixel(x, y)[*found], image.pixel(x, y)[c]) << image.channels[c];
  }
  EXPECT_EQ(read.attributes.at("fragtrace:scene"), "Cornell box, ä");
  EXPECT_EQ(read.attributes.at("fragtrace:note"), "two\nlines");
}

TEST_F(ImageWrite, ExrKeepsTheNumbersOfItsHeaderWithTheirStandardTypes) {
  Image image = smoothPicture(4, 4, {"R", "G", "B"});
  std::vector<float> matrix(16);
  for (size_t i = 0; i < matrix.size(); ++i) matrix[i] = 0.1F * float(i) - 1e-7F;
  image.numbers = {{"worldToCamera", matrix},
                   {"worldToNDC", std::vector<float>(16, 1 / 3.0F)},
                   {"chromaticities", {0.64F, 0.33F, 0.3F, 0.6F, 0.15F, 0.06F, 0.3127F, 0.329F}},
                   {"screenWindowWidth", {1.25F}}};
  EXPECT_EQ(written(folder / "a.exr", image).numbers, image.numbers);
  const auto bytes = readWholeFile(folder / "a.exr");
  const std::string text(bytes.begin(), bytes.end());
  for (const std::string& entry :
       {std::string("worldToCamera\0m44f\0\x40", 20), std::string("worldToNDC\0m44f\0", 16),
        std::string("chromaticities\0chromaticities\0", 30)}) {
    EXPECT_NE(text.find(entry), std::string::npos) << entry;
  }
}

TEST_F(ImageWrite, ExrHoldsThirtyTwoBitFloatsZipped) {
  writeImage(folder / "a.exr", smoothPicture(4, 4, {"R", "G", "B"}));
  const auto bytes = readWholeFile(folder / "a.exr");
  const std::string text(bytes.begin(), bytes.end());
  const size_t compression = text.find(std::string("compression\0compression\0\1\0\0\0", 28));
  ASSERT_NE(compression, std::string::npos);
  EXPECT_EQ(text[compression + 28], 3);  // ZIP_COMPRESSION
  const size_t red = text.find(std::string("R\0\2\0\0\0", 6));
  EXPECT_NE(red, std::string::npos);  // channel R of pixel type FLOAT
}

/// The pixel types of an .exr by channel: 1 half, 2 float.
std::map<std::string, int> pixelTypes(const std::filesystem::path& path, const Names& channels) {
  const auto bytes = readWholeFile(path);
  const std::string text(bytes.begin(), bytes.end());
  std::map<std::string, int> types;
  for (const std::string& channel : channels) {
    const size_t at = text.find('\0' + channel + '\0');
    if (at != std::string::npos) types[channel] = uint8_t(text[at + channel.size() + 2]);
  }
  return types;
}

/// To the nearest of 11 binary digits, of which the last is no less than 2^-24; a half between two goes to
/// the even.
float nearestHalf(float value) {
  const int exponent = std::max(std::ilogb(value), -14) - 10;
  return std::ldexp(std::nearbyint(std::ldexp(value, -exponent)), exponent);
}

TEST_F(ImageWrite, HalfExrRoundsColoursToTheNearestHalfAndKeepsTheRest) {
  const Names channels{"R",
                       "G",
                       "B",
                       "A",
                       "albedo.G",
                       "normal.X",
                       "depth.Z",
                       "samples.Y",
                       "noisy.B",
                       "roughness.Y",
                       "denoising.depth.Z",
                       "texcoords.U",
                       "variance.Y",
                       "CryptoObject00.R",
                       "denoising.normal.Z"};
  const Image image = smoothPicture(19, 7, channels);
  EXPECT_EQ(writeImage(folder / "a.exr", image, {true, 8}), 0U);
  const Image read = readImage(folder / "a.exr");
  const auto types = pixelTypes(folder / "a.exr", channels);
  for (size_t c = 0; c < channels.size(); ++c) {
    const bool half = isStoredAsHalf(channels[c]);
    EXPECT_EQ(types.at(channels[c]), half ? 1 : 2) << channels[c];
    const size_t found = findChannel(read, channels[c]).value();
    for (int y = 0; y < 7; ++y) {
      for (int x = 0; x < 19; ++x) {
        const float exact = image.pixel(x, y)[c];
        const float expected = half ? nearestHalf(exact) : exact;
        ASSERT_EQ(read.pixel(x, y)[found], expected) << channels[c];
      }
    }
  }
  const std::map<std::string, int> wanted{{"depth.Z", 2},
                                          {"samples.Y", 2},
                                          {"denoising.depth.Z", 2},
                                          {"variance.Y", 2},
                                          {"CryptoObject00.R", 2},
                                          {"texcoords.U", 2},
                                          {"R", 1},
                                          {"noisy.B", 1},
                                          {"A", 1},
                                          {"denoising.normal.Z", 1},
                                          {"roughness.Y", 1}};
  for (const auto& [channel, type] : wanted) EXPECT_EQ(types.at(channel), type) << channel;
}

TEST_F(ImageWrite, HalfExrClampsWhatIsTooLargeAndCountsIt) {
  const float infinity = std::numeric_limits<float>::infinity();
  const Image image{
      2, 1, {"R", "G", "B", "depth.Z"}, {65504, 65519, 1e6F, 1e9F, -infinity, -7e4F, 2, 65520}, {}};
  EXPECT_EQ(writeImage(folder / "a.exr", image, {true, 8}), 4U);
  const Image read = readImage(folder / "a.exr");
  EXPECT_EQ(read.values, (std::vector<float>{65504, 65504, 65504, 1e9F, -65504, -65504, 2, 65520}));
  EXPECT_EQ(writeImage(folder / "a.exr", image), 0U);
}

TEST_F(ImageWrite, PngOfSixteenBitsIsWithinHalfAStep) {
  const Image image = smoothPicture(31, 9, {"R", "G", "B", "A"});
  writeImage(folder / "a.png", image, {false, 16});
  EXPECT_EQ(readWholeFile(folder / "a.png")[24], 16);  // the bit depth in IHDR
  const Image read = readImage(folder / "a.png");
  EXPECT_EQ(read.channels, image.channels);
  EXPECT_LE(largestDifference(read, image), 0.5F / 65535 + 1e-7F);
}

TEST_F(ImageWrite, PfmKeepsEveryFloat) {
  const Image image = smoothPicture(7, 5, {"R", "G", "B"});
  EXPECT_EQ(written(folder / "a.pfm", image).values, image.values);
}

TEST_F(ImageWrite, HdrIsWithinHalfAStepOfItsMantissaAndUnbiased) {
  Image image = smoothPicture(64, 9, {"R", "G", "B", "A"});
  for (size_t i = 0; i < image.values.size(); ++i)
    if (i % 4 != 3) image.values[i] *= std::ldexp(1.0F, int(i / 4 % 24) - 12);
  const Image read = written(folder / "a.hdr", image);
  EXPECT_EQ(read.channels, (Names{"R", "G", "B"}));
  double errorSum = 0;
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float* exact = image.pixel(x, y);
      const float peak = std::max({exact[0], exact[1], exact[2]});
      for (size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(read.pixel(x, y)[c], exact[c], peak / 256 * 1.0001F);
        errorSum += (read.pixel(x, y)[c] - exact[c]) / peak;
      }
    }
  }
  EXPECT_NEAR(errorSum / (64 * 9 * 3), 0, 2e-4);
}

TEST_F(ImageWrite, HdrTurnsWhatItCannotHoldIntoBlack) {
  const float infinity = std::numeric_limits<float>::infinity();
  const Image read =
      written(folder / "a.hdr", {2, 1, {"R", "G", "B"}, {-1, std::nanf(""), 0.5F, infinity, 0, 0}, {}});
  EXPECT_EQ(read.values[0], 0);
  EXPECT_EQ(read.values[1], 0);
  EXPECT_EQ(read.values[2], 0.5F);
  EXPECT_GT(read.values[3], 9e37F);
}

TEST_F(ImageWrite, PngIsWithinHalfAStepAndKeepsUnassociatedAlpha) {
  const Image image = smoothPicture(31, 9, {"R", "G", "B", "A"});
  const Image read = written(folder / "a.png", image);
  EXPECT_EQ(read.channels, image.channels);
  EXPECT_LE(largestDifference(read, image), 1.0F / 510 + 1e-6F);
}

TEST_F(ImageWrite, PngClampsAndTurnsNanIntoBlack) {
  const Image read =
      written(folder / "a.png", {2, 1, {"R", "G", "B"}, {-1, 2, std::nanf(""), 1, 0, 0.5F}, {}});
  const std::vector<float> expected{0, 1, 0, 1, 0, 128.0F / 255};
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(read.values[i], expected[i], 1e-6F);
}

TEST_F(ImageWrite, JpegIsLooselyThePictureWithoutAlpha) {
  const Image image = smoothPicture(64, 48, {"R", "G", "B", "A"});
  const Image read = written(folder / "a.jpg", image);
  EXPECT_EQ(read.channels, (Names{"R", "G", "B"}));
  EXPECT_LE(largestDifference(read, withoutAlpha(image)), 0.05F);
}

TEST_F(ImageWrite, GreyPictureBecomesRgbInPng) {
  const Image read = written(folder / "a.png", {2, 1, {"Y"}, {0, 1}, {}});
  EXPECT_EQ(read.values, (std::vector<float>{0, 0, 0, 1, 1, 1}));
}

TEST_F(ImageWrite, SamePictureGivesTheSameBytes) {
  const Image image = smoothPicture(8, 8, {"R", "G", "B"});
  const char* names[] = {"a.png", "a.jpg", "a.exr", "a.hdr", "a.pfm"};
  for (const char* name : names) writeImage(folder / name, image);
  std::this_thread::sleep_for(
      std::chrono::milliseconds(1100));  // a time of writing in the file would now differ
  for (const char* name : names) {
    const auto first = readWholeFile(folder / name);
    writeImage(folder / name, image);
    EXPECT_EQ(first, readWholeFile(folder / name)) << name;
  }
}

TEST_F(ImageWrite, NamesWithSpacesUnicodeAnyCaseAndFullLengthWork) {
  const Image image = smoothPicture(4, 4, {"R", "G", "B"});
  for (const std::string& name : {std::string("ein Bild – 画像 😀.PNG"), std::string(".png.JPEG"),
                                  std::string(251, 'x') + ".exr", std::string("%s%n.hdr")}) {
    EXPECT_TRUE(isWritableImageName(name)) << name;
    EXPECT_EQ(written(folder / name, image).width, 4) << name;
  }
  EXPECT_EQ(fileCount(), 4U);
}

TEST_F(ImageWrite, RelativeNameIsWrittenIntoTheCurrentFolder) {
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder);
  writeImage("a.pfm", smoothPicture(2, 2, {"R", "G", "B"}));
  std::filesystem::current_path(before);
  EXPECT_TRUE(std::filesystem::exists(folder / "a.pfm"));
}

TEST_F(ImageWrite, EveryTruncatedExrHdrAndPfmIsRefused) {
  // One block of an EXR holds 16 rows; several are needed for a file that only lacks the last.
  const Image image = smoothPicture(40, 40, {"R", "G", "B"});
  for (const char* name : {"a.exr", "a.hdr", "a.pfm"}) {
    writeImage(folder / name, image);
    const auto bytes = readWholeFile(folder / name);
    for (const double part : {0.0, 0.05, 0.2, 0.5, 0.9, 0.99, 0.9999}) {
      replaceFile(folder / "cut", std::span(bytes).first(size_t(part * double(bytes.size()))));
      EXPECT_THROW(readImage(folder / "cut"), InputError) << name << " cut to " << part;
    }
  }
}

TEST_F(ImageWrite, FailureNamesPathAndReasonAndLeavesNothing) {
  const Image image = smoothPicture(4, 4, {"R", "G", "B"});
  std::filesystem::create_directory(folder / "folder.png");
  std::ofstream(folder / "file") << "x";
  const std::pair<std::filesystem::path, std::string> cases[] = {
      {folder / "missing" / "a.png", "No such file or directory"},
      {folder / "file" / "a.exr", "Not a directory"},
      {folder / "folder.png", "Is a directory"},
      {folder / (std::string(300, 'x') + ".hdr"), "File name too long"},
      {folder / "a.bmp", ".png"},
  };
  for (const auto& [path, reason] : cases) {
    try {
      writeImage(path, image);
      FAIL() << path;
    } catch (const RenderError& error) {
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(fileCount(), 2U);
}

TEST_F(ImageWrite, PictureThatDoesNotFillItsSizeIsRefused) {
  EXPECT_THROW(writeImage(folder / "a.png", {2, 2, {"R", "G", "B"}, {1, 2, 3}, {}}), RenderError);
  EXPECT_THROW(writeImage(folder / "a.png", {}), RenderError);
  EXPECT_THROW(writeImage(folder / "a.png", {1, 1, {"u", "v"}, {1, 2}, {}}), RenderError);
  EXPECT_EQ(fileCount(), 0U);
}

TEST_F(ImageWrite, ExistingFileSurvivesAWriteThatRunsOutOfSpace) {
  for (const char* name : {"a.png", "a.jpg", "a.exr", "a.hdr", "a.pfm"}) {
    writeImage(folder / name, smoothPicture(4, 4, {"R", "G", "B"}));
    const auto before = readWholeFile(folder / name);

    // A limit on the file size stands for the full disk.
    rlimit old{};
    getrlimit(RLIMIT_FSIZE, &old);
    const rlimit limited{100, old.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limited);
    EXPECT_THROW(writeImage(folder / name, smoothPicture(64, 64, {"R", "G", "B"})), RenderError) << name;
    setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, handler);

    EXPECT_EQ(readWholeFile(folder / name), before) << name;
  }
  EXPECT_EQ(fileCount(), 5U);
}

TEST_F(ImageWrite, LibraryMayBeStartedWhileItIsFirstUsed) {
  std::thread preload(startImageProcess);
  EXPECT_EQ(written(folder / "a.png", smoothPicture(3, 2, {"R", "G", "B"})).width, 3);
  preload.join();
}

TEST_F(ImageWrite, RoomForTheFileIsAskedBefore) {
  const std::filesystem::path path = folder / "x.exr";
  EXPECT_NO_THROW(checkRoom(path, 1000));
  EXPECT_NO_THROW(checkRoom("/dev/null", UINT64_MAX));
  try {
    checkRoom(path, uint64_t(1) << 62);
    FAIL();
  } catch (const RenderError& error) {
    EXPECT_NE(std::string(error.what()).find("x.exr"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ImageNames, OnlyWrittenFormatsAreWritableAndOnlyEightBitOnesAreForDisplay) {
  for (const char* name : {"a.png", "a.JPG", "a.jpeg", "b/a.b.PnG"})
    EXPECT_TRUE(isWritableImageName(name) && isDisplayFormat(name)) << name;
  for (const char* name : {"a.exr", "a.HDR", "a.pfm"})
    EXPECT_TRUE(isWritableImageName(name) && !isDisplayFormat(name)) << name;
  for (const char* name : {"a.bmp", "a", "png", ".png", "a.png/b", "a.exr "})
    EXPECT_FALSE(isWritableImageName(name) || isDisplayFormat(name)) << name;
}

}  // namespace
}  // namespace fragtrace
