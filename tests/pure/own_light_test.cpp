// SPDX-License-Identifier: MIT
// Tests whether a scene lights itself, or the default light must light it.
#include "pack/own_light.h"

#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

/// A triangle of half a square metre that emits, by a picture of one bluish pixel or evenly.
GltfBuilder shining(double factor, bool isTextured) {
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.root["textures"] = {{{"source", 0}}};
  json material = {{"emissiveFactor", {factor, factor, factor}}};
  if (isTextured) material["emissiveTexture"] = {{"index", 0}};
  builder.root["materials"] = nlohmann::json::array({material});
  json& primitive = builder.addTriangle();
  primitive["material"] = 0;
  primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {0, 1, 1, 1, 0, 0});
  return builder;
}

OwnLight lightOf(GltfBuilder builder) { return ownLight(load(builder)); }

TEST(OwnLight, IsNoneWithoutLightsAndEmission) {
  GltfBuilder builder;
  builder.addTriangle();
  EXPECT_EQ(lightOf(builder), OwnLight::None);
  EXPECT_EQ(lightOf(shining(0.0, true)), OwnLight::None);
}

TEST(OwnLight, EmissionWithoutATextureIsEnoughHoweverLittle) {
  EXPECT_EQ(lightOf(shining(1e-5, false)), OwnLight::Enough);
}

TEST(OwnLight, ATextureIsEnoughIfItIsBrightForTheSceneRoundIt) {
  EXPECT_EQ(lightOf(shining(1.0, true)), OwnLight::Enough);
  EXPECT_EQ(lightOf(shining(0.001, true)), OwnLight::Dim);
  GltfBuilder hall = shining(1.0, true);
  hall.addTriangle();
  hall.node(1)["scale"] = {50, 50, 50};
  EXPECT_EQ(lightOf(hall), OwnLight::Dim);
  hall.root["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 10000;
  EXPECT_EQ(lightOf(hall), OwnLight::Enough);
}

TEST(OwnLight, AnyOtherLightIsEnoughBesideADimTexture) {
  GltfBuilder lamp = shining(0.001, true);
  lamp.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  lamp.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  EXPECT_EQ(lightOf(lamp), OwnLight::Enough);
}

}  // namespace
}  // namespace fragtrace::gltf_test
