// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "image/display/heatmap.h"

namespace fragtrace {
namespace {

Image counts(int width, int height, float value) {
  Image image{width, height, {"R", "G", "B"}, {}, {}};
  image.values.assign(size_t(width) * size_t(height) * 3, value);
  return image;
}

TEST(Heatmap, ScaleEndsAtARoundNumberAboveTheCounts) {
  EXPECT_EQ(heatmapLimit(counts(10, 10, 37.0f)), 40.0);
  EXPECT_EQ(heatmapLimit(counts(10, 10, 100.0f)), 100.0);
  EXPECT_EQ(heatmapLimit(counts(10, 10, 0.0f)), 1.0);
  EXPECT_EQ(heatmapLimit(counts(10, 10, 93.0f)), 100.0);
}

TEST(Heatmap, FewCountsAreBlueManyRedAndTheCountsAreKept) {
  Image image = counts(100, 100, 0.0f);
  for (int x = 50; x < 100; ++x) {
    for (int y = 0; y < 100; ++y) *image.pixel(x, y) = 100.0f;
  }
  const Image painted = paintHeatmap(image);
  EXPECT_GT(painted.pixel(10, 10)[2], painted.pixel(10, 10)[0]);
  EXPECT_GT(painted.pixel(90, 10)[0], painted.pixel(90, 10)[2]);
  EXPECT_EQ(painted.channels.back(), "visits");
  EXPECT_EQ(painted.pixel(90, 10)[3], 100.0f);
}

/// The white cells of a part of the picture, a line per row.
std::string cells(const Image& image, int left, int top, int width, int height) {
  std::string text;
  for (int y = top; y < top + height; ++y) {
    for (int x = left; x < left + width; ++x) text += image.pixel(x, y)[1] == 1.0f ? '#' : '.';
    text += '\n';
  }
  return text;
}

TEST(Heatmap, NumbersOfTheScaleAreThoseOfTheirPlaces) {
  const Image painted = paintHeatmap(counts(200, 40, 5.0f));
  EXPECT_EQ(cells(painted, 42, 29, 16, 5),
            ".#......###.###.\n"
            "##........#.#...\n"
            ".#......###.###.\n"
            ".#......#.....#.\n"
            "###..#..###.###.\n");  // 1.25
  EXPECT_EQ(cells(painted, 196, 29, 4, 5), "###.\n#...\n###.\n..#.\n###.\n");
}

TEST(Heatmap, TinyPicturesAreNotOverrun) {
  for (int size = 1; size < 12; ++size) EXPECT_EQ(paintHeatmap(counts(size, size, 7.0f)).width, size);
}

}  // namespace
}  // namespace fragtrace
