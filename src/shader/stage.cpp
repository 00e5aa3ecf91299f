// SPDX-License-Identifier: MIT
#include "shader/stage.h"

#include <array>

#include "shader/traits.h"

namespace fragtrace {

std::span<const StageRow> stageRows() {
  static constexpr std::array<StageRow, size_t(Stage::Count)> rows = {{
      {Stage::Flat, "flat", "Flat", "unlit colour or texture where the ray hits", true, false, nullptr},
      {Stage::Phong, "phong", "Blinn-Phong", "Lambert and Blinn-Phong under every light", true, false,
       nullptr},
      {Stage::Shadows, "shadows", "Shadows", "shadow rays towards each light", true, false, "kShadows"},
      {Stage::Reflections, "reflections", "Reflections", "mirror reflections, and specular lobes in gi", true,
       false, "kReflections", Trait::Specular},
      {Stage::Refraction, "refraction", "Refraction", "refraction with dielectric Fresnel and absorption",
       true, false, "kRefraction", Trait::Transmission},
      {Stage::NormalMaps, "normal-maps", "Normal maps", "normal textures and Perlin normal maps", true, false,
       "kNormalMaps"},
      {Stage::Gi, "gi", "Global illumination", "path tracing with the glTF material", true, false, "kGi"},
      {Stage::Schlick, "schlick", "Schlick's Fresnel",
       "Schlick's approximation for glass, instead of the exact Fresnel", false, false, "kSchlick",
       Trait::Transmission},
      {Stage::EnergyCompensation, "energy-compensation", "Energy compensation",
       "gives back what rough surfaces lose to single scattering in gi (on by default)", false, true,
       "kCompensation", Trait::Specular},
      {Stage::Sobol,
       "sobol",
       "Sobol samples",
       "Owen-scrambled Sobol points instead of independent random numbers (on by default)",
       false,
       true,
       "kSobol",
       {},
       Effect::Noise},
      {Stage::LightSampling,
       "light-sampling",
       "Light sampling",
       "samples emissive triangles and the environment in gi, which else scattered rays alone find (on by "
       "default)",
       false,
       true,
       nullptr,
       {},
       Effect::Noise},
      {Stage::Watertight, "watertight", "Watertight triangles",
       "triangle test of the trees that lets no ray through between neighbours, and points moved out of "
       "sharp creases, instead of a faster test "
       "(on by default)",
       false, true, "kWatertight", Trait::Triangles, Effect::Method},
  }};
  return rows;
}

std::optional<Stage> parseStage(std::string_view name) {
  for (const StageRow& row : stageRows()) {
    if (name == row.name) return row.stage;
  }
  return std::nullopt;
}

StageSet withStagesUpTo(StageSet set, Stage stage) {
  for (const StageRow& row : stageRows()) {
    if (row.cumulative) set.set(size_t(row.stage), row.stage <= stage);
  }
  return set;
}

StageSet stagesUpTo(Stage stage) {
  StageSet set;
  for (const StageRow& row : stageRows()) {
    if ((row.cumulative && row.stage <= stage) || row.standard) set.set(size_t(row.stage));
  }
  return set;
}

}  // namespace fragtrace
