// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/forced_variants.h"

#include <algorithm>
#include <utility>

namespace fragtrace {

namespace {

bool choosesLights(Trait trait) {
  return trait == Trait::EmissiveTriangles || trait == Trait::PunctualLights || trait == Trait::LightTree ||
         trait == Trait::EnvironmentSampling || trait == Trait::MapSun;
}

}  // namespace

std::vector<ForcedVariant> forcedVariants(const RenderOptions& options, const TraitSet& present,
                                          Surroundings surroundings, uint32_t treeDepth, BufferReads reads) {
  const ShaderVariant own = chooseVariant(options, present, surroundings, treeDepth, reads);
  const auto chosenWith = [&](const TraitSet& traits) {
    // Only a map can be sampled. So if the traits force sampling of the environment, the default light is
    // treated as a map.
    const bool map = has(traits, Trait::EnvironmentSampling) && !has(own.traits, Trait::EnvironmentSampling);
    return chooseVariant(options, traits, map ? Surroundings::Map : surroundings, treeDepth, reads);
  };
  const auto canChooseLights = [&](const ShaderVariant& v) {
    // In gi an environment takes all light samples where there is nothing else.
    const bool environment = has(v.stages, Stage::Gi) && has(v.traits, Trait::EnvironmentSampling);
    return !hasLamps(v.traits) || hasLamps(own.traits) || environment;
  };

  std::vector<ForcedVariant> forced;
  TraitSet all = present;
  for (const TraitRow& row : traitRows()) {
    if (has(own.traits, row.trait)) continue;
    ForcedVariant f;
    f.name = row.name;
    f.variant = chosenWith(present | withNeeded(row.trait));
    if (!has(f.variant.traits, row.trait)) {
      f.whyNot = "no stage that is on reads it";
    } else if (!canChooseLights(f.variant)) {
      f.whyNot = "there is no light for its table";
    } else {
      all |= withNeeded(row.trait);
    }
    for (const ForcedVariant& other : forced) {
      if (f.whyNot.empty() && other.variant == f.variant) f.whyNot = "comes with " + other.name;
    }
    // Media take the light paths away.
    const bool lightPaths = has(own.traits, Trait::Caustics) == has(f.variant.traits, Trait::Caustics);
    f.otherSamples = choosesLights(row.trait) || !lightPaths;
    forced.push_back(std::move(f));
  }
  const auto add = [&](const char* name, const ShaderVariant& variant) {
    ForcedVariant f;
    f.name = name;
    f.variant = variant;
    if (f.variant == own) f.whyNot = "it is on";
    forced.push_back(std::move(f));
  };
  add("all traits", chosenWith(all));
  forced.back().otherSamples = true;
  ShaderVariant deep = own;
  deep.stackSize = std::max(own.stackSize, 32);
  add("stack-32", deep);
  ShaderVariant resumable = own;
  resumable.resumable = true;
  add("resumable", resumable);
  if (own.traversal == TraversalMethod::Iterative) forced[forced.size() - 2].whyNot = "no tree, no stack";
  return forced;
}

}  // namespace fragtrace
