// SPDX-License-Identifier: MIT
// Features of scenes by which the shader can be cut down: one table row each, from which variants, the shader
// prelude and statistics follow.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "scene/scene.h"
#include "shader/layout.h"
#include "shader/stage.h"

namespace fragtrace {

/// A feature of a scene by which the shader can be cut down.
enum class Trait : uint8_t {
  Triangles,
  Spheres,
  SingleSided,
  Alpha,
  Texcoords,
  VertexNormals,
  Tangents,
  VertexColors,
  SpecularGlossiness,
  TextureTransforms,
  WideTextures,
  Clearcoat,
  Sheen,
  Anisotropy,
  Iridescence,
  DiffuseTransmission,
  Dispersion,
  GlassSpecular,
  PerlinNormals,
  Specular,
  Metals,
  Transmission,
  ThinGlass,
  RoughGlass,
  Absorption,
  Scattering,
  NestedSolids,
  MatchedGlass,
  ThinScattering,
  Fog,
  DensityGrid,
  Unlit,
  Emission,
  EmissiveTriangles,
  PunctualLights,
  LightTree,
  Caustics,
  Environment,
  EnvironmentSampling,
  Backdrop,
  Sun,
  MapSun,
  Instances,
  Creases,
  Coincident,
  Slivers,
  SmoothSurfaces,
  ObjectNumbers,
  MovingCamera,
  MovingSurfaces,
  FirstTexture,  ///< then one for each slot of textures
  Count = FirstTexture + layout::kSlotCount
};
using TraitSet = SetOf<Trait>;

/// The trait of scenes with a texture in the slot, one of layout::kSlotBaseColor and so on.
constexpr Trait slotTrait(uint32_t slot) { return Trait(uint32_t(Trait::FirstTexture) + slot); }

/// Returns true if some slot has a texture; spheres compute their coordinates, without Trait::Texcoords.
inline bool readsTextures(const TraitSet& traits) { return (traits >> size_t(Trait::FirstTexture)).any(); }

/// Returns true if the light that a lamp emits depends on a texture: of emission, alpha or the clearcoat over
/// it.
inline bool readsLampTextures(const TraitSet& traits) {
  const auto has = [&](Trait trait) { return traits[size_t(trait)]; };
  return has(Trait::Texcoords) &&
         (has(slotTrait(layout::kSlotEmission)) || has(slotTrait(layout::kSlotClearcoat)) ||
          (has(Trait::Alpha) && has(slotTrait(layout::kSlotBaseColor))));
}

/// The attributes that primitives bring for their materials' maps; spheres bring all of them.
struct Coordinates {
  bool texcoord0 = true;
  bool tangents = true;
};

struct TraitRow {
  Trait trait;
  std::string name;                            ///< shown in the statistics and the variant's name
  const char* constant = nullptr;              ///< the constant's name in the shader; slots have none
  const char* absence = "";                    ///< why something that needs it is off
  StageSet stages{};                           ///< the trait is off if one of these stages is off
  TraitSet needs{};                            ///< the trait is off if one of these traits is off
  bool texcoords = false;                      ///< the trait reads texture coordinates
  bool (Material::*effect)() const = nullptr;  ///< of materials that have the trait
  /// Returns true if a material has the trait. Null without an effect: the scene as a whole has it or not
  /// (traitsOf).
  std::function<bool(const Material& material, const Coordinates& coordinates)> ofMaterial{};
};
std::span<const TraitRow> traitRows();

/// Returns true if there are lamps among which light samples choose: emissive triangles or punctual lights.
inline bool hasLamps(const TraitSet& traits) {
  return traits[size_t(Trait::EmissiveTriangles)] || traits[size_t(Trait::PunctualLights)];
}

/// Returns true if there is a sun that light samples and light paths take (kSunPaths).
inline bool samplesSun(const TraitSet& traits) {
  return (traits[size_t(Trait::Sun)] || traits[size_t(Trait::MapSun)]) &&
         traits[size_t(Trait::EnvironmentSampling)];
}

/// Returns true if light may be scattered between surfaces.
inline bool hasMedia(const TraitSet& traits) {
  return traits[size_t(Trait::Scattering)] || traits[size_t(Trait::Fog)] ||
         traits[size_t(Trait::DensityGrid)];
}

/// Returns true if paths have a time: the camera or surfaces move while the shutter is open.
inline bool isTimed(const TraitSet& traits) {
  return traits[size_t(Trait::MovingCamera)] || traits[size_t(Trait::MovingSurfaces)];
}

}  // namespace fragtrace
