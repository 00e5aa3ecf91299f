// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/forced_variants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

namespace fragtrace {
namespace {

std::vector<ForcedVariant> forcedOf(Stage stage, const TraitSet& present,
                                    Surroundings surroundings = Surroundings::None) {
  RenderOptions options;
  options.stages = stagesUpTo(stage);
  return forcedVariants(options, present, surroundings, 10, BufferReads::Image);
}

const ForcedVariant& named(const std::vector<ForcedVariant>& all, std::string_view name) {
  const auto found = std::ranges::find(all, name, &ForcedVariant::name);
  EXPECT_NE(found, all.end()) << name;
  return *found;
}

TraitSet traits(std::initializer_list<Trait> members) {
  TraitSet set;
  for (const Trait t : members) set.set(size_t(t));
  return set;
}

TEST(ForcedVariants, EachTraitThatIsLackingIsTurnedOnOrRefusedWithAReason) {
  for (const Stage stage : {Stage::Flat, Stage::Shadows, Stage::Gi}) {
    const TraitSet present = traits({Trait::Triangles, Trait::EmissiveTriangles, Trait::Emission});
    const auto all = forcedOf(stage, present);
    for (const TraitRow& row : traitRows()) {
      const bool there = std::ranges::count(all, row.name, &ForcedVariant::name) > 0;
      RenderOptions options;
      options.stages = stagesUpTo(stage);
      const ShaderVariant own = chooseVariant(options, present, Surroundings::None, 10, BufferReads::Image);
      EXPECT_NE(there, has(own.traits, row.trait)) << row.name;
      if (!there) continue;
      const ForcedVariant& f = named(all, row.name);
      const bool refused = !f.whyNot.empty() && !f.whyNot.starts_with("comes with ");
      EXPECT_NE(refused, has(f.variant.traits, row.trait)) << row.name;
    }
  }
}

TEST(ForcedVariants, InGiAllTraitsTogetherAreAllThatCanBe) {
  const auto all = forcedOf(Stage::Gi, traits({Trait::Triangles, Trait::PunctualLights}));
  for (const ForcedVariant& f : all) {
    // One variant is drawn once: these bring each other.
    const bool twin = f.name == "base-color-texture" || f.name == "normal-texture";
    EXPECT_EQ(f.whyNot.starts_with("comes with t"), twin) << f.name;
    // No stage of gi, and an option.
    const bool elsewhere = f.name == "smooth-surfaces" || f.name == "object-numbers" || f.name == "fog";
    EXPECT_EQ(f.whyNot.empty(), !twin && !elsewhere) << f.name;
  }
  TraitSet most = named(all, "all traits").variant.traits;
  for (const Trait t : {Trait::SmoothSurfaces, Trait::ObjectNumbers, Trait::Fog}) most.set(size_t(t));
  // Light paths know no media.
  EXPECT_FALSE(has(most, Trait::Caustics));
  for (const Trait t : {Trait::Caustics, Trait::MapSun}) most.set(size_t(t));
  EXPECT_TRUE(most.all());
  EXPECT_TRUE(has(named(all, "transmission").variant.stages, Stage::Refraction));
  EXPECT_TRUE(has(named(all, "metals").variant.stages, Stage::Reflections));
  EXPECT_TRUE(named(all, "environment-sampling").otherSamples);
  EXPECT_FALSE(named(all, "alpha").otherSamples);
}

TEST(ForcedVariants, WhatNoStageReadsIsNotForced) {
  const auto all = forcedOf(Stage::Flat, traits({Trait::Triangles}));
  for (const char* name : {"specular", "transmission", "normal-texture", "punctual-lights", "environment"})
    EXPECT_NE(named(all, name).whyNot, "") << name;
  for (const char* name : {"spheres", "alpha", "texcoords", "vertex-colors"})
    EXPECT_EQ(named(all, name).whyNot, "") << name;
  EXPECT_FALSE(has(named(all, "all traits").variant.traits, Trait::Specular));
}

TEST(ForcedVariants, LightTablesAreNotReadWithoutAnyLight) {
  const TraitSet dark = traits({Trait::Triangles});
  for (const Stage stage : {Stage::Shadows, Stage::Gi}) {
    EXPECT_NE(named(forcedOf(stage, dark), "emissive-triangles").whyNot, "");
    EXPECT_NE(named(forcedOf(stage, dark), "punctual-lights").whyNot, "");
  }
  // An environment takes all light samples in gi; before it, each kind of light has its own.
  const TraitSet outside = traits({Trait::Triangles, Trait::Environment, Trait::EnvironmentSampling});
  EXPECT_EQ(named(forcedOf(Stage::Gi, outside, Surroundings::Map), "emissive-triangles").whyNot, "");
  EXPECT_NE(named(forcedOf(Stage::Shadows, outside, Surroundings::Map), "emissive-triangles").whyNot, "");
}

TEST(ForcedVariants, StackAndSuspensionAreTurnedOnByThemselves) {
  const auto all = forcedOf(Stage::Gi, traits({Trait::Triangles}));
  EXPECT_EQ(named(all, "stack-32").variant.stackSize, 32);
  EXPECT_TRUE(named(all, "resumable").variant.resumable);
  EXPECT_FALSE(named(all, "stack-32").variant.resumable);
}

}  // namespace
}  // namespace fragtrace
