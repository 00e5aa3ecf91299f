// SPDX-License-Identifier: MIT
// Tests what is decided about a file's own light by what a view shows of it.
#include "pack/own_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"
#include "scene/camera.h"

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

/// The same with a lamp before it, whose numbers are these.
GltfBuilder lit(const char* type, double intensity) {
  GltfBuilder builder = shining(0.0, false);
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", type}, {"intensity", intensity}}};
  builder.root["nodes"].push_back(
      {{"translation", {0, 0, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  return builder;
}

FileLight lightOf(GltfBuilder builder, LampUnits units = LampUnits::Auto, bool besideSurroundings = false) {
  const Scene scene = load(builder);
  return decideLight({scene, buildSceneBvh(scene)}, frameScene(scene.bounds), 1.0,
                     {units, besideSurroundings});
}

TEST(OwnLight, IsNoneWithoutLightsAndEmission) {
  GltfBuilder builder;
  builder.addTriangle();
  EXPECT_EQ(lightOf(builder).own, OwnLight::None);
  EXPECT_EQ(lightOf(shining(0.0, true)).own, OwnLight::None);
  EXPECT_EQ(lightOf(lit("point", 0.0)).own, OwnLight::None);
}

TEST(OwnLight, EmissionIsEnoughWhereItLightsWhatIsSeen) {
  EXPECT_EQ(lightOf(shining(1.0, false)).own, OwnLight::Enough);
  EXPECT_EQ(lightOf(shining(1.0, true)).own, OwnLight::Enough);
  EXPECT_EQ(lightOf(shining(1e-4, false)).own, OwnLight::Dim);
  EXPECT_EQ(lightOf(shining(1e-4, true)).own, OwnLight::Dim);
  GltfBuilder hall = shining(1.0, false);
  hall.addTriangle();
  hall.node(1)["scale"] = {50, 50, 50};
  EXPECT_EQ(lightOf(hall).own, OwnLight::Dim);
}

TEST(OwnLight, LampsAreEnoughAndTheirUnitsAreThoseThatExpose) {
  struct Row {
    const char* type;
    double intensity;
    bool isRadiometric;
    double exposure;  // 0, or its sign
  };
  for (const Row& row : {Row{"directional", 3.0, false, 0.0}, Row{"directional", 2000.0, true, 0.0},
                         Row{"directional", 100'000.0, true, -1.0}, Row{"directional", 1e-3, false, 1.0},
                         Row{"point", 10.0, false, 0.0}, Row{"point", 20'000.0, true, 0.0}}) {
    const FileLight light = lightOf(lit(row.type, row.intensity));
    EXPECT_EQ(light.own, OwnLight::Enough);
    EXPECT_EQ(light.lampScale != 1.0, row.isRadiometric) << row.type << row.intensity;
    EXPECT_EQ(exposureFor(light.mean) * row.exposure > 0.0, row.exposure != 0.0) << row.type << row.intensity;
    EXPECT_EQ(exposureFor(light.mean) == 0.0, row.exposure == 0.0) << row.type << row.intensity;
  }
  EXPECT_EQ(lightOf(lit("directional", 2000.0), LampUnits::Photometric).lampScale, 1.0);
  EXPECT_EQ(lightOf(lit("directional", 3.0), LampUnits::Radiometric).lampScale, 1.0 / kLumensPerWatt);
}

TEST(OwnLight, LampsThatAreTooBrightBesideSurroundingsAreRadiometric) {
  EXPECT_EQ(lightOf(lit("directional", 12.0)).lampScale, 1.0);
  EXPECT_EQ(lightOf(lit("directional", 12.0), LampUnits::Auto, true).lampScale, 1.0 / kLumensPerWatt);
  EXPECT_EQ(lightOf(lit("directional", 12.0), LampUnits::Photometric, true).lampScale, 1.0);
  EXPECT_EQ(lightOf(lit("directional", 3.0), LampUnits::Auto, true).lampScale, 1.0);
}

TEST(OwnLight, AFewBrightPlacesBesideSurroundingsStayAsWritten) {
  SeenLight seen;
  seen.cells.resize(16);
  for (size_t i = 0; i < 4; ++i) seen.cells[i].byLamps = 100.0 * kMiddleGrey;
  EXPECT_NEAR(seen.meanOfLampLit(1.0), 100.0 * kMiddleGrey, 1e-9);
  EXPECT_NEAR(seen.meanBesideSurroundings(1.0), std::pow(101.0, 0.25) * kMiddleGrey, 1e-9);
}

/// A matt surface of albedo 1 under a lamp that faces it shows E / pi.
TEST(SeenLight, IsThatOfAMattSurface) {
  GltfBuilder builder = lit("directional", 3.0);
  const Scene scene = load(builder);
  const SeenLight seen = seenLight({scene, buildSceneBvh(scene)}, frameScene(scene.bounds), 1.0);
  EXPECT_NEAR(seen.meanLuminance(1.0), 3.0 / 3.14159265, 1e-3);
  EXPECT_EQ(seen.paths, 256);
  EXPECT_EQ(seen.darkShare(1.0, 0.1), 0.0);
  EXPECT_EQ(seen.darkShare(0.01, 0.1), 1.0);
  const SeenLight again = seenLight({scene, buildSceneBvh(scene)}, frameScene(scene.bounds), 1.0);
  EXPECT_EQ(again.meanLuminance(1.0), seen.meanLuminance(1.0));
}

TEST(SeenLight, TakesNoMoreThanFourThousandPaths) {
  GltfBuilder builder = lit("directional", 2000.0);
  const Scene scene = load(builder);
  EXPECT_EQ(seenLight({scene, buildSceneBvh(scene)}, frameScene(scene.bounds), 1.0).paths, 4096);
}

}  // namespace
}  // namespace fragtrace::gltf_test
