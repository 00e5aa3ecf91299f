// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "base/errors.h"
#include "bvh/bvh.h"
#include "shader/assemble.h"
#include "shader/variant.h"

namespace fragtrace {
namespace {

constexpr Trait kBaseColorTexture = slotTrait(layout::kSlotBaseColor);
constexpr Trait kRoughnessTexture = slotTrait(layout::kSlotMetallicRoughness);
constexpr Trait kCoatTexture = slotTrait(layout::kSlotClearcoat);
constexpr Trait kCoatNormal = slotTrait(layout::kSlotClearcoatNormal);

ShaderVariant variantOf(Stage stage, const TraitSet& present,
                        Surroundings surroundings = Surroundings::None) {
  RenderOptions options;
  options.stages = stagesUpTo(stage);
  return chooseVariant(options, present, surroundings, 10, BufferReads::Image);
}

TraitSet allTraits() { return TraitSet().set(); }

size_t usesOf(const std::string& constant) {
  size_t uses = 0;
  for (const EmbeddedShader& shader : embeddedShaders()) {
    for (size_t at = 0; (at = shader.text.find(constant, at)) != std::string_view::npos; ++at) ++uses;
  }
  return uses;
}

TEST(StageTable, EachRowStandsAtItsOwnIndex) {
  for (size_t i = 0; i < stageRows().size(); ++i) EXPECT_EQ(size_t(stageRows()[i].stage), i);
  for (size_t i = 0; i < traitRows().size(); ++i) EXPECT_EQ(size_t(traitRows()[i].trait), i);
}

TEST(StageTable, EachConstantIsUsedInTheShader) {
  for (const StageRow& row : stageRows()) {
    EXPECT_TRUE(row.constant == nullptr || usesOf(row.constant) > 0) << row.name;
  }
  for (const TraitRow& row : traitRows()) {
    EXPECT_TRUE(row.constant == nullptr || usesOf(row.constant) > 0) << row.name;
  }
}

TEST(StageTable, EachSlotOfTexturesIsReadIfItsTraitIsOn) {
  ShaderVariant v;
  v.stages.set();
  for (uint32_t slot = 0; slot < layout::kSlotCount; ++slot) {
    const std::string read = "textureSlot(material, " + std::to_string(slot) + "u)";
    const auto reads = [&] {
      return assembleShader({}, "entry/trace.frag", v).find(read) != std::string::npos;
    };
    v.traits.set();
    EXPECT_TRUE(reads()) << "slot " << slot;
    v.traits.reset(size_t(slotTrait(slot)));
    EXPECT_FALSE(reads()) << "slot " << slot;
  }
}

TEST(StageTable, AStageTurnsOnItselfAndAllBeforeIt) {
  // Four switches are on unless turned off.
  EXPECT_EQ(stagesUpTo(Stage::Flat).count(), 5u);
  EXPECT_EQ(stagesUpTo(Stage::Gi).count(), 11u);
  EXPECT_FALSE(has(stagesUpTo(Stage::Gi), Stage::Schlick));
  EXPECT_EQ(parseStage("normal-maps"), Stage::NormalMaps);
  EXPECT_EQ(parseStage("nonsense"), std::nullopt);
}

TEST(Variant, FlatNeedsNoLightAndNoNormals) {
  const ShaderVariant v = variantOf(Stage::Flat, allTraits(), Surroundings::Map);
  for (Trait t : {Trait::PunctualLights, Trait::EmissiveTriangles, Trait::VertexNormals, Trait::Tangents,
                  Trait::Specular, Trait::Transmission, slotTrait(layout::kSlotNormal), kRoughnessTexture}) {
    EXPECT_FALSE(has(v.traits, t)) << traitRows()[size_t(t)].name;
  }
  EXPECT_TRUE(has(v.traits, kBaseColorTexture));
}

TEST(Variant, LayersBelongToGiAndToWhatTheyLieOn) {
  constexpr Trait kLayers[] = {Trait::Clearcoat,  kCoatTexture,         kCoatNormal,
                               Trait::Sheen,      Trait::Anisotropy,    Trait::Iridescence,
                               Trait::Dispersion, Trait::GlassSpecular, Trait::DiffuseTransmission};
  for (const Trait t : kLayers) {
    EXPECT_TRUE(has(variantOf(Stage::Gi, allTraits()).traits, t)) << traitRows()[size_t(t)].name;
    EXPECT_FALSE(has(variantOf(Stage::NormalMaps, allTraits()).traits, t)) << traitRows()[size_t(t)].name;
  }
  TraitSet matte = allTraits();
  matte.reset(size_t(Trait::Specular));
  const ShaderVariant v = variantOf(Stage::Gi, matte);
  EXPECT_FALSE(has(v.traits, Trait::Clearcoat) || has(v.traits, kCoatTexture) ||
               has(v.traits, Trait::Iridescence));
  EXPECT_TRUE(has(v.traits, Trait::Sheen));
  // Anisotropy alone keeps tangents.
  TraitSet brushed = allTraits();
  for (Trait t : {slotTrait(layout::kSlotNormal), Trait::PerlinNormals, kCoatNormal})
    brushed.reset(size_t(t));
  EXPECT_TRUE(has(variantOf(Stage::Gi, brushed).traits, Trait::Tangents));
  brushed.reset(size_t(Trait::Anisotropy));
  EXPECT_FALSE(has(variantOf(Stage::Gi, brushed).traits, Trait::Tangents));
}

TEST(Variant, WhatTheSceneLacksIsOffWithItsReason) {
  TraitSet present;
  present.set(size_t(Trait::Triangles));
  const ShaderVariant v = variantOf(Stage::Gi, present);
  for (Stage s : {Stage::Shadows, Stage::Reflections, Stage::Refraction, Stage::NormalMaps}) {
    EXPECT_FALSE(has(v.stages, s)) << stageRows()[size_t(s)].name;
    EXPECT_FALSE(whyOff(s, present).empty());
  }
  EXPECT_TRUE(has(v.stages, Stage::Gi));
}

TEST(Variant, BeforeGiTheEnvironmentIsNotSampledAndCastsNoShadows) {
  TraitSet present;
  for (const Trait t : {Trait::Triangles, Trait::Environment, Trait::EnvironmentSampling})
    present.set(size_t(t));
  const ShaderVariant before = variantOf(Stage::NormalMaps, present);
  EXPECT_TRUE(has(before.traits, Trait::Environment));
  EXPECT_FALSE(has(before.traits, Trait::EnvironmentSampling));
  EXPECT_FALSE(has(before.stages, Stage::Shadows));
  EXPECT_FALSE(whyOff(Stage::Shadows, present, false).empty());
  EXPECT_TRUE(lightsByEnvironment(before));
  const ShaderVariant gi = variantOf(Stage::Gi, present);
  EXPECT_TRUE(has(gi.traits, Trait::EnvironmentSampling));
  EXPECT_TRUE(has(gi.stages, Stage::Shadows));
  EXPECT_TRUE(whyOff(Stage::Shadows, present).empty());
  EXPECT_FALSE(lightsByEnvironment(gi));
  EXPECT_FALSE(lightsByEnvironment(variantOf(Stage::Flat, present)));
  present.set(size_t(Trait::PunctualLights));
  EXPECT_TRUE(has(variantOf(Stage::Shadows, present).stages, Stage::Shadows));
  EXPECT_TRUE(whyOff(Stage::Shadows, present, false).empty());
}

TEST(Variant, ReducingAVariantTwiceChangesNothing) {
  for (const StageRow& row : stageRows()) {
    RenderOptions options;
    options.stages = stagesUpTo(row.cumulative ? row.stage : Stage::Gi).set(size_t(row.stage));
    const ShaderVariant once = chooseVariant(options, allTraits(), Surroundings::Map, 10, BufferReads::Image);
    options.stages = once.stages;
    const ShaderVariant twice =
        chooseVariant(options, once.traits, Surroundings::Map, 10, BufferReads::Image);
    EXPECT_EQ(variantName(once), variantName(twice));
  }
}

TEST(Variant, TheStackIsAtLeastTheDepthOfTheTree) {
  for (uint32_t depth = 0; depth <= kMaxTwoLevelDepth; ++depth) {
    const ShaderVariant v = chooseVariant({}, allTraits(), Surroundings::None, depth, BufferReads::Image);
    EXPECT_GE(uint32_t(v.stackSize), depth);
  }
}

TEST(ShaderText, AMissingIncludeThrows) {
  EXPECT_THROW(assembleShader({}, "nothing.glsl", ShaderVariant{}), RenderError);
}

TEST(ShaderText, EachFileIsPutInOnce) {
  const std::string text = assembleShader({}, "entry/trace.frag", ShaderVariant{});
  EXPECT_EQ(text.find("struct RayShear"), text.rfind("struct RayShear"));
  EXPECT_EQ(text.find("#include"), std::string::npos);
}

ShaderVariant pictureOf(DebugView view, const TraitSet& present) {
  RenderOptions options;
  options.output.debugView = view;
  return choosePictureVariant(options, present, Surroundings::Map, 10, BufferReads::Image);
}

TEST(DebugView, DrawsAFirstHitWithWhatItNeedsOnly) {
  const ShaderVariant geometric =
      pictureOf(DebugView::GeometricNormal, allTraits().reset(size_t(Trait::Alpha)));
  EXPECT_EQ(geometric.aov, Aov::GeometricNormal);
  for (Trait t : {Trait::Texcoords, Trait::VertexNormals, kBaseColorTexture, Trait::Environment})
    EXPECT_FALSE(has(geometric.traits, t)) << traitRows()[size_t(t)].name;
  const ShaderVariant rough = pictureOf(DebugView::Roughness, allTraits().reset(size_t(Trait::Alpha)));
  EXPECT_TRUE(has(rough.traits, kRoughnessTexture) && has(rough.traits, Trait::Texcoords));
  EXPECT_FALSE(has(rough.traits, kBaseColorTexture));
  // Alpha decides what is hit, whatever is shown.
  EXPECT_TRUE(has(pictureOf(DebugView::Depth, allTraits()).traits, kBaseColorTexture));
  const TraitSet plain(1ul << unsigned(Trait::Triangles) | 1ul << unsigned(Trait::Texcoords));
  EXPECT_TRUE(has(pictureOf(DebugView::Texcoords, plain).traits, Trait::Texcoords));
  EXPECT_FALSE(has(pictureOf(DebugView::Albedo, plain).traits, Trait::Texcoords));
}

TEST(DebugView, CountsAreThoseOfTheirPicture) {
  const RenderOptions options;
  const ShaderVariant picture =
      chooseVariant(options, allTraits(), Surroundings::Map, 10, BufferReads::Image);
  for (const DebugView view : {DebugView::None, DebugView::Samples, DebugView::Variance})
    EXPECT_EQ(pictureOf(view, allTraits()), picture);
  const ShaderVariant visits = pictureOf(DebugView::Visits, allTraits());
  EXPECT_TRUE(visits.countsVisits);
  EXPECT_FALSE(has(visits.stages, Stage::Phong));
  EXPECT_FALSE(has(visits.traits, Trait::Alpha));
}

}  // namespace
}  // namespace fragtrace
