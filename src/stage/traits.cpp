// SPDX-License-Identifier: MIT
#include "stage/traits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

namespace fragtrace {

namespace {

StageSet setOf(std::initializer_list<Stage> members) {
  StageSet set;
  for (const Stage stage : members) set.set(size_t(stage));
  return set;
}

TraitSet setOf(std::initializer_list<Trait> members) {
  TraitSet set;
  for (const Trait trait : members) set.set(size_t(trait));
  return set;
}

bool dielectricReflects(const Material& m) {
  return m.ior != 1.0f && m.specularFactor > 0.0f &&
         glm::any(glm::greaterThan(m.specularColorFactor, glm::vec3(0.0f)));
}

bool isRoughInPlaces(const Material& m) {
  return m.metallicRoughnessTexture.present() || m.specularGlossiness;
}

/// Light goes straight through such a wall, at least in places.
bool mayBeClearWall(const Material& m) {
  return m.thicknessFactor <= 0.0f && (isRoughInPlaces(m) || m.mirrorLike());
}

bool mayBeRough(const Material& m) { return isRoughInPlaces(m) || m.anisotropic() || !m.mirrorLike(); }

}  // namespace

std::span<const TraitRow> traitRows() {
  static const std::array<TraitRow, size_t(Trait::Count)> rows = {{
      {.trait = Trait::Triangles, .name = "triangles", .constant = "kTriangles", .absence = "no triangle"},
      {.trait = Trait::Spheres, .name = "spheres", .constant = "kSpheres", .absence = "no sphere"},
      {.trait = Trait::SingleSided,
       .name = "single-sided",
       .constant = "kCulling",
       .absence = "no single-sided surface",
       .ofMaterial = [](const Material& m,
                        const Coordinates&) { return !m.doubleSided && !m.passesLight(); }},
      {.trait = Trait::Alpha,
       .name = "alpha",
       .constant = "kAlpha",
       .absence = "no alpha MASK or BLEND",
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.alphaMode != AlphaMode::Opaque; }},
      {.trait = Trait::Texcoords,
       .name = "texcoords",
       .constant = "kTexcoords",
       .absence = "no texture coordinates in use",
       .brings = setOf({Trait::BaseColorTexture})},
      {.trait = Trait::VertexNormals,
       .name = "vertex-normals",
       .constant = "kVertexNormals",
       .absence = "no vertex normals",
       .stages = setOf({Stage::Phong})},
      {.trait = Trait::Tangents,
       .name = "tangents",
       .constant = "kTangents",
       .absence = "no tangents in use",
       .brings = setOf({Trait::NormalTexture, Trait::Texcoords})},
      {.trait = Trait::VertexColors,
       .name = "vertex-colors",
       .constant = "kVertexColors",
       .absence = "no vertex colours"},
      {.trait = Trait::BaseColorTexture,
       .name = "base-color-texture",
       .constant = "kBaseColorTexture",
       .absence = "no base colour texture",
       .textures = {&Material::baseColorTexture}},
      {.trait = Trait::MetallicRoughnessTexture,
       .name = "metallic-roughness-texture",
       .constant = "kMetallicRoughnessTexture",
       .absence = "no metallic-roughness texture",
       .stages = setOf({Stage::Phong}),
       .needs = setOf({Trait::Specular}),
       .textures = {&Material::metallicRoughnessTexture}},
      {.trait = Trait::NormalTexture,
       .name = "normal-texture",
       .constant = "kNormalTexture",
       .absence = "no normal texture",
       .stages = setOf({Stage::NormalMaps}),
       .brings = setOf({Trait::Tangents}),
       .textures = {&Material::normalTexture},
       .ofMaterial = [](const Material& m,
                        const Coordinates& c) { return m.normalTexture.present() && c.tangents; }},
      {.trait = Trait::EmissionTexture,
       .name = "emission-texture",
       .constant = "kEmissionTexture",
       .absence = "no emissive texture",
       .stages = setOf({Stage::Phong}),
       .brings = setOf({Trait::Emission}),
       .textures = {&Material::emissiveTexture},
       .ofMaterial = [](const Material& m,
                        const Coordinates&) { return m.emissive() && m.emissiveTexture.present(); }},
      {.trait = Trait::TransmissionTexture,
       .name = "transmission-texture",
       .constant = "kTransmissionTexture",
       .absence = "no transmission texture",
       .stages = setOf({Stage::Refraction}),
       .brings = setOf({Trait::Transmission}),
       .textures = {&Material::transmissionTexture},
       .ofMaterial = [](const Material& m,
                        const Coordinates&) { return m.transmissive() && m.transmissionTexture.present(); }},
      {.trait = Trait::SpecularTexture,
       .name = "specular-texture",
       .constant = "kSpecularTexture",
       .absence = "no specular texture",
       .stages = setOf({Stage::Phong}),
       .brings = setOf({Trait::Specular}),
       .textures = {&Material::specularTexture, &Material::specularColorTexture}},
      {.trait = Trait::SpecularGlossiness,
       .name = "specular-glossiness",
       .constant = "kSpecularGlossiness",
       .absence = "no material of KHR_materials_pbrSpecularGlossiness",
       .stages = setOf({Stage::Phong}),
       .brings = setOf({Trait::Specular}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.specularGlossiness; }},
      {.trait = Trait::TextureTransforms,
       .name = "texture-transforms",
       .constant = "kTextureTransforms",
       .absence = "no transformed texture",
       .brings = setOf({Trait::BaseColorTexture, Trait::Texcoords}),
       .ofMaterial =
           [](const Material& m, const Coordinates&) {
             return std::ranges::any_of(kTextureRefs,
                                        [&](const TextureRefRow& t) { return (m.*t.ref).transformed(); });
           }},
      {.trait = Trait::Clearcoat,
       .name = "clearcoat",
       .constant = "kClearcoat",
       .absence = "no clearcoat",
       .stages = setOf({Stage::Gi}),
       .needs = setOf({Trait::Specular}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.clearcoated(); }},
      {.trait = Trait::ClearcoatTexture,
       .name = "clearcoat-texture",
       .constant = "kClearcoatTexture",
       .absence = "no clearcoat texture",
       .needs = setOf({Trait::Clearcoat}),
       .textures = {&Material::clearcoatTexture, &Material::clearcoatRoughnessTexture}},
      {.trait = Trait::ClearcoatNormal,
       .name = "clearcoat-normal",
       .constant = "kClearcoatNormal",
       .absence = "no clearcoat normal texture",
       .stages = setOf({Stage::NormalMaps}),
       .needs = setOf({Trait::Clearcoat}),
       .brings = setOf({Trait::Tangents}),
       .textures = {&Material::clearcoatNormalTexture},
       .ofMaterial = [](const Material& m,
                        const Coordinates& c) { return m.clearcoatNormalTexture.present() && c.tangents; }},
      {.trait = Trait::Sheen,
       .name = "sheen",
       .constant = "kSheen",
       .absence = "no sheen",
       .stages = setOf({Stage::Gi}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.hasSheen(); }},
      {.trait = Trait::SheenTexture,
       .name = "sheen-texture",
       .constant = "kSheenTexture",
       .absence = "no sheen texture",
       .needs = setOf({Trait::Sheen}),
       .textures = {&Material::sheenColorTexture, &Material::sheenRoughnessTexture}},
      {.trait = Trait::Anisotropy,
       .name = "anisotropy",
       .constant = "kAnisotropy",
       .absence = "no anisotropic material",
       .stages = setOf({Stage::Gi}),
       .needs = setOf({Trait::Specular}),
       .brings = setOf({Trait::Tangents}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.anisotropic(); }},
      {.trait = Trait::AnisotropyTexture,
       .name = "anisotropy-texture",
       .constant = "kAnisotropyTexture",
       .absence = "no anisotropy texture",
       .needs = setOf({Trait::Anisotropy}),
       .textures = {&Material::anisotropyTexture}},
      {.trait = Trait::Iridescence,
       .name = "iridescence",
       .constant = "kIridescence",
       .absence = "no iridescent material",
       .stages = setOf({Stage::Gi}),
       .needs = setOf({Trait::Specular}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.iridescent(); }},
      {.trait = Trait::IridescenceTexture,
       .name = "iridescence-texture",
       .constant = "kIridescenceTexture",
       .absence = "no iridescence texture",
       .needs = setOf({Trait::Iridescence}),
       .textures = {&Material::iridescenceTexture, &Material::iridescenceThicknessTexture}},
      {.trait = Trait::DiffuseTransmission,
       .name = "diffuse-transmission",
       .constant = "kDiffuseTransmission",
       .absence = "no material that lets diffuse light through",
       .stages = setOf({Stage::Refraction, Stage::Gi}),
       .ofMaterial = [](const Material& m,
                        const Coordinates&) { return m.diffuseTransmissionFactor > 0.0f; }},
      {.trait = Trait::DiffuseTransmissionTexture,
       .name = "diffuse-transmission-texture",
       .constant = "kDiffuseTransmissionTexture",
       .absence = "no diffuse transmission texture",
       .needs = setOf({Trait::DiffuseTransmission}),
       .textures = {&Material::diffuseTransmissionTexture, &Material::diffuseTransmissionColorTexture}},
      {.trait = Trait::Dispersion,
       .name = "dispersion",
       .constant = "kDispersion",
       .absence = "no dispersive material",
       .stages = setOf({Stage::Gi}),
       .needs = setOf({Trait::Transmission}),
       .brings = setOf({Trait::Specular}),
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.disperses(); }},
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
       .brings = setOf({Trait::Tangents}),
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
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.transmissive(); }},
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
       .brings = setOf({Trait::Transmission}),
       .ofMaterial =
           [](const Material& m, const Coordinates&) {
             return m.passesLight() && m.thicknessFactor > 0.0f && m.attenuationColor != glm::vec3(1.0f) &&
                    std::isfinite(m.attenuationDistance);
           }},
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
       .ofMaterial = [](const Material& m, const Coordinates&) { return m.emissive(); }},
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
       .absence = "no lamp, or no smooth glass or metal",
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
       .stages = setOf({Stage::Gi}),
       .brings = setOf({Trait::Environment})},
      {.trait = Trait::Backdrop,
       .name = "backdrop",
       .constant = "kBackdrop",
       .absence = "no backdrop but the environment itself",
       .needs = setOf({Trait::Environment})},
      {.trait = Trait::Instances,
       .name = "instances",
       .constant = "kInstances",
       .absence = "no mesh that is shared"},
      {.trait = Trait::Creases,
       .name = "creases",
       .constant = "kCreases",
       .absence = "no crease below 101 degrees, or no ray that leaves one"},
      {.trait = Trait::Slivers,
       .name = "slivers",
       .constant = "kSlivers",
       .absence = "no triangle long and thin enough to need its plane"},
      {.trait = Trait::SmoothSurfaces,
       .name = "smooth-surfaces",
       .constant = "kSmoothSurfaces",
       .absence = "no clear glass and no mirror, or no filter to see through them",
       .ofMaterial =  // kGuideAlpha of shaders/guides.glsl, and more than half of the light.
       [](const Material& m, const Coordinates&) {
         return m.roughnessFactor < 0.1f && (m.transmissive() || m.metallicFactor > 0.5f);
       }},
      {.trait = Trait::ObjectNumbers,
       .name = "object-numbers",
       .constant = "kObjectNumbers",
       .absence = "no layer of objects"},
  }};
  return rows;
}

bool isOfMaterial(const TraitRow& row, const Material& material, const Coordinates& coordinates) {
  if (row.ofMaterial) return row.ofMaterial(material, coordinates);
  return std::ranges::any_of(row.textures,
                             [&](auto texture) { return texture && (material.*texture).present(); });
}

bool readsTexcoords(const TraitRow& row) { return row.texcoords || row.textures.front(); }

const TraitRow& traitOfTexture(TextureRef Material::*texture) {
  for (const TraitRow& row : traitRows()) {
    if (std::ranges::find(row.textures, texture) != row.textures.end()) return row;
  }
  throw std::logic_error("a texture of kTextureRefs is in no row of traitRows()");
}

TraitSet withNeeded(Trait trait) {
  TraitSet set;
  set.set(size_t(trait));
  for (TraitSet before; before != set;) {
    before = set;
    for (const TraitRow& row : traitRows()) {
      if (has(before, row.trait)) set |= row.needs;
    }
  }
  const TraitSet needed = set;
  for (const TraitRow& row : traitRows()) {
    if (!has(needed, row.trait)) continue;
    set |= row.brings;
    if (readsTexcoords(row)) set.set(size_t(Trait::Texcoords));
  }
  return set;
}

}  // namespace fragtrace
