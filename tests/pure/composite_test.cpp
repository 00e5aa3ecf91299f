// SPDX-License-Identifier: MIT
#include "view/pictures.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

Image filled(int width, int height, const std::vector<float>& texel) {
  Image image{width, height, {"R", "G", "B"}, {}, {}};
  if (texel.size() > 3) image.channels.emplace_back("A");
  for (int i = 0; i < width * height; ++i)
    image.values.insert(image.values.end(), texel.begin(), texel.end());
  return image;
}

std::vector<float> texel(const Image& image, int x, int y) {
  const auto first = image.values.begin() +
                     std::ptrdiff_t((size_t(y) * size_t(image.width) + size_t(x)) * image.channelCount());
  return {first, first + std::ptrdiff_t(image.channelCount())};
}

TEST(Composite, TheBarPartsTheSides) {
  const std::array<ComposedSide, 2> sides{ComposedSide{filled(8, 4, {0.1f, 0.2f, 0.3f})},
                                          ComposedSide{filled(8, 4, {0.5f, 0.25f, 0.125f})}};
  const Image both = composite(sides, {8, 4}, {.bar = 0.25, .exposure = 1.0, .toneMap = ToneMap::Linear});
  EXPECT_EQ(texel(both, 1, 3), (std::vector<float>{0.2f, 0.4f, 0.6f}));
  EXPECT_EQ(texel(both, 2, 0), (std::vector<float>{1.0f, 0.5f, 0.25f}));
  EXPECT_EQ(both.channelCount(), 3u);
  const Image right = composite(sides, {8, 4}, {.bar = 0.0, .toneMap = ToneMap::Linear});
  EXPECT_EQ(texel(right, 0, 0), (std::vector<float>{0.5f, 0.25f, 0.125f}));
}

TEST(Composite, APictureOfAnotherSizeIsScaled) {
  Image small{2, 1, {"R", "G", "B"}, {0.1f, 0.1f, 0.1f, 0.9f, 0.9f, 0.9f}, {}};
  const std::array<ComposedSide, 2> sides{ComposedSide{filled(4, 2, {0.0f, 0.0f, 0.0f})},
                                          ComposedSide{small}};
  const Image both = composite(sides, {4, 2}, {.bar = 0.0, .toneMap = ToneMap::Linear});
  EXPECT_EQ(texel(both, 1, 1)[0], 0.1f);
  EXPECT_EQ(texel(both, 2, 1)[0], 0.9f);
}

TEST(Composite, TheDifferenceIsOfRadianceWhateverTheExposure) {
  const std::array<ComposedSide, 2> sides{ComposedSide{filled(2, 2, {0.5f, 0.1f, 0.0f})},
                                          ComposedSide{filled(2, 2, {0.25f, 0.35f, 0.0f})}};
  const Image apart = composite(sides, {2, 2}, {.difference = true, .differenceStops = 1.0, .exposure = 3.0});
  EXPECT_FLOAT_EQ(texel(apart, 0, 0)[0], 0.5f);
  EXPECT_FLOAT_EQ(texel(apart, 0, 0)[1], 0.5f);
  EXPECT_EQ(texel(apart, 0, 0)[2], 0.0f);
}

TEST(Composite, RadianceAndColoursOfADisplayDifferAsTheyAreShown) {
  const std::array<ComposedSide, 2> sides{ComposedSide{filled(2, 2, {0.25f, 0.0f, 2.0f})},
                                          ComposedSide{filled(2, 2, {0.5f, 1.0f, 1.0f}), true}};
  const Image apart =
      composite(sides, {2, 2},
                {.difference = true, .differenceStops = -1.0, .exposure = 1.0, .toneMap = ToneMap::Linear});
  EXPECT_EQ(texel(apart, 0, 0), (std::vector<float>{0.0f, 0.5f, 0.0f}));
}

TEST(Composite, DebugColoursStayAndCoverageIsKept) {
  const std::array<ComposedSide, 2> sides{ComposedSide{filled(2, 1, {0.5f, 0.5f, 0.5f}), true},
                                          ComposedSide{filled(2, 1, {0.25f, 0.0f, 0.0f, 0.5f})}};
  const Image both = composite(sides, {2, 1}, {.bar = 0.5, .exposure = 1.0, .toneMap = ToneMap::Linear});
  EXPECT_EQ(texel(both, 0, 0), (std::vector<float>{0.5f, 0.5f, 0.5f, 1.0f}));
  // Premultiplied: 0.5 of full coverage, times 2.
  EXPECT_EQ(texel(both, 1, 0), (std::vector<float>{0.5f, 0.0f, 0.0f, 0.5f}));
}

}  // namespace
}  // namespace fragtrace
