// SPDX-License-Identifier: MIT
// Pictures on the device neither overlap nor pass the room. Those with most texels on a length shrink first.
#include "pack/textures/texture_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
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
  traits.set(size_t(slotTrait(layout::kSlotBaseColor)));
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
  for (const bool levels : {false, true}) {
    const TextureRoom room{
        .words = 1 << 19, .buffers = 9, .levels = levels ? MipLevels::Made : MipLevels::None};
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
      EXPECT_GE(int64_t(plan.wordsOf(place)), words);
      EXPECT_LE(double(plan.wordsOf(place)), double(words) * (levels ? 1.344 : 1.0));
      taken.push_back({place.number, place.first, place.first + int64_t(plan.wordsOf(place))});
      EXPECT_LE(taken.back().end, plan.sizes[place.number]);
    }
    for (const int64_t words : plan.sizes) EXPECT_LE(words, room.words);
    expectApart(taken);
  }
}

TEST(TexturePlan, LevelsLieOneBehindTheOther) {
  std::vector<glm::ivec2> sizes = randomSizes(1000, 3000);
  sizes.insert(sizes.end(), {{1, 1}, {16384, 16384}, {16384, 1}, {3, 16383}});
  for (const glm::ivec2 size : sizes) {
    EXPECT_EQ(std::min(size.x, size.y) >> (levelsOf(size) - 1), 1);
    for (int level = 0; level < levelsOf(size); ++level) {
      const glm::ivec2 there = size >> level;
      EXPECT_LE(texelsBefore(size, level) + size_t(there.x) * size_t(there.y), texelsBefore(size, level + 1))
          << size.x << " x " << size.y << ", " << level;
    }
  }
}

/// The parts of the rows of a level of layers that pictures of 8 or 16 bits take.
std::vector<Taken> rowsOf(const TexturePlan& plan, bool wide, int level) {
  std::vector<Taken> rows;
  const int64_t side = plan.layerSide >> level;
  for (const TexturePlace& place : plan.places) {
    if (place.wide != wide || level >= levelsOf(place.size)) continue;
    const int64_t x = (place.first & 0xffffu) >> level;
    const int64_t top = place.first >> 16 >> level;
    const glm::ivec2 size = place.size >> level;
    EXPECT_LE(x + size.x, side);
    EXPECT_LE(top + size.y, side);
    EXPECT_LT(place.number, plan.sizes[wide ? 1 : 0]);
    for (int64_t y = top; y < top + size.y; ++y)
      rows.push_back({place.number, y * side + x, y * side + x + size.x});
  }
  return rows;
}

TEST(TexturePlan, AThousandPicturesLieInLayersWithoutOverlap) {
  std::vector<glm::ivec2> sizes = randomSizes(1000, 300);
  sizes.emplace_back(4096, 3);
  sizes.emplace_back(4096, 4096);
  const Scene scene = sceneWith(sizes, 16);
  int64_t used = 0;
  for (const glm::ivec2 size : sizes) used += int64_t(size.x) * size.y;
  for (const bool levels : {false, true}) {
    const TextureRoom room{
        .reads = TexelReads::Arrays, .side = 4096, .levels = levels ? MipLevels::Made : MipLevels::None};
    const TexturePlan plan = planTextures(scene, baseColors(), room);
    EXPECT_EQ(plan.layerSide, 4096);
    for (const bool wide : {false, true})
      for (int level = 0; level < (levels ? 13 : 1); ++level) expectApart(rowsOf(plan, wide, level));
    // Shelves waste little: a layer is filled by two thirds, or where levels ask for steps by a third.
    EXPECT_LT(int64_t(plan.bytes()),
              used * (levels ? 8 * 3 : 6 * 3 / 2) + 2 * int64_t(4096) * 4096 * (levels ? 11 : 8));
  }
}

/// Squares of those sides, each with a picture of its own of 1000 x 1000 texels over the whole square.
Scene squares(std::initializer_list<float> sides) {
  Scene scene;
  for (const float side : sides) {
    const auto first = uint32_t(scene.vertices.position.size());
    const auto number = uint32_t(scene.images.size());
    for (const glm::vec2 corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
      scene.vertices.position.emplace_back(corner * side, 0.0f);
      scene.vertices.texcoord0.push_back(corner);
    }
    for (const glm::uvec3 corners : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)})
      scene.triangles.push_back({.vertex = first + corners, .material = number});
    scene.images.push_back({.name = "a.png", .bytes = {}, .width = 1000, .height = 1000});
    scene.textures.push_back({.image = number});
    scene.materials.emplace_back().baseColorTexture.texture = number;
  }
  return scene;
}

/// The widths of pictures of the scene in room for so many texels.
std::vector<int> widthsWithin(const Scene& scene, int64_t texels) {
  std::vector<int> widths;
  for (const TexturePlace& place : planTextures(scene, baseColors(), {.words = texels}).places)
    widths.push_back(place.size.x);
  return widths;
}

TEST(TexturePlan, ThoseWithMostTexelsOnALengthShrinkToOneDensity) {
  // 1000, 500 and 100 texels per length; at 250 per length they have 250, 500 and 1000 a side.
  const TextureRoom room{.words = 62'500 + 250'000 + 1'000'000};
  const TexturePlan plan = planTextures(squares({1, 2, 10}), baseColors(), room);
  EXPECT_NEAR(plan.places[0].size.x, 250, 1);
  EXPECT_NEAR(plan.places[1].size.x, 500, 1);
  EXPECT_EQ(plan.places[2].size, glm::ivec2(1000));
  EXPECT_EQ(plan.shrunk.count, 2u);
  EXPECT_EQ(plan.shrunk.from, 1000);
  EXPECT_EQ(plan.shrunk.to, plan.places[1].size.x);
  EXPECT_EQ(widthsWithin(squares({1, 2}), 2'000'000), std::vector(2, 1000));
}

TEST(TexturePlan, ARepeatedPictureHasMoreTexelsOnALength) {
  Scene scene = squares({1, 1});
  scene.materials[1].baseColorTexture.transform.u.x = 16.0f;
  const std::vector<int> widths = widthsWithin(scene, 1'250'000);
  EXPECT_EQ(widths[0], 1000);
  EXPECT_NEAR(widths[1], 500, 1);
}

TEST(TexturePlan, InstancesCountByTheirSize) {
  Scene scene = squares({1, 1});
  scene.sharedMeshes = {{.firstTriangle = 0, .triangleCount = 2}, {.firstTriangle = 2, .triangleCount = 2}};
  scene.instances.push_back({.toLocal = glm::dmat4(1.0), .mesh = 0});
  scene.instances.push_back({.toLocal = glm::dmat4(glm::dmat3(4.0)), .mesh = 1});
  const std::vector<int> widths = widthsWithin(scene, 1'250'000);
  EXPECT_NEAR(widths[0], 500, 1);
  EXPECT_EQ(widths[1], 1000);
}

TEST(TexturePlan, APaletteShrinksLastAndWhatIsNoNumberShrinksFirst) {
  Scene scene = squares({1, 1});
  scene.materials[0].baseColorTexture.transform.u.x = 0.0f;
  EXPECT_EQ(widthsWithin(scene, 1'000'000 + 250'000), (std::vector{1000, 500}));
  EXPECT_EQ(widthsWithin(scene, 2), (std::vector{1, 1}));
  scene.vertices.texcoord0[4].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(widthsWithin(scene, 1'000'001), (std::vector{1000, 1}));
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
