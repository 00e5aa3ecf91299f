// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

Material loadMaterial(const json& material) {
  GltfBuilder builder;
  builder.root["materials"] = nlohmann::json::array({material});
  return load(builder).materials.at(0);
}

TEST(GltfMaterials, DefaultsAreThoseOfTheSpecification) {
  const Material material = loadMaterial({{"name", "plain"}});
  EXPECT_EQ(material.name, "plain");
  EXPECT_EQ(material.baseColorFactor, glm::vec4(1.0f));
  EXPECT_EQ(material.metallicFactor, 1.0f);
  EXPECT_EQ(material.roughnessFactor, 1.0f);
  EXPECT_EQ(material.emissiveFactor, glm::vec3(0.0f));
  EXPECT_EQ(material.alphaMode, AlphaMode::Opaque);
  EXPECT_EQ(material.ior, 1.5f);
  EXPECT_TRUE(std::isinf(material.attenuationDistance));
  EXPECT_FALSE(material.normalTexture.present());
}

TEST(GltfMaterials, CoreFactorsAreRead) {
  const Material material = loadMaterial(
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.75}}},
       {"emissiveFactor", {1, 0.5, 0}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.3},
       {"doubleSided", true}});
  EXPECT_EQ(material.baseColorFactor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.metallicFactor, 0.25f);
  EXPECT_EQ(material.roughnessFactor, 0.75f);
  EXPECT_EQ(material.emissiveFactor, glm::vec3(1, 0.5, 0));
  EXPECT_EQ(material.alphaMode, AlphaMode::Mask);
  EXPECT_EQ(material.alphaCutoff, 0.3f);
  EXPECT_TRUE(material.doubleSided);
}

TEST(GltfMaterials, ExtensionsAreRead) {
  const Material material = loadMaterial(
      {{"extensions",
        {{"KHR_materials_unlit", json::object()},
         {"KHR_materials_emissive_strength", {{"emissiveStrength", 12.5}}},
         {"KHR_materials_ior", {{"ior", 1.25}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 2}, {"attenuationColor", {0.5, 0.25, 1}}, {"attenuationDistance", 3}}},
         {"KHR_materials_specular", {{"specularFactor", 0}, {"specularColorFactor", {1, 2, 3}}}}}}});
  EXPECT_TRUE(material.unlit);
  EXPECT_EQ(material.emissiveStrength, 12.5f);
  EXPECT_EQ(material.ior, 1.25f);
  EXPECT_EQ(material.transmissionFactor, 1.0f);
  EXPECT_EQ(material.thicknessFactor, 2.0f);
  EXPECT_EQ(material.attenuationColor, glm::vec3(0.5, 0.25, 1));
  EXPECT_EQ(material.attenuationDistance, 3.0f);
  EXPECT_EQ(material.specularFactor, 0.0f);
  EXPECT_EQ(material.specularColorFactor, glm::vec3(1, 2, 3));
}

TEST(GltfMaterials, IorOfZeroStandsForTotalReflection) {
  const float ior = loadMaterial({{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}).ior;
  EXPECT_NEAR(std::pow((ior - 1) / (ior + 1), 2), 1.0, 1e-5);
}

TEST(GltfMaterials, PerlinNormalMapIsReadFromExtras) {
  const Material material =
      loadMaterial({{"extras", {{"perlinNormal", {{"frequency", 4}, {"amplitude", 0.5}, {"octaves", 3}}}}}});
  EXPECT_EQ(material.perlinNormal.frequency, 4.0f);
  EXPECT_EQ(material.perlinNormal.amplitude, 0.5f);
  EXPECT_EQ(material.perlinNormal.octaves, 3);
}

TEST(GltfMaterials, FactorsOutOfRangeAreBroughtBackWithAWarning) {
  GltfBuilder builder;
  builder.root["materials"] = {
      {{"pbrMetallicRoughness", {{"metallicFactor", 1.5}, {"roughnessFactor", -1}}}}};
  const Scene scene = load(builder);
  EXPECT_EQ(scene.materials.at(0).metallicFactor, 1.0f);
  EXPECT_EQ(scene.materials.at(0).roughnessFactor, 0.0f);
  EXPECT_TRUE(anyWarningHas(scene, "/materials/0/pbrMetallicRoughness/metallicFactor"));
}

TEST(GltfMaterials, DefaultMaterialIsAppendedOnceWhereItIsNeeded) {
  GltfBuilder builder;
  builder.root["materials"] = {{{"name", "given"}}};
  builder.addTriangle()["material"] = 0;
  EXPECT_EQ(load(builder).materials.size(), 1u);
  builder.addTriangle();
  builder.addTriangle();
  const Scene scene = load(builder);
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.triangles.at(1).material, 1u);
  EXPECT_EQ(scene.triangles.at(2).material, 1u);
}

TEST(GltfMaterials, TexturesKeepTheirOwnSamplerAndShareTheirImage) {
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", kPixelUri}}, {{"uri", "nowhere.png"}}};
  builder.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  builder.root["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}, {{"source", 1}}};
  builder.root["materials"] = {
      {{"normalTexture", {{"index", 0}, {"scale", 0.5}}}, {"emissiveTexture", {{"index", 1}}}}};
  const Scene scene = load(builder);
  ASSERT_EQ(scene.textures.size(), 2u);
  ASSERT_EQ(scene.images.size(), 1u) << "a picture that no material uses is not read";
  const Texture& normal = scene.textures[scene.materials.at(0).normalTexture.texture];
  EXPECT_EQ(normal.wrapU, Wrap::ClampToEdge);
  EXPECT_EQ(normal.wrapV, Wrap::MirroredRepeat);
  EXPECT_FALSE(normal.linear);
  const Texture& emissive = scene.textures[scene.materials.at(0).emissiveTexture.texture];
  EXPECT_EQ(emissive.wrapU, Wrap::Repeat);
  EXPECT_TRUE(emissive.linear);
  EXPECT_EQ(scene.materials[0].normalScale, 0.5f);
}

TEST(GltfMaterials, TexturesChooseTwoSetsOfCoordinatesAmongAll) {
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.root["textures"] = {{{"source", 0}}};
  const auto with = [](json base, json emissive, json normal) {
    json material = json::object();
    const auto texture = [](const json& set) { return json{{"index", 0}, {"texCoord", set}}; };
    if (!base.is_null()) material["pbrMetallicRoughness"]["baseColorTexture"] = texture(base);
    if (!emissive.is_null()) material["emissiveTexture"] = texture(emissive);
    if (!normal.is_null()) material["normalTexture"] = texture(normal);
    return material;
  };
  builder.root["materials"] = {with(0, 1, nullptr), with(2, nullptr, 2), with(5, 0, nullptr),
                               with(1, 7, nullptr), with(3, 2, nullptr), with(0, 2, 4)};
  builder.root["materials"][1]["occlusionTexture"] = {{"index", 0}, {"texCoord", 1}};
  const Scene scene = load(builder);
  const auto setOf = [&](size_t material, TextureRef Material::*ref) {
    const Material& m = scene.materials.at(material);
    return m.texcoordSets.at((m.*ref).texcoord);
  };
  EXPECT_EQ(scene.materials[0].texcoordSets, (std::array<uint32_t, 2>{0, 1}));
  EXPECT_EQ(setOf(0, &Material::emissiveTexture), 1u);
  EXPECT_EQ(setOf(1, &Material::baseColorTexture), 2u);
  EXPECT_EQ(setOf(1, &Material::normalTexture), 2u);
  EXPECT_EQ(setOf(2, &Material::baseColorTexture), 5u);
  EXPECT_EQ(setOf(2, &Material::emissiveTexture), 0u);
  EXPECT_EQ(setOf(3, &Material::baseColorTexture), 1u);
  EXPECT_EQ(setOf(3, &Material::emissiveTexture), 7u);
  EXPECT_EQ(setOf(4, &Material::baseColorTexture), 3u);
  EXPECT_EQ(setOf(4, &Material::emissiveTexture), 2u);
  EXPECT_EQ(setOf(5, &Material::emissiveTexture), 0u) << "a third set";
  EXPECT_TRUE(anyWarningHas(scene,
                            "/materials/5: has textures of more than two sets of coordinates; TEXCOORD_0 is "
                            "taken instead of TEXCOORD_2"));
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(GltfMaterials, AnAttenuationDistanceThatIsNotAbove0LosesNoLight) {
  for (const double distance : {0.0, -1.0}) {
    GltfBuilder builder;
    json volume = {{"attenuationDistance", distance}, {"attenuationColor", {0.5, 0.5, 0.5}}};
    builder.root["materials"] = {{{"extensions", {{"KHR_materials_volume", volume}}}}};
    const Scene scene = load(builder);
    EXPECT_TRUE(std::isinf(scene.materials.at(0).attenuationDistance)) << distance;
    EXPECT_TRUE(anyWarningHas(scene, "attenuationDistance: is not above 0; no light is lost")) << distance;
  }
}

}  // namespace
}  // namespace fragtrace::gltf_test
