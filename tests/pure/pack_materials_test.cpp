// SPDX-License-Identifier: MIT
// Rows of materials, transforms and tables, as the shader reads them.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "bvh/build.h"
#include "gltf_builder.h"
#include "pack/energy_tables.h"
#include "pack/gpu_scene.h"
#include "pack/textures/texture_plan.h"

namespace fragtrace::gltf_test {
namespace {

using namespace layout;  // NOLINT: the names of rows and slots

Scene sceneOf(const json& materials) {
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = materials;
  for (size_t i = 0; i < materials.size(); ++i) {
    json& primitive = builder.addTriangle();
    primitive["material"] = i;
    primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {0, 1, 1, 1, 0, 0});
  }
  return load(builder);
}

struct Packed {
  ShaderVariant variant;
  GpuScene scene;

  glm::uvec4 row(size_t index) const {
    const Words& words = scene.buffers[kMaterialsBinding];
    return {words.at(index * 4), words.at(index * 4 + 1), words.at(index * 4 + 2), words.at(index * 4 + 3)};
  }
  glm::vec4 floats(size_t index) const {
    const glm::uvec4 words = row(index);
    return {std::bit_cast<float>(words.x), std::bit_cast<float>(words.y), std::bit_cast<float>(words.z),
            std::bit_cast<float>(words.w)};
  }
};

Packed pack(const Scene& scene) {
  Packed packed;
  packed.variant = chooseVariant({}, traitsOf(scene, Surroundings::DefaultLight), Surroundings::DefaultLight,
                                 4, BufferReads::Image);
  const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  Environment white;
  white.kind = Surroundings::DefaultLight;
  white.image.width = white.image.height = 1;
  white.image.channels = {"R", "G", "B"};
  white.image.values = {1.0f, 1.0f, 1.0f};
  packed.scene = packScene(scene, bvh, white, packed.variant);
  return packed;
}

json moved(const json& transform) {
  return {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
}

TEST(PackMaterials, EachTextureBelongsToOneTrait) {
  Material all;
  all.emissiveFactor = all.sheenColorFactor = glm::vec3(1.0f);
  all.transmissionFactor = all.clearcoatFactor = all.anisotropyStrength = all.iridescenceFactor = 1.0f;
  all.diffuseTransmissionFactor = all.scatterStrength = 1.0f;
  for (uint32_t slot = 0; slot < kSlotCount; ++slot) {
    Material one = all;
    (one.*kTextureRefs[slot].ref).texture = 0;
    for (uint32_t other = 0; other < kSlotCount; ++other)
      EXPECT_EQ(readsTexture(other, one, TraitSet().set()), other == slot) << "slot " << slot;
    EXPECT_FALSE(readsTexture(slot, one, TraitSet())) << "slot " << slot;
  }
}

TEST(PackMaterials, TexturesThatAMaterialDoesNotShowAreLeftOut) {
  const auto glass = [](double factor) {
    return json{{"extensions",
                 {{"KHR_materials_transmission",
                   {{"transmissionFactor", factor}, {"transmissionTexture", {{"index", 0}}}}}}}};
  };
  const Packed packed = pack(sceneOf({glass(0.0), glass(1.0)}));
  const size_t slot = kMaterialTextures + kSlotTransmission;
  EXPECT_EQ(packed.row(slot).z & kTexturePresent, 0u);
  EXPECT_EQ(packed.row(kMaterialRows + slot).z & kTexturePresent, kTexturePresent);
}

TEST(PackMaterials, TransformsStandBehindTheMaterialsOnceEach) {
  const json material = {{"pbrMetallicRoughness",
                          {{"baseColorTexture", moved({{"offset", {0.5, 0.25}}})},
                           {"metallicRoughnessTexture", moved({{"scale", {2, 3}}})}}},
                         {"emissiveFactor", {1, 1, 1}},
                         {"emissiveTexture", {{"index", 0}}}};
  const Scene scene = sceneOf({material, material});
  const Packed packed = pack(scene);
  const size_t end = scene.materials.size() * kMaterialRows;
  for (size_t m = 0; m < 2; ++m) {
    const size_t slots = m * kMaterialRows + kMaterialTextures;
    EXPECT_EQ(packed.row(slots + kSlotBaseColor).w, end);
    EXPECT_EQ(packed.row(slots + kSlotMetallicRoughness).w, end + 2);
    EXPECT_EQ(packed.row(slots + kSlotEmission).w, 0u);
  }
  EXPECT_EQ(packed.floats(end), glm::vec4(1, 0, 0.5, 0));
  EXPECT_EQ(packed.floats(end + 1), glm::vec4(0, 1, 0.25, 0));
  EXPECT_EQ(packed.floats(end + 2), glm::vec4(2, 0, 0, 0));
  EXPECT_EQ(packed.floats(end + 3), glm::vec4(0, 3, 0, 0));
  EXPECT_EQ(packed.scene.energyTableRow, end + 4);
  EXPECT_TRUE(has(packed.variant.traits, Trait::TextureTransforms));
}

TEST(PackMaterials, ExtensionsHaveRowsOfTheirOwn) {
  const Scene scene = sceneOf(
      {{{"extensions",
         {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.25}}},
          {"KHR_materials_sheen", {{"sheenColorFactor", {1, 0.5, 0.25}}, {"sheenRoughnessFactor", 0.75}}},
          {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}},
          {"KHR_materials_iridescence", {{"iridescenceFactor", 1}}},
          {"KHR_materials_dispersion", {{"dispersion", 2}}},
          {"KHR_materials_diffuse_transmission",
           {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {0.25, 1, 0}}}}}}}});
  const Packed packed = pack(scene);
  EXPECT_EQ(packed.floats(kMaterialClearcoat), glm::vec4(0.5, 0.25, 1, 2));
  EXPECT_EQ(packed.floats(kMaterialSheen), glm::vec4(1, 0.5, 0.25, 0.75));
  EXPECT_EQ(packed.floats(kMaterialAnisotropy), glm::vec4(0.5, 1, 0, 0));
  EXPECT_EQ(packed.floats(kMaterialIridescence), glm::vec4(1, 1.3f, 100, 400));
  EXPECT_EQ(packed.floats(kMaterialDiffuseTransmission), glm::vec4(0.25, 1, 0, 0.5));
  // The tables: sheen's albedo, then GGX's loss with its averages.
  const size_t sheen = packed.scene.energyTableRow - kEnergyCells * kEnergyCells;
  const std::vector<float>& albedo = sheenAlbedoTable().nodes;
  EXPECT_EQ(packed.floats(sheen + 1), glm::vec4(albedo[1], albedo[2], albedo[34], albedo[35]));
  EXPECT_EQ(packed.scene.buffers[kMaterialsBinding].size() / 4,
            packed.scene.energyTableRow + kEnergyCells * kEnergyCells + kEnergyCells);
  for (Trait t :
       {Trait::Clearcoat, Trait::Sheen, Trait::Anisotropy, Trait::Iridescence, Trait::DiffuseTransmission}) {
    EXPECT_TRUE(has(packed.variant.traits, t)) << traitRows()[size_t(t)].name;
  }
  EXPECT_FALSE(has(packed.variant.traits, Trait::Dispersion)) << "only glass disperses";
  EXPECT_FALSE(has(packed.variant.traits, Trait::SingleSided)) << "light passes";
}

TEST(PackMaterials, ASceneWithoutExtensionsHasNoTraitAndNoTableOfThem) {
  const Packed packed = pack(sceneOf({{{"name", "plain"}}}));
  for (size_t t = size_t(Trait::SpecularGlossiness); t <= size_t(Trait::Dispersion); ++t) {
    EXPECT_FALSE(packed.variant.traits.test(t)) << traitRows()[t].name;
  }
  EXPECT_EQ(packed.scene.buffers[kMaterialsBinding].size() / 4,
            packed.scene.energyTableRow + kEnergyCells * kEnergyCells + kEnergyCells);
}

}  // namespace
}  // namespace fragtrace::gltf_test
