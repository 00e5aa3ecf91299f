// SPDX-License-Identifier: MIT
// Alpha that hides nothing (src/gltf/assemble/textures.h).
#include "gltf/assemble/textures.h"

#include <string>

#include <gtest/gtest.h>

#include "scene/scene.h"

namespace fragtrace {
namespace {

std::vector<uint8_t> bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

/// The beginning of a .png of a colour type, with a chunk before its pixels.
std::vector<uint8_t> png(char colorType, const std::string& chunk = "gAMA") {
  using namespace std::string_literals;
  return bytesOf("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08"s + colorType + "\0\0\0crc\0"s + chunk +
                 "IDATtRNS");
}

TEST(LeastAlpha, APictureTellsByItsHeaderThatItHasNone) {
  EXPECT_FALSE(mayHaveAlpha(bytesOf("\xff\xd8\xff\xe0")));
  for (const char opaque : {0, 2, 3}) EXPECT_FALSE(mayHaveAlpha(png(opaque))) << int(opaque);
  for (const char withAlpha : {4, 6}) EXPECT_TRUE(mayHaveAlpha(png(withAlpha))) << int(withAlpha);
  EXPECT_TRUE(mayHaveAlpha(png(2, "tRNS")));
  EXPECT_TRUE(mayHaveAlpha(png(3, "tRNS")));
  EXPECT_TRUE(mayHaveAlpha(bytesOf("RIFF....WEBP")));
  EXPECT_TRUE(mayHaveAlpha({}));
  std::vector<uint8_t> cut = png(2);
  cut.resize(40);
  EXPECT_TRUE(mayHaveAlpha(cut));
}

Material masked(float factor, float cutoff) {
  Material m;
  m.alphaMode = AlphaMode::Mask;
  m.baseColorFactor.a = factor;
  m.alphaCutoff = cutoff;
  return m;
}

TEST(LeastAlpha, AMaterialIsTestedWhereALeastAlphaHides) {
  EXPECT_FALSE(masked(0.5f, 0.5f).testsAlpha());
  EXPECT_TRUE(masked(0.49f, 0.5f).testsAlpha());
  EXPECT_FALSE(masked(0.0f, 0.0f).testsAlpha());
  Material blend = masked(1.0f, 0.5f);
  blend.alphaMode = AlphaMode::Blend;
  EXPECT_FALSE(blend.testsAlpha());
  blend.baseColorFactor.a = 0.999f;
  EXPECT_TRUE(blend.testsAlpha());
  blend.alphaMode = AlphaMode::Opaque;
  EXPECT_FALSE(blend.testsAlpha());
}

TEST(LeastAlpha, PicturesAndColoursOfVerticesCount) {
  Scene scene;
  scene.materials.assign(3, masked(1.0f, 0.5f));
  scene.images.resize(2);
  scene.images[0].bytes = png(2);
  scene.images[1].bytes = png(6);
  scene.textures.resize(2);
  for (uint32_t i = 0; i < 2; ++i) scene.textures[i].image = scene.materials[i].baseColorTexture.texture = i;
  scene.vertices.color.assign(3, glm::vec4(1.0f));
  scene.vertices.color[2].a = 0.25f;
  scene.triangles.push_back({{0, 1, 2}, 2});
  settleLeastAlpha(scene);
  EXPECT_EQ(scene.materials[0].leastAlpha, 1.0f);
  EXPECT_EQ(scene.materials[1].leastAlpha, 0.0f);
  EXPECT_EQ(scene.materials[2].leastAlpha, 0.25f);
}

}  // namespace
}  // namespace fragtrace
