// SPDX-License-Identifier: MIT
// Triangles that alpha cuts out wholly (src/pack/pack_tree.h): none of these has a point that stops a ray.
#include "pack/pack_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bvh/bvh.h"
#include "pack/gpu_scene.h"

namespace fragtrace {
namespace {

struct Dice {
  std::mt19937 engine{7};
  int below(int count) { return int(engine() % uint32_t(count)); }
  float between(float low, float high) { return low + (high - low) * float(engine()) * 0x1p-32f; }
};

/// A picture with some texels that are not transparent.
struct Picture {
  glm::ivec2 size{1};
  std::vector<uint8_t> rgba;

  float alpha(int x, int y) const { return float(rgba[size_t(y * size.x + x) * 4 + 3]) / 255.0f; }
};

Picture randomPicture(Dice& dice) {
  Picture picture{{1 + dice.below(40), 1 + dice.below(40)}, {}};
  const int oneOf = 1 + dice.below(400);
  for (int i = 0; i < picture.size.x * picture.size.y; ++i) {
    const uint8_t alpha = dice.below(oneOf) == 0 ? uint8_t(dice.below(256)) : uint8_t(0);
    picture.rgba.insert(picture.rgba.end(), {9, 9, 9, alpha});
  }
  return picture;
}

/// A scene of one triangle with random coordinates, wrapping, filter, transform, cutoff and vertex alpha.
Scene randomScene(Dice& dice, glm::ivec2 size) {
  Scene scene;
  EncodedImage image;
  image.width = size.x;
  image.height = size.y;
  scene.images.push_back(image);
  const auto wrap = [&] {
    return std::array{Wrap::Repeat, Wrap::ClampToEdge, Wrap::MirroredRepeat}[size_t(dice.below(3))];
  };
  scene.textures.push_back({.image = 0, .wrapU = wrap(), .wrapV = wrap(), .linear = dice.below(2) == 0});
  Material m;
  m.alphaMode = dice.below(2) == 0 ? AlphaMode::Mask : AlphaMode::Blend;
  m.alphaCutoff = dice.between(0.0f, 0.7f);
  m.leastAlpha = 0.0f;
  m.baseColorFactor.a = dice.between(0.5f, 1.0f);
  m.baseColorTexture.texture = 0;
  m.baseColorTexture.texcoord = uint32_t(dice.below(2));
  if (dice.below(2) == 0) {
    const auto row = [&] { return glm::vec3(dice.between(-2, 2), dice.between(-2, 2), dice.between(-9, 9)); };
    m.baseColorTexture.transform = {row(), row()};
  }
  scene.materials.push_back(m);
  scene.triangles.push_back({{0, 1, 2}, 0});
  const float spread = dice.between(0.0f, 0.6f);
  const glm::vec2 middle(dice.between(-5, 5), dice.between(-5, 5));
  for (int i = 0; i < 3; ++i) {
    scene.vertices.position.emplace_back(dice.between(0, 1), dice.between(0, 1), 0.0f);
    scene.vertices.color.emplace_back(1.0f, 1.0f, 1.0f, dice.between(0.3f, 1.0f));
    for (std::vector<glm::vec2>* set : {&scene.vertices.texcoord0, &scene.vertices.texcoord1})
      set->push_back(middle + spread * glm::vec2(dice.between(-1, 1), dice.between(-1, 1)));
  }
  return scene;
}

int wrapOf(int x, int size, Wrap wrap) {
  const auto rest = [](int a, int b) { return (a % b + b) % b; };
  if (wrap == Wrap::ClampToEdge) return std::clamp(x, 0, size - 1);
  if (wrap == Wrap::Repeat) return rest(x, size);
  const int m = rest(x, 2 * size);
  return m < size ? m : 2 * size - 1 - m;
}

/// The texture's alpha at coordinates (shaders/texture.glsl).
float sampled(const Picture& picture, const Texture& texture, glm::vec2 uv) {
  const glm::vec2 place = uv * glm::vec2(picture.size) - (texture.linear ? 0.5f : 0.0f);
  const glm::vec2 base = glm::floor(place);
  const auto at = [&](int x, int y) {
    return picture.alpha(wrapOf(int(base.x) + x, picture.size.x, texture.wrapU),
                         wrapOf(int(base.y) + y, picture.size.y, texture.wrapV));
  };
  if (!texture.linear) return at(0, 0);
  const glm::vec2 f = place - base;
  return glm::mix(glm::mix(at(0, 0), at(1, 0), f.x), glm::mix(at(0, 1), at(1, 1), f.x), f.y);
}

/// The triangle stops rays at a point, by its barycentric weights.
bool stopsAt(const Scene& scene, const Picture& picture, glm::vec3 weights) {
  const Material& m = scene.materials[0];
  const TextureRef& ref = m.baseColorTexture;
  const auto& texcoords = ref.texcoord == 1 ? scene.vertices.texcoord1 : scene.vertices.texcoord0;
  glm::vec2 uv(0.0f);
  float alpha = 0.0f;
  for (int i = 0; i < 3; ++i) {
    uv += weights[i] * texcoords[size_t(i)];
    alpha += weights[i] * scene.vertices.color[size_t(i)].a;
  }
  alpha *= m.baseColorFactor.a * sampled(picture, scene.textures[0], ref.transform.of(uv));
  return m.alphaMode == AlphaMode::Mask ? alpha >= m.alphaCutoff : alpha > 0.0f;
}

bool stopsSomewhere(const Scene& scene, const Picture& picture) {
  constexpr int kSteps = 40;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j)
      if (stopsAt(scene, picture, glm::vec3(i, j, kSteps - i - j) / float(kSteps))) return true;
  return false;
}

TraitSet readsAlpha() {
  TraitSet traits;
  for (const Trait trait : {slotTrait(layout::kSlotBaseColor), Trait::VertexColors, Trait::Alpha})
    traits.set(size_t(trait));
  return traits;
}

bool isCutOut(const Scene& scene, const Picture& picture) {
  const TraitSet traits = readsAlpha();
  const TexturePlan plan = planTextures(scene, traits);
  std::vector<PictureFacts> facts(1);
  facts[0].alpha = alphaPyramidOf<uint8_t>(picture.rgba, picture.size);
  return !cutOutTriangles(scene, traits, TexturePacker(scene, plan, facts)).empty();
}

TEST(CutOut, NoTriangleThatStopsARayIsCutOut) {
  Dice dice;
  int cutOut = 0;
  int transparent = 0;
  for (int i = 0; i < 4000; ++i) {
    const Picture picture = randomPicture(dice);
    const Scene scene = randomScene(dice, picture.size);
    const bool stops = stopsSomewhere(scene, picture);
    const bool left = isCutOut(scene, picture);
    EXPECT_FALSE(stops && left) << "case " << i;
    cutOut += left ? 1 : 0;
    transparent += stops ? 0 : 1;
  }
  // Cells of four texels and boxes of footprints keep some that are transparent.
  EXPECT_GT(cutOut, transparent / 2) << "of " << transparent;
  EXPECT_GT(cutOut, 400);
}

TEST(CutOut, FactorsAloneDecideWithoutATexture) {
  Scene scene;
  Material m;
  m.alphaMode = AlphaMode::Mask;
  m.leastAlpha = 0.0f;
  m.baseColorFactor.a = 0.49f;
  scene.materials.push_back(m);
  scene.triangles.push_back({{0, 1, 2}, 0});
  scene.vertices.position.resize(3);
  const auto isOut = [&](float alpha) {
    scene.materials[0].baseColorFactor.a = alpha;
    return isCutOut(scene, {{1, 1}, {0, 0, 0, 0}});
  };
  EXPECT_TRUE(isOut(0.49f));
  EXPECT_FALSE(isOut(0.5f));
  scene.materials[0].alphaMode = AlphaMode::Blend;
  EXPECT_FALSE(isOut(0.001f));
  EXPECT_TRUE(isOut(0.0f));
  scene.materials[0].alphaMode = AlphaMode::Opaque;
  EXPECT_FALSE(isOut(0.0f));
}

TEST(CutOut, AChangedFactorPacksTheTreeAgain) {
  Scene scene;
  scene.materials.emplace_back().alphaMode = AlphaMode::Mask;
  scene.triangles.push_back({{0, 1, 2}, 0});
  scene.vertices.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Bvh bvh = buildBvh(primitiveBounds(scene), 1);
  ShaderVariant variant;
  variant.traits = readsAlpha();
  KeptArrays kept;
  const auto pack = [&](float alpha) {
    scene.materials[0].baseColorFactor.a = alpha;
    return packScene(scene, bvh, {}, variant, planTextures(scene, variant.traits), &kept);
  };
  EXPECT_EQ(pack(0.25f).cutOut, std::vector<bool>{true});
  for (const auto& [alpha, isKept] : {std::pair(0.3f, true), {0.75f, false}, {0.8f, true}, {0.2f, false}}) {
    kept.geometry = true;
    const GpuScene packed = pack(alpha);
    EXPECT_EQ(packed.cutOut.empty(), alpha > 0.5f) << alpha;
    EXPECT_EQ(packed.unchanged[layout::kNodesBinding], isKept) << alpha;
  }
}

TEST(CutOut, AlphaOf16BitsIsRoundedUp) {
  const std::vector<uint16_t> faint{0, 0, 0, 1};
  EXPECT_EQ(alphaPyramidOf<uint16_t>(faint, {1, 1}).levels.back().at(0), 1);
  EXPECT_EQ(alphaPyramidOf<uint16_t>(std::vector<uint16_t>{0, 0, 0, 65535}, {1, 1}).levels.back().at(0), 255);
}

TEST(CutOut, APrunedTreeHasEmptyBoxesWhereNothingIsLeft) {
  std::vector<Bounds> boxes;
  for (int i = 0; i < 64; ++i) {
    Bounds box;
    box.include(glm::vec3(float(i), 0.0f, 0.0f));
    box.include(glm::vec3(float(i) + 0.5f, 1.0f, 1.0f));
    boxes.push_back(box);
  }
  std::vector<bool> leftOut(64, false);
  for (size_t i = 8; i < 64; ++i) leftOut[i] = true;
  const Bvh whole = buildBvh(boxes, 64);
  const Bvh bvh = pruned(whole, leftOut);
  EXPECT_EQ(bvh.wide.size(), whole.wide.size());
  Bounds left;
  for (const Bounds& box : bvh.nodes[0].bounds) left.include(box);
  EXPECT_EQ(left.maximum.x, 7.5f);
  size_t primitives = 0;
  for (const BvhLeaf& leaf : bvh.leaves)
    for (const uint32_t primitive : leaf.primitive)
      primitives += primitive < 8 ? 1 : primitive == kMissIndex ? 0 : 100;
  EXPECT_EQ(primitives, 8u);
}

}  // namespace
}  // namespace fragtrace
