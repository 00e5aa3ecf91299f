// SPDX-License-Identifier: MIT
#include "stage/stage.h"

#include <array>

namespace fragtrace {

std::span<const TraitRow> traitRows() {
  static constexpr std::array<TraitRow, size_t(Trait::Count)> rows = {{
      {Trait::Triangles, "triangles", "kTriangles", "no triangle"},
      {Trait::Spheres, "spheres", "kSpheres", "no sphere"},
      {Trait::SingleSided, "single-sided", "kCulling", "no single-sided surface"},
      {Trait::Alpha, "alpha", "kAlpha", "no alpha MASK or BLEND"},
      {Trait::Texcoords, "texcoords", "kTexcoords", "no texture coordinates in use"},
      {Trait::VertexNormals, "vertex-normals", "kVertexNormals", "no vertex normals"},
      {Trait::Tangents, "tangents", "kTangents", "no tangents in use"},
      {Trait::VertexColors, "vertex-colors", "kVertexColors", "no vertex colours"},
      {Trait::BaseColorTexture, "base-color-texture", "kBaseColorTexture", "no base colour texture"},
      {Trait::MetallicRoughnessTexture, "metallic-roughness-texture", "kMetallicRoughnessTexture",
       "no metallic-roughness texture"},
      {Trait::NormalTexture, "normal-texture", "kNormalTexture", "no normal texture"},
      {Trait::EmissionTexture, "emission-texture", "kEmissionTexture", "no emissive texture"},
      {Trait::TransmissionTexture, "transmission-texture", "kTransmissionTexture", "no transmission texture"},
      {Trait::SpecularTexture, "specular-texture", "kSpecularTexture", "no specular texture"},
      {Trait::SpecularGlossiness, "specular-glossiness", "kSpecularGlossiness",
       "no material of KHR_materials_pbrSpecularGlossiness"},
      {Trait::TextureTransforms, "texture-transforms", "kTextureTransforms", "no transformed texture"},
      {Trait::Clearcoat, "clearcoat", "kClearcoat", "no clearcoat"},
      {Trait::ClearcoatTexture, "clearcoat-texture", "kClearcoatTexture", "no clearcoat texture"},
      {Trait::ClearcoatNormal, "clearcoat-normal", "kClearcoatNormal", "no clearcoat normal texture"},
      {Trait::Sheen, "sheen", "kSheen", "no sheen"},
      {Trait::SheenTexture, "sheen-texture", "kSheenTexture", "no sheen texture"},
      {Trait::Anisotropy, "anisotropy", "kAnisotropy", "no anisotropic material"},
      {Trait::AnisotropyTexture, "anisotropy-texture", "kAnisotropyTexture", "no anisotropy texture"},
      {Trait::Iridescence, "iridescence", "kIridescence", "no iridescent material"},
      {Trait::IridescenceTexture, "iridescence-texture", "kIridescenceTexture", "no iridescence texture"},
      {Trait::DiffuseTransmission, "diffuse-transmission", "kDiffuseTransmission",
       "no material that lets diffuse light through"},
      {Trait::DiffuseTransmissionTexture, "diffuse-transmission-texture", "kDiffuseTransmissionTexture",
       "no diffuse transmission texture"},
      {Trait::Dispersion, "dispersion", "kDispersion", "no dispersive material"},
      {Trait::GlassSpecular, "glass-specular", "kGlassSpecular", "no specular factor on glass"},
      {Trait::PerlinNormals, "perlin-normals", "kPerlinNormals", "no Perlin normal map"},
      {Trait::Specular, "specular", "kSpecular", "no surface that reflects"},
      {Trait::Metals, "metals", "kMetals", "no metal"},
      {Trait::Transmission, "transmission", "kTransmission", "no transmissive material"},
      {Trait::Absorption, "absorption", "kAbsorption", "no absorbing volume"},
      {Trait::Unlit, "unlit", "kUnlit", "no unlit material"},
      {Trait::Emission, "emission", "kEmission", "no emissive material"},
      {Trait::EmissiveTriangles, "emissive-triangles", "kEmissiveTriangles", "no emissive triangle"},
      {Trait::PunctualLights, "punctual-lights", "kPunctualLights", "no punctual light"},
      {Trait::Environment, "environment", "kEnvironment", "no environment"},
      {Trait::EnvironmentSampling, "environment-sampling", "kEnvironmentSampling", "no environment map"},
      {Trait::Instances, "instances", "kInstances", "no mesh that is shared"},
      {Trait::Creases, "creases", "kCreases", "no crease below 101 degrees, or no ray that leaves one"},
      {Trait::Slivers, "slivers", "kSlivers", "no triangle long and thin enough to need its plane"},
      {Trait::SmoothSurfaces, "smooth-surfaces", "kSmoothSurfaces",
       "no clear glass and no mirror, or no filter to see through them"},
  }};
  return rows;
}

std::span<const StageRow> stageRows() {
  static constexpr std::array<StageRow, size_t(Stage::Count)> rows = {{
      {Stage::Flat, "flat", "Flat", "unlit colour or texture where the ray hits", true, false, nullptr},
      {Stage::Phong, "phong", "Blinn-Phong", "Lambert and Blinn-Phong under every light", true, false,
       "kPhong"},
      {Stage::Shadows, "shadows", "Shadows", "shadow rays towards each light", true, false, "kShadows"},
      {Stage::Reflections, "reflections", "Reflections", "mirror reflections, and specular lobes in gi", true,
       false, "kReflections"},
      {Stage::Refraction, "refraction", "Refraction", "refraction with dielectric Fresnel and absorption",
       true, false, "kRefraction"},
      {Stage::NormalMaps, "normal-maps", "Normal maps", "normal textures and Perlin normal maps", true, false,
       "kNormalMaps"},
      {Stage::Gi, "gi", "Global illumination", "path tracing with the glTF material", true, false, "kGi"},
      {Stage::Schlick, "schlick", "Schlick's Fresnel",
       "Schlick's approximation for glass, in place of the exact Fresnel", false, false, "kSchlick"},
      {Stage::EnergyCompensation, "energy-compensation", "Energy compensation",
       "gives back what rough surfaces lose to single scattering in gi (on by default)", false, true,
       "kCompensation"},
      {Stage::Sobol, "sobol", "Sobol samples",
       "Owen-scrambled Sobol points in place of independent random numbers (on by default)", false, true,
       "kSobol"},
      {Stage::LightSampling, "light-sampling", "Light sampling",
       "samples emissive triangles and the environment in gi, which else scattered rays alone find (on by "
       "default)",
       false, true, nullptr},
      {Stage::Watertight, "watertight", "Watertight triangles",
       "triangle test of the trees that lets no ray through between neighbours, and points moved out of "
       "sharp creases, in place of a faster test "
       "(on by default)",
       false, true, "kWatertight"},
      {Stage::BvhHeatmap, "bvh-heatmap", "Node heat map", "paints how many nodes each camera ray visits",
       false, false, "kHeatmap"},
  }};
  return rows;
}

std::optional<Stage> parseStage(std::string_view name) {
  for (const StageRow& row : stageRows()) {
    if (name == row.name) return row.stage;
  }
  return std::nullopt;
}

StageSet stagesUpTo(Stage stage) {
  StageSet set;
  for (const StageRow& row : stageRows()) {
    if ((row.cumulative && row.stage <= stage) || row.standard) set.set(size_t(row.stage));
  }
  return set;
}

}  // namespace fragtrace
