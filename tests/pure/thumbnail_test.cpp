// SPDX-License-Identifier: MIT
#include "view/pictures.h"

#include <gtest/gtest.h>

#include "base/errors.h"

namespace fragtrace {
namespace {

/// Left half of one colour, right half of another.
Image twoHalves(int width, int height, float left, float right) {
  Image map{width, height, {"R", "G", "B"}, {}, {}};
  for (int i = 0; i < width * height; ++i) {
    const float value = i % width < width / 2 ? left : right;
    map.values.insert(map.values.end(), {value, 0.5f * value, 0.0f});
  }
  return map;
}

TEST(Thumbnail, ShowsAMapOfAnySizeInItsPlaces) {
  for (const int width : {2, 64, 1000}) {
    const Image small = thumbnailOf(twoHalves(width, 3, 0.1f, 0.4f));
    ASSERT_EQ(small.width, kThumbnailSize.x);
    ASSERT_EQ(small.height, kThumbnailSize.y);
    const size_t row = size_t(5 * kThumbnailSize.x) * 3;
    EXPECT_GT(small.values[row + 60 * 3], small.values[row + 3] + 0.1f);
    EXPECT_GT(small.values[row], small.values[row + 1]);
    for (const float value : small.values) EXPECT_TRUE(value >= 0.0f && value <= 1.0f);
  }
}

TEST(Thumbnail, IsAsBrightWhateverTheMap) {
  const Image dim = thumbnailOf(twoHalves(64, 32, 0.001f, 0.002f));
  const Image bright = thumbnailOf(twoHalves(64, 32, 0.1f, 0.2f));
  for (size_t i = 0; i < dim.values.size(); ++i) EXPECT_NEAR(dim.values[i], bright.values[i], 1e-3);
}

TEST(Thumbnail, NeedsColour) {
  EXPECT_THROW(thumbnailOf(Image{1, 1, {"X", "Q"}, {1.0f, 1.0f}, {}}), RenderError);
}

}  // namespace
}  // namespace fragtrace
