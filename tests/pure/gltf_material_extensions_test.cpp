// SPDX-License-Identifier: MIT
// Extensions of materials and textures: factors, textures, defaults, and warnings at their JSON pointers.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

/// A file with textures 0..7, each with a picture of its own, and one material.
GltfBuilder fileWith(const json& material) {
  GltfBuilder builder;
  for (int i = 0; i < 8; ++i) {
    builder.root["images"].push_back({{"uri", kPixelUri}});
    builder.root["textures"].push_back({{"source", i}});
  }
  builder.root["materials"] = nlohmann::json::array({material});
  return builder;
}

Material materialWith(const json& material) {
  GltfBuilder builder = fileWith(material);
  return load(builder).materials.at(0);
}

Material extended(const char* name, const json& extension) {
  return materialWith({{"extensions", {{name, extension}}}});
}

/// Expects a warning at this place below /materials/0/.
void expectWarning(const json& material, const std::string& place) {
  GltfBuilder builder = fileWith(material);
  EXPECT_TRUE(anyWarningHas(load(builder), "/materials/0/" + place + ":")) << place;
}

json transformed(int index, const json& transform) {
  return {{"index", index}, {"extensions", {{"KHR_texture_transform", transform}}}};
}

TEST(GltfTextureTransform, IsTranslationTimesRotationTimesScale) {
  const double angle = 0.3;
  const Material m =
      materialWith({{"normalTexture",
                     transformed(0, {{"offset", {0.25, -0.5}}, {"scale", {2, 3}}, {"rotation", angle}})}});
  ASSERT_TRUE(m.normalTexture.transformed());
  const glm::vec2 texcoord(0.7, 0.2);
  const glm::dvec2 scaled(2 * 0.7, 3 * 0.2);
  // Counter-clockwise with v pointing down: (1, 0) turns towards (0, -1), which is up on the picture.
  const glm::dvec2 turned(std::cos(angle) * scaled.x + std::sin(angle) * scaled.y,
                          -std::sin(angle) * scaled.x + std::cos(angle) * scaled.y);
  EXPECT_LE(
      glm::distance(glm::dvec2(m.normalTexture.transform.of(texcoord)), turned + glm::dvec2(0.25, -0.5)),
      1e-6);
}

TEST(GltfTextureTransform, TheSpecificationsExampleIsTheLowerLeftQuadrant) {
  const Material m = materialWith(
      {{"emissiveTexture",
        transformed(0, {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}})}});
  const TextureTransform& t = m.emissiveTexture.transform;
  for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)}) {
    EXPECT_GE(t.of(corner).x, -1e-6f);
    EXPECT_LE(t.of(corner).x, 0.5f + 1e-6f);
    EXPECT_GE(t.of(corner).y, 0.5f - 1e-6f);
    EXPECT_LE(t.of(corner).y, 1.0f + 1e-6f);
  }
}

TEST(GltfTextureTransform, EachUseHasItsOwnAndNoneIsTheIdentity) {
  const Material m = materialWith(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", transformed(0, {{"scale", {2, 2}}})},
         {"metallicRoughnessTexture", transformed(0, {{"texCoord", 1}})}}},
       {"occlusionTexture", {{"index", 0}}},
       {"extensions",
        {{"KHR_materials_specular", {{"specularTexture", transformed(0, {{"offset", {0.5, 0}}})}}}}}});
  EXPECT_EQ(m.baseColorTexture.transform.of({0.25, 0.5}), glm::vec2(0.5, 1.0));
  EXPECT_EQ(m.baseColorTexture.texcoord, 0u);
  EXPECT_FALSE(m.metallicRoughnessTexture.transformed());
  EXPECT_EQ(m.metallicRoughnessTexture.texcoord, 1u) << "its texCoord overrides the use's";
  EXPECT_FALSE(m.occlusionTexture.transformed());
  EXPECT_EQ(m.specularTexture.transform.of({0.25, 0.5}), glm::vec2(0.75, 0.5));
}

TEST(GltfTextureTransform, WhatLeavesNoDigitsIsBroughtBackAndWrongTypesAreAbsent) {
  expectWarning({{"normalTexture", transformed(0, {{"scale", {1e30, 1}}})}},
                "normalTexture/extensions/KHR_texture_transform/scale");
  GltfBuilder builder = fileWith({{"normalTexture", transformed(0, {{"offset", {1, 2, 3}}})}});
  EXPECT_EQ(faultOf(builder),
            "test.gltf: /materials/0/normalTexture/extensions/KHR_texture_transform/offset: does not hold 2 "
            "numbers; it is taken as absent");
}

TEST(GltfTextureTransform, MadeTangentsFollowTheTurnedTexture) {
  GltfBuilder builder = fileWith({{"normalTexture", transformed(0, {{"rotation", M_PI / 2}})}});
  json& primitive = builder.addTriangle();
  // u along x, v along -y: unmirrored.
  primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {0, 1, 1, 1, 0, 0});
  primitive["attributes"]["NORMAL"] = builder.addAccessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  primitive["material"] = 0;
  const Scene scene = load(builder);
  // The picture's u grows with v, which grows along -y.
  EXPECT_LE(glm::distance(scene.vertices.tangent.at(0), glm::vec4(0, -1, 0, 1)), 1e-6f);
}

TEST(GltfWebp, ThePictureOfTheExtensionCountsMoreThanTheFallback) {
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", "nowhere.png"}}, {{"uri", kPixelUri}}};
  builder.root["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
  builder.root["extensionsUsed"] = {"EXT_texture_webp"};
  builder.root["extensionsRequired"] = {"EXT_texture_webp"};
  builder.root["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  const Scene scene = load(builder);
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_NE(scene.images[0].name.find("/images/1"), std::string::npos) << "the fallback is not even read";
}

TEST(GltfWebp, AnExtensionWithoutASourceLeavesTheFallback) {
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.root["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", json::object()}}}}};
  builder.root["extensionsUsed"] = {"EXT_texture_webp"};
  builder.root["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  EXPECT_EQ(load(builder).images.size(), 1u);
}

TEST(GltfWebp, APictureThatDoesNotExistIsRefused) {
  GltfBuilder builder;
  builder.root["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  builder.addTriangle()["material"] = 0;
  builder.root["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 7}}}}}}};
  EXPECT_EQ(refusalOf(builder),
            "test.gltf: /textures/0/extensions/EXT_texture_webp/source: index 7 is past the 0 elements of "
            "/images");
}

TEST(GltfSpecularGlossiness, BecomesADielectricOfInfiniteIndexWithASpecularColour) {
  const Material m = extended("KHR_materials_pbrSpecularGlossiness",
                              {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                               {"specularFactor", {0.5, 0.25, 0.125}},
                               {"glossinessFactor", 0.75},
                               {"diffuseTexture", {{"index", 1}}},
                               {"specularGlossinessTexture", {{"index", 2}, {"texCoord", 1}}}});
  EXPECT_TRUE(m.specularGlossiness);
  EXPECT_EQ(m.baseColorFactor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallicFactor, 0.0f);
  EXPECT_EQ(m.roughnessFactor, 0.25f);
  EXPECT_EQ(m.ior, kInfiniteIor);
  EXPECT_EQ(m.specularColorFactor, glm::vec3(0.5, 0.25, 0.125));
  EXPECT_TRUE(m.baseColorTexture.present());
  EXPECT_EQ(m.specularColorTexture.texcoord, 1u);
}

TEST(GltfSpecularGlossiness, DefaultsAreThoseOfTheSpecification) {
  const Material m = extended("KHR_materials_pbrSpecularGlossiness", json::object());
  EXPECT_EQ(m.baseColorFactor, glm::vec4(1.0f));
  EXPECT_EQ(m.specularColorFactor, glm::vec3(1.0f));
  EXPECT_EQ(m.roughnessFactor, 0.0f);
  EXPECT_FALSE(extended("KHR_materials_ior", {{"ior", 1.2}}).specularGlossiness);
}

TEST(GltfSpecularGlossiness, WinsOverMetallicRoughnessWhosePicturesAreNotRead) {
  GltfBuilder builder =
      fileWith({{"pbrMetallicRoughness",
                 {{"baseColorFactor", {0, 0, 0, 1}},
                  {"metallicFactor", 0.5},
                  {"metallicRoughnessTexture", {{"index", 0}}}}},
                {"extensions",
                 {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseTexture", {{"index", 1}}}}},
                  {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                  {"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}}}}});
  const Scene scene = load(builder);
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.baseColorFactor, glm::vec4(1.0f));
  EXPECT_FALSE(m.metallicRoughnessTexture.present());
  EXPECT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(m.transmissionFactor, 0.0f);
  EXPECT_EQ(m.emissiveStrength, 2.0f);
  EXPECT_TRUE(anyWarningHas(scene, "/materials/0/extensions/KHR_materials_transmission: does not go with"));
}

TEST(GltfSpecularGlossiness, ColoursOutOfRangeAreBroughtBack) {
  expectWarning({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"specularFactor", {2, 0, 0}}}}}}},
                "extensions/KHR_materials_pbrSpecularGlossiness/specularFactor");
}

TEST(GltfLayers, DefaultsAreThoseOfTheSpecifications) {
  const Material m = materialWith({{"name", "plain"}});
  EXPECT_FALSE(m.clearcoated() || m.hasSheen() || m.anisotropic() || m.iridescent() || m.passesLight() ||
               m.disperses());
  const Material film = extended("KHR_materials_iridescence", {{"iridescenceFactor", 1}});
  EXPECT_EQ(film.iridescenceIor, 1.3f);
  EXPECT_EQ(film.iridescenceThicknessMinimum, 100.0f);
  EXPECT_EQ(film.iridescenceThicknessMaximum, 400.0f);
  EXPECT_EQ(extended("KHR_materials_clearcoat", {{"clearcoatFactor", 1}}).clearcoatRoughnessFactor, 0.0f);
  EXPECT_EQ(extended("KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1}})
                .diffuseTransmissionColorFactor,
            glm::vec3(1.0f));
}

TEST(GltfLayers, ClearcoatIsRead) {
  const Material m =
      extended("KHR_materials_clearcoat", {{"clearcoatFactor", 0.5},
                                           {"clearcoatTexture", {{"index", 0}}},
                                           {"clearcoatRoughnessFactor", 0.25},
                                           {"clearcoatRoughnessTexture", {{"index", 1}, {"texCoord", 1}}},
                                           {"clearcoatNormalTexture", {{"index", 2}, {"scale", 0.75}}}});
  EXPECT_EQ(m.clearcoatFactor, 0.5f);
  EXPECT_EQ(m.clearcoatRoughnessFactor, 0.25f);
  EXPECT_EQ(m.clearcoatNormalScale, 0.75f);
  EXPECT_TRUE(m.clearcoatTexture.present());
  EXPECT_EQ(m.clearcoatRoughnessTexture.texcoord, 1u);
  EXPECT_TRUE(m.clearcoatNormalTexture.present());
}

TEST(GltfLayers, SheenIsRead) {
  const Material m = extended("KHR_materials_sheen", {{"sheenColorFactor", {0.5, 0.25, 1}},
                                                      {"sheenColorTexture", {{"index", 0}}},
                                                      {"sheenRoughnessFactor", 0.75},
                                                      {"sheenRoughnessTexture", {{"index", 1}}}});
  EXPECT_EQ(m.sheenColorFactor, glm::vec3(0.5, 0.25, 1));
  EXPECT_EQ(m.sheenRoughnessFactor, 0.75f);
  EXPECT_NE(m.sheenColorTexture.texture, m.sheenRoughnessTexture.texture);
}

TEST(GltfLayers, AnisotropyIridescenceDiffuseTransmissionAndDispersionAreRead) {
  const Material m = materialWith(
      {{"extensions",
        {{"KHR_materials_anisotropy",
          {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 1.5}, {"anisotropyTexture", {{"index", 3}}}}},
         {"KHR_materials_iridescence",
          {{"iridescenceFactor", 0.5},
           {"iridescenceTexture", {{"index", 4}}},
           {"iridescenceIor", 1.75},
           {"iridescenceThicknessMinimum", 500},
           {"iridescenceThicknessMaximum", 200},
           {"iridescenceThicknessTexture", {{"index", 5}}}}},
         {"KHR_materials_diffuse_transmission",
          {{"diffuseTransmissionFactor", 0.25},
           {"diffuseTransmissionTexture", {{"index", 6}}},
           {"diffuseTransmissionColorFactor", {0.5, 1, 0}},
           {"diffuseTransmissionColorTexture", {{"index", 7}}}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume", {{"thicknessFactor", 1}}},
         {"KHR_materials_dispersion", {{"dispersion", 0.5}}}}}});
  EXPECT_EQ(m.anisotropyStrength, 0.5f);
  EXPECT_EQ(m.anisotropyRotation, 1.5f);
  EXPECT_TRUE(m.anisotropyTexture.present());
  EXPECT_EQ(m.iridescenceIor, 1.75f);
  EXPECT_EQ(m.iridescenceThicknessMinimum, 500.0f) << "may be above the maximum";
  EXPECT_EQ(m.iridescenceThicknessMaximum, 200.0f);
  EXPECT_TRUE(m.iridescenceTexture.present() && m.iridescenceThicknessTexture.present());
  EXPECT_EQ(m.diffuseTransmissionColorFactor, glm::vec3(0.5, 1, 0));
  EXPECT_TRUE(m.diffuseTransmissionTexture.present() && m.diffuseTransmissionColorTexture.present());
  EXPECT_TRUE(m.passesLight());
  EXPECT_TRUE(m.disperses());
}

TEST(GltfLayers, PicturesOfALayerThatIsOffAreNotRead) {
  GltfBuilder builder = fileWith(
      {{"extensions",
        {{"KHR_materials_clearcoat", {{"clearcoatTexture", {{"index", 0}}}}},
         {"KHR_materials_sheen", {{"sheenColorTexture", {{"index", 1}}}}},
         {"KHR_materials_anisotropy", {{"anisotropyTexture", {{"index", 2}}}}},
         {"KHR_materials_iridescence", {{"iridescenceTexture", {{"index", 3}}}}},
         {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionTexture", {{"index", 4}}}}}}}});
  EXPECT_TRUE(load(builder).images.empty());
}

TEST(GltfLayers, FactorsOutOfRangeAreBroughtBackAtTheirPlace) {
  const auto at = [](const char* extension, const char* member, const json& value) {
    const std::string name = std::string("KHR_materials_") + extension;
    expectWarning({{"extensions", {{name, {{member, value}}}}}}, "extensions/" + name + "/" + member);
  };
  at("clearcoat", "clearcoatFactor", 1.5);
  at("clearcoat", "clearcoatRoughnessFactor", -1);
  at("sheen", "sheenColorFactor", {0, 0, 2});
  at("sheen", "sheenRoughnessFactor", 2);
  at("anisotropy", "anisotropyStrength", -0.5);
  at("iridescence", "iridescenceIor", 0.5);
  at("iridescence", "iridescenceThicknessMaximum", -1);
  at("diffuse_transmission", "diffuseTransmissionFactor", 7);
  at("diffuse_transmission", "diffuseTransmissionColorFactor", {2, 1, 1});
  at("dispersion", "dispersion", -1);
}

TEST(GltfLayers, WrongTypesAndReferencesAreNamedAtTheirPlace) {
  GltfBuilder builder = fileWith({{"extensions", {{"KHR_materials_sheen", {{"sheenColorFactor", {1, 1}}}}}}});
  EXPECT_EQ(faultOf(builder),
            "test.gltf: /materials/0/extensions/KHR_materials_sheen/sheenColorFactor: does not hold 3 "
            "numbers; it is "
            "taken as absent");
  builder = fileWith(
      {{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatNormalTexture", {{"index", 99}}}}}}}});
  builder.addTriangle()["material"] = 0;
  EXPECT_EQ(
      refusalOf(builder),
      "test.gltf: /materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/index: index 99 "
      "is past the 8 elements of /textures");
}

TEST(GltfLayers, AnisotropyAndTheClearcoatsNormalsMakeTangents) {
  for (const json& extensions :
       {json{{"KHR_materials_anisotropy", {{"anisotropyStrength", 1}}}},
        json{{"KHR_materials_clearcoat",
              {{"clearcoatFactor", 1}, {"clearcoatNormalTexture", {{"index", 0}}}}}}}) {
    GltfBuilder builder = fileWith({{"extensions", extensions}});
    json& primitive = builder.addTriangle();
    primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {0, 1, 1, 1, 0, 0});
    primitive["material"] = 0;
    const Scene scene = load(builder);
    ASSERT_EQ(scene.vertices.tangent.size(), 3u) << extensions;
    EXPECT_LE(glm::distance(scene.vertices.tangent[0], glm::vec4(1, 0, 0, 1)), 1e-6f) << extensions;
  }
}

/// A transmissive solid of which 10 % of the light is left after 0.5 m, with one more extension.
json solidWith(const char* name, const json& extension) {
  return {{"extensions",
           {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
            {"KHR_materials_volume",
             {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {0.1, 0.1, 0.1}}}},
            {name, extension}}}};
}

TEST(GltfScatter, WithoutAStrengthNothingScatters) {
  const Material m =
      materialWith(solidWith("KHR_materials_scatter", {{"multiscatterColorFactor", {1, 0.5, 0.2}}}));
  EXPECT_EQ(m.scatterStrength, 0.0f);
  EXPECT_TRUE(m.attenuates());
  EXPECT_FALSE(m.scattersInside());
}

TEST(GltfScatter, IsRead) {
  const Material m = materialWith(
      solidWith("KHR_materials_scatter", {{"scatterStrengthFactor", 0.75},
                                          {"scatterStrengthTexture", {{"index", 1}}},
                                          {"multiscatterColorFactor", {1, 0.5, 0.25}},
                                          {"multiscatterColorTexture", {{"index", 2}, {"texCoord", 1}}},
                                          {"scatterAnisotropy", -0.5}}));
  EXPECT_EQ(m.scatterStrength, 0.75f);
  EXPECT_EQ(m.multiscatterColor, glm::vec3(1.0f, 0.5f, 0.25f));
  EXPECT_EQ(m.scatterAnisotropy, -0.5f);
  EXPECT_TRUE(m.scatterStrengthTexture.present());
  EXPECT_EQ(m.multiscatterColorTexture.texcoord, 1u);
  EXPECT_TRUE(m.scattersInside());
  EXPECT_FALSE(m.scattersThinly());
  EXPECT_FALSE(m.scatterOfDraft);
}

TEST(GltfScatter, NeedsAnAttenuationDistanceInASolid) {
  json material = solidWith("KHR_materials_scatter", {{"scatterStrengthFactor", 1}});
  material["extensions"]["KHR_materials_volume"].erase("attenuationDistance");
  EXPECT_FALSE(materialWith(material).scattersInside());
  material["extensions"].erase("KHR_materials_volume");
  EXPECT_TRUE(materialWith(material).scattersThinly());
}

TEST(GltfScatter, TheDraftBeforeHasTwoNamesOfItsColour) {
  for (const char* name : {"multiscatterColor", "multiscatterColorFactor"}) {
    const Material m = materialWith(
        solidWith("KHR_materials_volume_scatter", {{name, {0.5, 0.25, 0}}, {"scatterAnisotropy", 0.5}}));
    EXPECT_EQ(m.scatterStrength, 1.0f);
    EXPECT_EQ(m.multiscatterColor, glm::vec3(0.5f, 0.25f, 0.0f));
    EXPECT_TRUE(m.scatterOfDraft);
  }
  EXPECT_FALSE(materialWith(solidWith("KHR_materials_volume_scatter", json::object())).scattersInside());
}

TEST(GltfScatter, DoesNotGoWithDiffuseTransmissionNorUnlit) {
  json material = solidWith("KHR_materials_scatter", {{"scatterStrengthFactor", 1}});
  material["extensions"]["KHR_materials_diffuse_transmission"] = {{"diffuseTransmissionFactor", 0.5}};
  EXPECT_FALSE(materialWith(material).scattersInside());
  expectWarning(material, "extensions/KHR_materials_scatter/scatterStrengthFactor");
  json unlit = solidWith("KHR_materials_scatter", {{"scatterStrengthFactor", 1}});
  unlit["extensions"]["KHR_materials_unlit"] = json::object();
  EXPECT_FALSE(materialWith(unlit).scattersInside());
}

TEST(GltfScatter, FactorsOutOfRangeAreBroughtBackAtTheirPlace) {
  const auto at = [](const char* member, const json& value) {
    json extension{{"scatterStrengthFactor", 1}};
    extension[member] = value;
    expectWarning(solidWith("KHR_materials_scatter", extension),
                  std::string("extensions/KHR_materials_scatter/") + member);
  };
  at("scatterStrengthFactor", 2);
  at("scatterAnisotropy", -1);
  at("multiscatterColorFactor", {1, 2, 1});
}

}  // namespace
}  // namespace fragtrace::gltf_test
