// SPDX-License-Identifier: MIT
#include "image/files/process.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "base/errors.h"
#include "image/files/whole_file.h"
#include "image_samples.h"
#include "image_test_folder.h"

namespace fragtrace {
namespace {

using DecodeEach = ImageTestFolder;

/// A grey picture as a file.
std::vector<uint8_t> greyPng(const std::filesystem::path& folder, int width, int height) {
  Image image{width, height, {"R", "G", "B"}, {}, {}};
  image.values.assign(size_t(width) * size_t(height) * 3, 0.5f);
  writeImage(folder / "grey.png", image);
  return readWholeFile(folder / "grey.png", defaultMemoryLimit());
}

TEST_F(DecodeEach, APictureIsThatOfItsIndexAndOneThatIsBrokenStopsNoOther) {
  const std::vector<uint8_t> broken(samples::kGradientPng.begin(), samples::kGradientPng.begin() + 200);
  const std::vector<EncodedPicture> pictures{{samples::kRgba8Png, "a.png"},
                                             {broken, "b.png"},
                                             {samples::kGradientJpeg, "c.jpg"},
                                             {samples::kRgb16Png, "d.png"}};
  std::vector<TexelImage> taken(pictures.size());
  const std::vector<std::string> errors =
      decodeEach(pictures, [&](size_t i, TexelImage texels) { taken[i] = std::move(texels); });
  ASSERT_EQ(errors.size(), pictures.size());
  for (const size_t i : {0, 2, 3}) {
    const TexelImage alone = decodeTexels(pictures[i].bytes, pictures[i].name);
    EXPECT_EQ(errors[i], "");
    EXPECT_EQ(taken[i].width, alone.width);
    std::visit(
        [&](const auto& values) {
          EXPECT_TRUE(std::ranges::equal(values, std::get<std::decay_t<decltype(values)>>(taken[i].rgba)));
        },
        alone.rgba);
  }
  EXPECT_EQ(errors[1], "cannot read the picture b.png: the file is truncated");
  EXPECT_EQ(taken[1].width, 0);
}

TEST_F(DecodeEach, TheLargestComesFirstAndSmallOnesShareAProcess) {
  std::vector<std::vector<uint8_t>> files;
  for (const int side : {3, 50, 2, 20}) files.push_back(greyPng(folder, side, 200));
  std::vector<EncodedPicture> pictures;
  for (const auto& file : files) pictures.push_back({file, "grey.png"});
  std::vector<size_t> order;
  decodeEach(pictures, [&](size_t i, const TexelImage&) { order.push_back(i); });
  EXPECT_EQ(order, (std::vector<size_t>{1, 3, 0, 2}));
}

TEST_F(DecodeEach, LargePicturesAreDecodedAtTheSameTime) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one processor";
  const std::vector<uint8_t> file = greyPng(folder, 2048, 2048);
  const std::vector<EncodedPicture> pictures{{file, "a.png"}, {file, "b.png"}};
  std::mutex mutex;
  std::condition_variable came;
  int count = 0, met = 0;
  decodeEach(pictures, [&](size_t, const TexelImage&) {
    std::unique_lock lock(mutex);
    ++count;
    came.notify_all();
    met += came.wait_for(lock, std::chrono::seconds(20), [&] { return count == 2; }) ? 1 : 0;
  });
  EXPECT_EQ(met, 2);
}

TEST_F(DecodeEach, NoMoreThanTheLimitExistAtOnce) {
  const std::vector<uint8_t> file = greyPng(folder, 2048, 2048);
  const std::vector<EncodedPicture> pictures(4, {file, "a.png"});
  std::atomic<int> alive = 0, most = 0;
  const auto take = [&](size_t, const TexelImage&) {
    most = std::max<int>(most, ++alive);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    --alive;
  };
  decodeEach(pictures, take, 30'000'000);  // one has 16.8 MB
  EXPECT_EQ(most, 1);
}

TEST_F(DecodeEach, WhatTakingThrowsIsThrown) {
  const std::vector<EncodedPicture> pictures(3, {samples::kRgba8Png, "a.png"});
  EXPECT_THROW(decodeEach(pictures, [](size_t, const TexelImage&) { throw std::length_error("full"); }),
               std::length_error);
}

}  // namespace
}  // namespace fragtrace
