// SPDX-License-Identifier: MIT
// Features of scenes by which the shader can be cut down: one table row each, from which variants, the shader
// prelude, benchmarks and statistics follow.
#pragma once

#include <array>
#include <span>

#include "scene/scene.h"
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
  BaseColorTexture,
  MetallicRoughnessTexture,
  NormalTexture,
  EmissionTexture,
  TransmissionTexture,
  SpecularTexture,
  SpecularGlossiness,
  TextureTransforms,
  WideTextures,
  Clearcoat,
  ClearcoatTexture,
  ClearcoatNormal,
  Sheen,
  SheenTexture,
  Anisotropy,
  AnisotropyTexture,
  Iridescence,
  IridescenceTexture,
  DiffuseTransmission,
  DiffuseTransmissionTexture,
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
  ThinScatteringTexture,
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
  Count
};
using TraitSet = SetOf<Trait>;

/// The attributes that primitives bring for their materials' maps; spheres bring all of them.
struct Coordinates {
  bool texcoord0 = true;
  bool tangents = true;
};

struct TraitRow {
  Trait trait;
  const char* name;      ///< shown in the statistics and the variant's name
  const char* constant;  ///< the constant's name in the shader
  const char* absence;   ///< why something that needs it is off
  StageSet stages{};     ///< the trait is off if one of these stages is off
  TraitSet needs{};      ///< the trait is off if one of these traits is off
  TraitSet brings{};     ///< traits that a scene must also have to show it
  /// The textures that the shader reads if the trait is on; the rest are null.
  std::array<TextureRef Material::*, 2> textures{};
  bool texcoords = false;  ///< the trait reads texture coordinates without a texture
  /// Returns true if a material has the trait. Null: a material with one of the trait's textures has it, and
  /// without textures the scene as a whole has it or not (traitsOf).
  bool (*ofMaterial)(const Material& material, const Coordinates& coordinates) = nullptr;
};
std::span<const TraitRow> traitRows();

bool isOfMaterial(const TraitRow& row, const Material& material, const Coordinates& coordinates);
bool readsTexcoords(const TraitRow& row);

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

/// The row that lists the texture; std::logic_error where none does.
const TraitRow& traitOfTexture(TextureRef Material::*texture);

/// The trait, the traits that it needs, and those that a scene with it would also have.
TraitSet withNeeded(Trait trait);

}  // namespace fragtrace
