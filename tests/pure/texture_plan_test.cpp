// SPDX-License-Identifier: MIT
// Where pictures lie on the device: nothing overlaps, nothing passes the room, and the largest shrink first.
#include "pack/texture_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace fragtrace {
namespace {

/// A scene whose materials have the pictures as base colours.
Scene sceneWith(const std::vector<glm::ivec2>& sizes, int bitsOfOdd = 8) {
  Scene scene;
  for (size_t i = 0; i < sizes.size(); ++i) {
    EncodedImage image;
    image.width = sizes[i].x;
    image.height = sizes[i].y;
    image.texelBits = i % 2 == 1 ? bitsOfOdd : 8;
    scene.images.push_back(image);
    scene.textures.push_back({.image = uint32_t(i)});
    scene.materials.emplace_back().baseColorTexture.texture = uint32_t(i);
  }
  return scene;
}

TraitSet baseColors() {
  TraitSet traits;
  traits.set(size_t(Trait::BaseColorTexture));
  return traits;
}

std::vector<glm::ivec2> randomSizes(int count, int largest) {
  std::mt19937 draw(5);
  std::vector<glm::ivec2> sizes;
  for (int i = 0; i < count; ++i) sizes.emplace_back(1 + int(draw() % largest), 1 + int(draw() % largest));
  return sizes;
}

/// Words of a buffer, or texels of layers, of which each belongs to one picture.
struct Taken {
  uint32_t number;
  int64_t begin;
  int64_t end;
};
void expectApart(std::vector<Taken> taken) {
  std::ranges::sort(taken, {}, [](const Taken& t) { return std::pair(t.number, t.begin); });
  for (size_t i = 1; i < taken.size(); ++i) {
    if (taken[i].number != taken[i - 1].number) continue;
    ASSERT_LE(taken[i - 1].end, taken[i].begin) << "buffer " << taken[i].number;
  }
}

TEST(TexturePlan, AThousandPicturesLieInBuffersOneBehindTheOther) {
  const TextureRoom room{.words = 1 << 19, .buffers = 8};
  const Scene scene = sceneWith(randomSizes(1000, 64), 16);
  const TexturePlan plan = planTextures(scene, baseColors(), room);
  EXPECT_EQ(plan.shrunk.count, 0u);
  EXPECT_GT(plan.sizes.size(), 1u);
  std::vector<Taken> taken;
  for (size_t i = 0; i < plan.places.size(); ++i) {
    const TexturePlace& place = plan.places[i];
    EXPECT_EQ(place.size, glm::ivec2(scene.images[i].width, scene.images[i].height));
    EXPECT_EQ(place.wide, i % 2 == 1);
    EXPECT_TRUE(place.isColor);
    const int64_t words = int64_t(place.size.x) * place.size.y * (place.wide ? 2 : 1);
    taken.push_back({place.number, place.first, place.first + words});
    EXPECT_LE(taken.back().end, plan.sizes[place.number]);
  }
  for (const int64_t words : plan.sizes) EXPECT_LE(words, room.words);
  expectApart(taken);
}

TEST(TexturePlan, AThousandPicturesLieInLayersWithoutOverlap) {
  const TextureRoom room{.reads = TexelReads::Arrays, .side = 4096};
  std::vector<glm::ivec2> sizes = randomSizes(1000, 300);
  sizes.emplace_back(4096, 3);
  sizes.emplace_back(4096, 4096);
  const Scene scene = sceneWith(sizes, 16);
  const TexturePlan plan = planTextures(scene, baseColors(), room);
  EXPECT_EQ(plan.layerSide, 4096);
  int64_t used = 0;
  for (const bool wide : {false, true}) {
    std::vector<Taken> rows;
    for (const TexturePlace& place : plan.places) {
      if (place.wide != wide) continue;
      used += int64_t(place.size.x) * place.size.y;
      const int64_t x = place.first & 0xffffu;
      const int64_t top = place.first >> 16;
      ASSERT_LE(x + place.size.x, plan.layerSide);
      ASSERT_LE(top + place.size.y, plan.layerSide);
      ASSERT_LT(place.number, plan.sizes[wide ? 1 : 0]);
      for (int64_t y = top; y < top + place.size.y; ++y) {
        const int64_t row = y * plan.layerSide + x;
        rows.push_back({place.number, row, row + place.size.x});
      }
    }
    expectApart(rows);
  }
  // Shelves waste little: a layer is filled by two thirds.
  EXPECT_LT(int64_t(plan.bytes()), used * 6 * 3 / 2 + 2 * int64_t(4096) * 4096 * 8);
}

TEST(TexturePlan, TheLargestShrinkFirstAndAsLittleAsNeeded) {
  const TextureRoom room{.words = 300 * 300, .buffers = 2};
  const Scene scene = sceneWith({{400, 200}, {100, 100}, {10, 300}, {16, 16}});
  const TexturePlan plan = planTextures(scene, baseColors(), room);
  EXPECT_EQ(plan.shrunk.count, 0u);  // 80000 words in the first buffer, 13256 in the second

  const TextureRoom small{.words = 50000, .buffers = 1};
  const TexturePlan shrunk = planTextures(scene, baseColors(), small);
  EXPECT_EQ(shrunk.shrunk.from, 400);
  EXPECT_GE(shrunk.shrunk.count, 1u);
  EXPECT_LT(shrunk.places[0].size.x, 300);
  EXPECT_NEAR(double(shrunk.places[0].size.x) / shrunk.places[0].size.y, 2.0, 0.05);
  EXPECT_EQ(shrunk.places[1].size, glm::ivec2(100));
  EXPECT_EQ(shrunk.places[3].size, glm::ivec2(16));
  EXPECT_LE(shrunk.sizes[0], small.words);
  EXPECT_GT(shrunk.sizes[0], small.words * 95 / 100);
}

TEST(TexturePlan, PicturesThatNothingReadsTakeNoRoom) {
  Scene scene = sceneWith({{64, 64}, {32, 32}});
  scene.materials[1].baseColorTexture = {};
  scene.materials[1].occlusionTexture.texture = 1;
  const TexturePlan plan = planTextures(scene, baseColors());
  EXPECT_EQ(plan.sizes, std::vector<int64_t>{64 * 64});
  EXPECT_EQ(plan.places[1].size, glm::ivec2(0));
  EXPECT_EQ(plan.bytes(), size_t(64 * 64 * 4));
  EXPECT_TRUE(holdsTextures(plan, scene, baseColors()));
  scene.materials[0].baseColorTexture.texture = 1;
  EXPECT_FALSE(holdsTextures(plan, scene, baseColors()));
  EXPECT_TRUE(holdsTextures(plan, scene, {}));
  scene.materials[0].baseColorTexture.texture = 0;
  scene.images[0].width = 65;
  EXPECT_FALSE(holdsTextures(plan, scene, baseColors()));
}

}  // namespace
}  // namespace fragtrace
