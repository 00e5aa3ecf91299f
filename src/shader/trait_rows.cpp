// SPDX-License-Identifier: MIT
#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <type_traits>
#include <vector>

#include "shader/traits.h"

namespace fragtrace {
namespace {

template <typename Member>
auto setOf(std::initializer_list<Member> members) {
  std::conditional_t<std::is_same_v<Member, Stage>, StageSet, TraitSet> set;
  for (const Member member : members) set.set(size_t(member));
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

/// A row of materials and scenes that have the trait, with the stages and the other traits that it needs. Its
/// name is the constant's in words: "thin-glass" of kThinGlass.
TraitRow row(Trait trait, const char* constant, const char* absence, std::initializer_list<Stage> stages = {},
             std::initializer_list<Trait> needs = {}, bool (Material::*effect)() const = nullptr) {
  std::string name;
  for (const char c : std::string_view(constant).substr(1)) {
    const bool isUpper = c >= 'A' && c <= 'Z';
    if (isUpper && !name.empty()) name += '-';
    name += isUpper ? char(c - 'A' + 'a') : c;
  }
  return {.trait = trait,
          .name = name,
          .constant = constant,
          .absence = absence,
          .stages = setOf(stages),
          .needs = setOf(needs),
          .effect = effect};
}

TraitRow row(Trait trait, const char* constant, const char* absence, std::initializer_list<Stage> stages,
             std::initializer_list<Trait> needs, bool (*ofMaterial)(const Material&)) {
  TraitRow made = row(trait, constant, absence, stages, needs);
  made.ofMaterial = [ofMaterial](const Material& m, const Coordinates&) { return ofMaterial(m); };
  return made;
}

TraitRow named(const char* name, TraitRow row) {
  row.name = name;
  return row;
}

std::vector<TraitRow> plainRows() {  // NOLINT(readability-function-size): a table
  using enum Trait;
  return {
      row(Triangles, "kTriangles", "no triangle"), row(Spheres, "kSpheres", "no sphere"),
      named("single-sided",
            row(SingleSided, "kCulling", "no single-sided surface", {}, {}, &Material::culled)),
      row(Alpha, "kAlpha", "no alpha that lets light pass", {}, {}, &Material::testsAlpha),
      row(Texcoords, "kTexcoords", "no texture coordinates in use"),
      row(VertexNormals, "kVertexNormals", "no vertex normals", {Stage::Phong}),
      row(Tangents, "kTangents", "no tangents in use"),
      row(VertexColors, "kVertexColors", "no vertex colours"),
      row(SpecularGlossiness, "kSpecularGlossiness", "no material of KHR_materials_pbrSpecularGlossiness",
          {Stage::Phong}, {}, [](const Material& m) { return m.specularGlossiness; }),
      row(TextureTransforms, "kTextureTransforms", "no transformed texture", {}, {},
          [](const Material& m) {
            return std::ranges::any_of(kTextureRefs,
                                       [&](const TextureRefRow& t) { return (m.*t.ref).transformed(); });
          }),
      row(WideTextures, "kWideTextures", "no texture of 16 bits", {}, {Texcoords}),
      row(Clearcoat, "kClearcoat", "no clearcoat", {Stage::Gi}, {Specular}, &Material::clearcoated),
      row(Sheen, "kSheen", "no sheen", {Stage::Gi}, {}, &Material::hasSheen),
      row(Anisotropy, "kAnisotropy", "no anisotropic material", {Stage::Gi}, {Specular},
          &Material::anisotropic),
      row(Iridescence, "kIridescence", "no iridescent material", {Stage::Gi}, {Specular},
          &Material::iridescent),
      row(DiffuseTransmission, "kDiffuseTransmission", "no material that lets diffuse light through",
          {Stage::Refraction, Stage::Gi}, {}, &Material::passesDiffusely),
      row(Dispersion, "kDispersion", "no dispersive material", {Stage::Gi}, {Transmission},
          &Material::disperses),
      row(GlassSpecular, "kGlassSpecular", "no specular factor on glass", {Stage::Gi},
          {Transmission, Specular}, [](const Material& m) { return m.transmissive() && m.scalesSpecular(); }),
      TraitRow{
          .trait = PerlinNormals,
          .name = "perlin-normals",
          .constant = "kPerlinNormals",
          .absence = "no Perlin normal map",
          .stages = setOf({Stage::NormalMaps}),
          .texcoords = true,
          .ofMaterial = [](const Material& m,
                           const Coordinates& c) { return m.perlinNormal.amplitude != 0.0f && c.texcoord0; }},
      row(Specular, "kSpecular", "no surface that reflects", {Stage::Phong}, {},
          [](const Material& m) {
            return m.metallicFactor > 0.0f || dielectricReflects(m) || m.transmissive() || m.clearcoated();
          }),
      row(Metals, "kMetals", "no metal", {Stage::Phong}, {Specular},
          [](const Material& m) { return m.metallicFactor > 0.0f; }),
      row(Transmission, "kTransmission", "no transmissive material", {Stage::Refraction}, {},
          &Material::transmissive),
      row(ThinGlass, "kThinGlass", "no smooth transmissive wall without thickness",
          {Stage::Refraction, Stage::Shadows}, {Transmission},
          [](const Material& m) { return m.transmissive() && mayBeClearWall(m); }),
      row(RoughGlass, "kRoughGlass", "no rough transmissive surface", {Stage::Refraction, Stage::Gi},
          {Transmission}, [](const Material& m) { return m.transmissive() && mayBeRough(m); }),
      row(Absorption, "kAbsorption", "no absorbing volume", {Stage::Refraction}, {}, &Material::attenuates),
      row(Scattering, "kScattering", "no volume that scatters", {Stage::Refraction, Stage::Gi}, {Absorption},
          &Material::scattersInside),
      row(NestedSolids, "kNestedSolids", "no solids of different materials with boxes that overlap"),
      row(MatchedGlass, "kMatchedGlass", "no volume that scatters behind a smooth boundary of index 1",
          {Stage::Shadows}, {Scattering, Transmission}, &Material::scattersMatched),
      row(ThinScattering, "kThinScattering", "no thin wall that scatters", {Stage::Refraction, Stage::Gi},
          {Transmission, DiffuseTransmission}, &Material::scattersThinly),
      row(Fog, "kFog", "no fog", {Stage::Gi}), row(DensityGrid, "kDensityGrid", "no --volume", {Stage::Gi}),
      row(Unlit, "kUnlit", "no unlit material", {Stage::Phong}, {},
          [](const Material& m) { return m.unlit; }),
      row(Emission, "kEmission", "no emissive material", {Stage::Phong}, {}, &Material::emissive),
      row(EmissiveTriangles, "kEmissiveTriangles", "no emissive triangle", {Stage::Phong}),
      row(PunctualLights, "kPunctualLights", "no punctual light", {Stage::Phong}),
      row(LightTree, "kLightTree", "no lights far apart", {Stage::Gi}),
      row(Caustics, "kCaustics", "no lamp or sun, or no glass or metal that is smooth enough for it",
          {Stage::Gi, Stage::Shadows}, {Specular}),
      row(Environment, "kEnvironment", "no environment"),
      row(EnvironmentSampling, "kEnvironmentSampling", "no environment map", {Stage::Gi}),
      row(Backdrop, "kBackdrop", "no backdrop but the environment itself", {}, {Environment}),
      row(Sun, "kSun", "no sky with a sun", {}, {Environment}),
      row(MapSun, "kMapSun", "no map with a sun, or nothing that casts its caustics", {},
          {Caustics, EnvironmentSampling}),
      row(Instances, "kInstances", "no shared mesh"),
      row(Creases, "kCreases", "no crease below 133 degrees, or no ray that leaves one"),
      row(Coincident, "kCoincident", "no lamp in another surface, and no faces back to back"),
      row(Slivers, "kSlivers", "no triangle long and thin enough to need its plane"),
      // As hit() of shaders/integrators/guide.glsl follows, and more than half of the light.
      row(SmoothSurfaces, "kSmoothSurfaces", "no clear glass and no mirror, or no filter to see through them",
          {}, {},
          [](const Material& m) {
            return m.roughnessFactor < 0.1f && (m.transmissive() || m.metallicFactor > 0.5f);
          }),
      row(ObjectNumbers, "kObjectNumbers", "no layer of objects"),
      row(MovingCamera, "kMovingCamera", "no camera that moves while the shutter is open"),
      named("moving-surfaces",
            row(MovingSurfaces, "kMoving", "no surface that moves while the shutter is open"))};
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
