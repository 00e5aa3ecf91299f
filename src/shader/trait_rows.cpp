// SPDX-License-Identifier: MIT
#include <algorithm>
#include <initializer_list>
#include <type_traits>
#include <vector>

#include "shader/material_kinds.h"
#include "shader/traits.h"

namespace fragtrace {
namespace {

template <typename Member>
auto setOf(std::initializer_list<Member> members) {
  std::conditional_t<std::is_same_v<Member, Stage>, StageSet, TraitSet> set;
  for (const Member member : members) set.set(size_t(member));
  return set;
}

std::vector<TraitRow> plainRows() {  // NOLINT(readability-function-size): a table
  return {
      {.trait = Trait::Triangles, .name = "triangles", .constant = "kTriangles", .absence = "no triangle"},
      {.trait = Trait::Spheres, .name = "spheres", .constant = "kSpheres", .absence = "no sphere"},
      {.trait = Trait::SingleSided,
       .name = "single-sided",
       .constant = "kCulling",
       .absence = "no single-sided surface",
       .effect = &Material::culled},
      {.trait = Trait::Alpha,
       .name = "alpha",
       .constant = "kAlpha",
       .absence = "no alpha that lets light pass",
       .effect = &Material::testsAlpha},
      {.trait = Trait::Texcoords,
       .name = "texcoords",
       .constant = "kTexcoords",
       .absence = "no texture coordinates in use"},
      {.trait = Trait::VertexNormals,
       .name = "vertex-normals",
       .constant = "kVertexNormals",
       .absence = "no vertex normals",
       .stages = setOf({Stage::Phong})},
      {.trait = Trait::Tangents,
       .name = "tangents",
       .constant = "kTangents",
       .absence = "no tangents in use"},
      {.trait = Trait::VertexColors,
       .name = "vertex-colors",
       .constant = "kVertexColors",
       .absence = "no vertex colours"},
      {.trait = Trait::SpecularGlossiness,
       .name = "specular-glossiness",
       .constant = "kSpecularGlossiness",
       .absence = "no material of KHR_materials_pbrSpecularGlossiness",
       .stages = setOf({Stage::Phong}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.specularGlossiness; }},
      {.trait = Trait::TextureTransforms,
       .name = "texture-transforms",
       .constant = "kTextureTransforms",
       .absence = "no transformed texture",
       .ofMaterial =
           [](const Material& m, const Coordinates&) {
             return std::ranges::any_of(kTextureRefs,
                                        [&](const TextureRefRow& t) { return (m.*t.ref).transformed(); });
           }},
      {.trait = Trait::WideTextures,
       .name = "wide-textures",
       .constant = "kWideTextures",
       .absence = "no texture of 16 bits",
       .needs = setOf({Trait::Texcoords})},
      {.trait = Trait::Clearcoat,
       .name = "clearcoat",
       .constant = "kClearcoat",
       .absence = "no clearcoat",
       .stages = setOf({Stage::Gi}),
       .needs = setOf({Trait::Specular}),
       .effect = &Material::clearcoated},
      {.trait = Trait::Sheen,
       .name = "sheen",
       .constant = "kSheen",
       .absence = "no sheen",
       .stages = setOf({Stage::Gi}),
       .effect = &Material::hasSheen},
      {.trait = Trait::Anisotropy,
       .name = "anisotropy",
       .constant = "kAnisotropy",
       .absence = "no anisotropic material",
       .stages = setOf({Stage::Gi}),
       .needs = setOf({Trait::Specular}),
       .effect = &Material::anisotropic},
      {.trait = Trait::Iridescence,
       .name = "iridescence",
       .constant = "kIridescence",
       .absence = "no iridescent material",
       .stages = setOf({Stage::Gi}),
       .needs = setOf({Trait::Specular}),
       .effect = &Material::iridescent},
      {.trait = Trait::DiffuseTransmission,
       .name = "diffuse-transmission",
       .constant = "kDiffuseTransmission",
       .absence = "no material that lets diffuse light through",
       .stages = setOf({Stage::Refraction, Stage::Gi}),
       .effect = &Material::passesDiffusely},
      {.trait = Trait::Dispersion,
       .name = "dispersion",
       .constant = "kDispersion",
       .absence = "no dispersive material",
       .stages = setOf({Stage::Gi}),
       .needs = setOf({Trait::Transmission}),
       .effect = &Material::disperses},
      {.trait = Trait::GlassSpecular,
       .name = "glass-specular",
       .constant = "kGlassSpecular",
       .absence = "no specular factor on glass",
       .stages = setOf({Stage::Gi}),
       .needs = setOf({Trait::Transmission, Trait::Specular}),
       .ofMaterial = [](const Material& m,
                        const Coordinates&) { return m.transmissive() && m.scalesSpecular(); }},
      {.trait = Trait::PerlinNormals,
       .name = "perlin-normals",
       .constant = "kPerlinNormals",
       .absence = "no Perlin normal map",
       .stages = setOf({Stage::NormalMaps}),
       .texcoords = true,
       .ofMaterial = [](const Material& m,
                        const Coordinates& c) { return m.perlinNormal.amplitude != 0.0f && c.texcoord0; }},
      {.trait = Trait::Specular,
       .name = "specular",
       .constant = "kSpecular",
       .absence = "no surface that reflects",
       .stages = setOf({Stage::Phong}),
       .ofMaterial =
           [](const Material& m, const Coordinates&) {
             return m.metallicFactor > 0.0f || dielectricReflects(m) || m.transmissive() || m.clearcoated();
           }},
      {.trait = Trait::Metals,
       .name = "metals",
       .constant = "kMetals",
       .absence = "no metal",
       .stages = setOf({Stage::Phong}),
       .needs = setOf({Trait::Specular}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.metallicFactor > 0.0f; }},
      {.trait = Trait::Transmission,
       .name = "transmission",
       .constant = "kTransmission",
       .absence = "no transmissive material",
       .stages = setOf({Stage::Refraction}),
       .effect = &Material::transmissive},
      {.trait = Trait::ThinGlass,
       .name = "thin-glass",
       .constant = "kThinGlass",
       .absence = "no smooth transmissive wall without thickness",
       .stages = setOf({Stage::Refraction, Stage::Shadows}),
       .needs = setOf({Trait::Transmission}),
       .ofMaterial = [](const Material& m,
                        const Coordinates&) { return m.transmissive() && mayBeClearWall(m); }},
      {.trait = Trait::RoughGlass,
       .name = "rough-glass",
       .constant = "kRoughGlass",
       .absence = "no rough transmissive surface",
       .stages = setOf({Stage::Refraction, Stage::Gi}),
       .needs = setOf({Trait::Transmission}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.transmissive() && mayBeRough(m); }},
      {.trait = Trait::Absorption,
       .name = "absorption",
       .constant = "kAbsorption",
       .absence = "no absorbing volume",
       .stages = setOf({Stage::Refraction}),
       .effect = &Material::attenuates},
      {.trait = Trait::Scattering,
       .name = "scattering",
       .constant = "kScattering",
       .absence = "no volume that scatters",
       .stages = setOf({Stage::Refraction, Stage::Gi}),
       .needs = setOf({Trait::Absorption}),
       .effect = &Material::scattersInside},
      {.trait = Trait::NestedSolids,
       .name = "nested-solids",
       .constant = "kNestedSolids",
       .absence = "no solids of different materials with boxes that overlap"},
      {.trait = Trait::MatchedGlass,
       .name = "matched-glass",
       .constant = "kMatchedGlass",
       .absence = "no volume that scatters behind a smooth boundary of index 1",
       .stages = setOf({Stage::Shadows}),
       .needs = setOf({Trait::Scattering, Trait::Transmission}),
       .effect = &Material::scattersMatched},
      {.trait = Trait::ThinScattering,
       .name = "thin-scattering",
       .constant = "kThinScattering",
       .absence = "no thin wall that scatters",
       .stages = setOf({Stage::Refraction, Stage::Gi}),
       .needs = setOf({Trait::Transmission, Trait::DiffuseTransmission}),
       .effect = &Material::scattersThinly},
      {.trait = Trait::Fog,
       .name = "fog",
       .constant = "kFog",
       .absence = "no fog",
       .stages = setOf({Stage::Gi})},
      {.trait = Trait::DensityGrid,
       .name = "density-grid",
       .constant = "kDensityGrid",
       .absence = "no --volume",
       .stages = setOf({Stage::Gi})},
      {.trait = Trait::Unlit,
       .name = "unlit",
       .constant = "kUnlit",
       .absence = "no unlit material",
       .stages = setOf({Stage::Phong}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.unlit; }},
      {.trait = Trait::Emission,
       .name = "emission",
       .constant = "kEmission",
       .absence = "no emissive material",
       .stages = setOf({Stage::Phong}),
       .effect = &Material::emissive},
      {.trait = Trait::EmissiveTriangles,
       .name = "emissive-triangles",
       .constant = "kEmissiveTriangles",
       .absence = "no emissive triangle",
       .stages = setOf({Stage::Phong})},
      {.trait = Trait::PunctualLights,
       .name = "punctual-lights",
       .constant = "kPunctualLights",
       .absence = "no punctual light",
       .stages = setOf({Stage::Phong})},
      {.trait = Trait::LightTree,
       .name = "light-tree",
       .constant = "kLightTree",
       .absence = "no lights far apart",
       .stages = setOf({Stage::Gi})},
      {.trait = Trait::Caustics,
       .name = "caustics",
       .constant = "kCaustics",
       .absence = "no lamp or sun, or no glass or metal that is smooth enough for it",
       .stages = setOf({Stage::Gi, Stage::Shadows}),
       .needs = setOf({Trait::Specular})},
      {.trait = Trait::Environment,
       .name = "environment",
       .constant = "kEnvironment",
       .absence = "no environment"},
      {.trait = Trait::EnvironmentSampling,
       .name = "environment-sampling",
       .constant = "kEnvironmentSampling",
       .absence = "no environment map",
       .stages = setOf({Stage::Gi})},
      {.trait = Trait::Backdrop,
       .name = "backdrop",
       .constant = "kBackdrop",
       .absence = "no backdrop but the environment itself",
       .needs = setOf({Trait::Environment})},
      {.trait = Trait::Sun,
       .name = "sun",
       .constant = "kSun",
       .absence = "no sky with a sun",
       .needs = setOf({Trait::Environment})},
      {.trait = Trait::MapSun,
       .name = "map-sun",
       .constant = "kMapSun",
       .absence = "no map with a sun, or nothing that casts its caustics",
       .needs = setOf({Trait::Caustics, Trait::EnvironmentSampling})},
      {.trait = Trait::Instances, .name = "instances", .constant = "kInstances", .absence = "no shared mesh"},
      {.trait = Trait::Creases,
       .name = "creases",
       .constant = "kCreases",
       .absence = "no crease below 133 degrees, or no ray that leaves one"},
      {.trait = Trait::Coincident,
       .name = "coincident",
       .constant = "kCoincident",
       .absence = "no lamp in another surface, and no faces back to back"},
      {.trait = Trait::Slivers,
       .name = "slivers",
       .constant = "kSlivers",
       .absence = "no triangle long and thin enough to need its plane"},
      {.trait = Trait::SmoothSurfaces,
       .name = "smooth-surfaces",
       .constant = "kSmoothSurfaces",
       .absence = "no clear glass and no mirror, or no filter to see through them",
       .ofMaterial =  // kGuideAlpha of shaders/integrators/guide.glsl, and more than half of the light.
       [](const Material& m, const Coordinates&) {
         return m.roughnessFactor < 0.1f && (m.transmissive() || m.metallicFactor > 0.5f);
       }},
      {.trait = Trait::ObjectNumbers,
       .name = "object-numbers",
       .constant = "kObjectNumbers",
       .absence = "no layer of objects"},
      {.trait = Trait::MovingCamera,
       .name = "moving-camera",
       .constant = "kMovingCamera",
       .absence = "no camera that moves while the shutter is open"},
      {.trait = Trait::MovingSurfaces,
       .name = "moving-surfaces",
       .constant = "kMoving",
       .absence = "no surface that moves while the shutter is open"},
  };
}

/// The trait of scenes that read the textures of a slot.
TraitRow slotRow(uint32_t slot, std::span<const TraitRow> plain) {
  const TextureRefRow& texture = kTextureRefs[slot];
  TraitRow row{.trait = slotTrait(slot), .name = std::string(texture.name) + " texture", .texcoords = true};
  std::ranges::replace(row.name, ' ', '-');
  if (texture.tangentSpace) row.stages = setOf({Stage::NormalMaps});
  for (const TraitRow& other : plain) {
    if (texture.effect && other.effect == texture.effect) row.needs.set(size_t(other.trait));
  }
  row.ofMaterial = [&texture](const Material& m, const Coordinates& c) {
    return (m.*texture.ref).present() && (!texture.effect || (m.*texture.effect)()) &&
           (c.tangents || !texture.tangentSpace);
  };
  return row;
}

}  // namespace

std::span<const TraitRow> traitRows() {
  static const std::vector<TraitRow> rows = [] {
    std::vector<TraitRow> all = plainRows();
    for (TraitRow& row : all) {
      const auto effect = row.effect;
      if (effect) row.ofMaterial = [effect](const Material& m, const Coordinates&) { return (m.*effect)(); };
    }
    for (uint32_t slot = 0; slot < layout::kSlotCount; ++slot) all.push_back(slotRow(slot, all));
    return all;
  }();
  return rows;
}

}  // namespace fragtrace
