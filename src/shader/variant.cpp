// SPDX-License-Identifier: MIT
#include "shader/variant.h"

#include <algorithm>

#include "bvh/bvh.h"
#include "scene/casters.h"
#include "scene/hit_error.h"
#include "scene/light_bounds.h"

namespace fragtrace {

namespace {

constexpr Trait kBaseColorTexture = slotTrait(layout::kSlotBaseColor);
constexpr Trait kRoughnessTexture = slotTrait(layout::kSlotMetallicRoughness);
constexpr Trait kSpecularColorTexture = slotTrait(layout::kSlotSpecularColor);

bool hasNormalMaps(const TraitSet& traits) {
  return has(traits, slotTrait(layout::kSlotNormal)) || has(traits, Trait::PerlinNormals) ||
         has(traits, slotTrait(layout::kSlotClearcoatNormal));
}

/// A light that rays can hit, and that can be sampled.
bool hasAreaLight(const TraitSet& traits) {
  return has(traits, Trait::EmissiveTriangles) || has(traits, Trait::EnvironmentSampling);
}

bool hasLight(const TraitSet& traits) { return has(traits, Trait::PunctualLights) || hasAreaLight(traits); }

bool hasSlivers(const Scene& scene) {
  return std::ranges::any_of(scene.triangles,
                             [&](const Triangle& t) { return isSliver(cornersOf(scene, t)); });
}

void addMaterialTraits(const Material& m, const Coordinates& coordinates, TraitSet& traits) {
  for (const TraitRow& row : traitRows()) {
    if (row.ofMaterial && row.ofMaterial(m, coordinates)) traits.set(size_t(row.trait));
  }
}

void drop(TraitSet& traits, std::initializer_list<Trait> members) {
  for (const Trait t : members) traits.reset(size_t(t));
}

void dropLightPaths(TraitSet& traits) { drop(traits, {Trait::Caustics, Trait::MapSun}); }

/// A stage that is off by itself, or by what was asked for, turns others off.
void dropStages(StageSet& stages, bool countsVisits) {
  // gi does its own shading. Without gi and phong, no stage beyond flat changes anything.
  stages.set(size_t(Stage::Flat));
  if (has(stages, Stage::Gi)) stages.set(size_t(Stage::Phong));
  if (countsVisits) stages &= StageSet(1ul << unsigned(Stage::Flat) | 1ul << unsigned(Stage::Watertight));
  if (has(stages, Stage::Phong)) return;
  for (Stage s : {Stage::Shadows, Stage::Reflections, Stage::Refraction, Stage::NormalMaps, Stage::Gi,
                  Stage::Schlick, Stage::EnergyCompensation}) {
    stages.reset(size_t(s));
  }
}

/// Traits that no stage left on asks for, or that lack what they need.
void dropTraits(const StageSet& stages, bool countsVisits, Surroundings surroundings, TraitSet& traits) {
  const bool gi = has(stages, Stage::Gi);
  if (!has(stages, Stage::Phong) && surroundings != Surroundings::Map) drop(traits, {Trait::Environment});
  if (countsVisits) drop(traits, {Trait::Alpha, kBaseColorTexture, Trait::VertexColors, Trait::Environment});
  if (gi && !has(stages, Stage::Reflections)) drop(traits, {Trait::Specular});
  for (TraitSet before; before != traits;) {
    before = traits;
    for (const TraitRow& row : traitRows()) {
      if ((row.stages & ~stages).any() || (row.needs & ~traits).any()) drop(traits, {row.trait});
    }
  }
  // In specular-glossiness the diffuse colour gives way to the specular one, reflected or not.
  if (!has(traits, Trait::Specular)) {
    drop(traits, {kRoughnessTexture});
    if (!has(traits, Trait::SpecularGlossiness))
      drop(traits, {slotTrait(layout::kSlotSpecular), kSpecularColorTexture});
  }
  if (!has(traits, Trait::Transmission) && !has(traits, Trait::DiffuseTransmission))
    drop(traits, {Trait::Absorption, Trait::Scattering, Trait::NestedSolids, Trait::MatchedGlass});
  if (!hasNormalMaps(traits) && !has(traits, Trait::Anisotropy)) drop(traits, {Trait::Tangents});
  if (gi && !has(stages, Stage::LightSampling))
    drop(traits, {Trait::EmissiveTriangles, Trait::EnvironmentSampling, Trait::MapSun});
  // Scattered rays find a constant environment.
  if (gi && surroundings == Surroundings::DefaultLight) drop(traits, {Trait::EnvironmentSampling});
  const auto looksUp = [&](const TraitRow& row) { return row.texcoords && has(traits, row.trait); };
  if (std::ranges::none_of(traitRows(), looksUp))
    drop(traits, {Trait::Texcoords, Trait::TextureTransforms, Trait::WideTextures});
  drop(traits, {Trait::SmoothSurfaces, Trait::ObjectNumbers});  // only layers read these
}

/// Stages that change nothing in a scene of these traits, and traits that stages alone ask for.
void dropIdle(ShaderVariant& v) {
  const auto stage = [&](Stage s) { return has(v.stages, s); };
  const auto off = [&](Stage s) { v.stages.reset(size_t(s)); };
  if (!stage(Stage::Gi) || !hasAreaLight(v.traits)) off(Stage::LightSampling);
  if (!hasLight(v.traits)) off(Stage::Shadows);
  if (!has(v.traits, Trait::Specular)) off(Stage::Reflections);
  if (!stage(Stage::Gi) || !stage(Stage::Reflections)) off(Stage::EnergyCompensation);
  if (!has(v.traits, Trait::Transmission)) {
    off(Stage::Refraction);
    off(Stage::Schlick);
  }
  // Without shadow rays, no light is found through thin glass.
  if (!stage(Stage::Shadows)) drop(v.traits, {Trait::ThinGlass});
  if (!hasLamps(v.traits)) drop(v.traits, {Trait::LightTree});
  // Light paths begin at lamps and suns. They do not know of media, nor of time.
  const bool begin = hasLamps(v.traits) || samplesSun(v.traits);
  if (!begin || hasMedia(v.traits) || isTimed(v.traits)) dropLightPaths(v.traits);
  if (!hasNormalMaps(v.traits)) off(Stage::NormalMaps);
  if (!has(v.traits, Trait::Triangles)) off(Stage::Watertight);
  const bool leavesSurfaces = stage(Stage::Gi) || stage(Stage::Shadows) || stage(Stage::Reflections) ||
                              stage(Stage::Refraction) || has(v.traits, Trait::Alpha);
  if (!leavesSurfaces || !stage(Stage::Watertight)) drop(v.traits, {Trait::Creases});
  if (!stage(Stage::Watertight)) drop(v.traits, {Trait::Slivers});
}

/// A catcher, alpha of glass and the neighbours' light samples know one camera ray per sample, and media may
/// scatter before any surface.
int cameraRaysOf(const ShaderVariant& v, int wanted) {
  const bool one = !has(v.stages, Stage::Gi) || v.countsVisits || v.shadowCatcher || v.transparentGlass ||
                   v.lightCandidates || v.neighbours || hasMedia(v.traits);
  return one || wanted == 0 ? 1 : wanted;
}

/// Returns true if ray cones choose the levels of textures.
bool followsCones(const RenderOptions& options, const TraitSet& traits) {
  return options.sampling.textureFilter == TextureFilter::Cones && readsTextures(traits);
}

/// Returns true if a lamp lies in the box of solids that absorb. A light path does not know which solids its
/// lamp stands in until it leaves one, and where solids are nested it may meet another one before.
bool lampsMayBeInside(const Scene& scene) {
  const auto isInside = [&](const Bounds& lamp) {
    for (size_t i = 0; i < scene.solids.boxes.size(); ++i)
      if (scene.materials[i].attenuates() && scene.solids.boxes[i].overlaps(lamp)) return true;
    return false;
  };
  const auto emitsInside = [&](const Triangle& t) {
    if (!scene.materials[t.material].emissive()) return false;
    Bounds box;
    for (const glm::vec3& corner : cornersOf(scene, t)) box.include(corner);
    return isInside(box);
  };
  const auto shinesInside = [&](const Light& light) {
    return light.type != LightType::Directional && isInside({light.position, light.position});
  };
  return std::ranges::any_of(scene.lights, shinesInside) || std::ranges::any_of(scene.triangles, emitsInside);
}

}  // namespace

bool hasOwnLight(const Scene& scene) {
  if (!scene.lights.empty()) return true;
  const auto emits = [&](const auto& primitive) { return scene.materials[primitive.material].emissive(); };
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), emits) ||
         std::any_of(scene.spheres.begin(), scene.spheres.end(), emits);
}

TraitSet traitsOf(const Scene& scene, Surroundings surroundings, bool backdrop, SunLight sun) {
  TraitSet traits;
  std::vector<bool> onTriangles(scene.materials.size(), false);
  std::vector<bool> onSpheres(scene.materials.size(), false);
  bool emissiveTriangles = false;
  bool smooth = false;
  for (const Triangle& t : scene.triangles) {
    onTriangles[t.material] = true;
    emissiveTriangles = emissiveTriangles || scene.materials[t.material].emissive();
    smooth = smooth || !t.flat;
  }
  const Coordinates ofVertices{.texcoord0 = !scene.vertices.texcoord0.empty(),
                               .tangents = !scene.vertices.tangent.empty()};
  for (const Sphere& s : scene.spheres) onSpheres[s.material] = true;
  const std::vector<Caster> casters = castersOf(scene);
  bool anyCaster = false;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    anyCaster = anyCaster || ((onTriangles[i] || onSpheres[i]) && casters[i] != Caster::None);
    if (onTriangles[i]) addMaterialTraits(scene.materials[i], ofVertices, traits);
    if (onSpheres[i]) addMaterialTraits(scene.materials[i], Coordinates{}, traits);
  }
  auto mark = [&](Trait trait, bool present) { traits.set(size_t(trait), present); };
  mark(Trait::Triangles, !scene.triangles.empty());
  mark(Trait::Spheres, !scene.spheres.empty());
  mark(Trait::VertexNormals, smooth && !scene.vertices.normal.empty());
  mark(Trait::Tangents, ofVertices.tangents);
  mark(Trait::VertexColors, !scene.vertices.color.empty());
  mark(Trait::Texcoords, !scene.vertices.texcoord0.empty() || !scene.vertices.texcoord1.empty());
  mark(Trait::EmissiveTriangles, emissiveTriangles);
  mark(Trait::PunctualLights, !scene.lights.empty());
  // A scene without a noticeable light of its own gets the default light.
  const bool lamps =
      surroundings != Surroundings::DefaultLight && (emissiveTriangles || !scene.lights.empty());
  mark(Trait::LightTree, lamps && gainByPlace(scene) >= kLeastGainByPlace);
  const bool begins = lamps || sun == SunLight::Shines || sun == SunLight::InMap;
  mark(Trait::Caustics, begins && anyCaster && !(scene.solids.nested && lampsMayBeInside(scene)));
  mark(Trait::Environment, surroundings != Surroundings::None);
  mark(Trait::EnvironmentSampling, surroundings != Surroundings::None);
  mark(Trait::Backdrop, backdrop);
  mark(Trait::Sun, sun == SunLight::Set || sun == SunLight::Shines);
  mark(Trait::MapSun, sun == SunLight::InMap && anyCaster);
  mark(Trait::NestedSolids, scene.solids.nested);
  mark(Trait::Instances, !scene.instances.empty());
  mark(Trait::Creases, !scene.insets.empty());
  mark(Trait::Slivers, hasSlivers(scene));
  mark(Trait::Coincident,
       std::ranges::any_of(scene.triangles, [](const Triangle& t) { return t.reach > 0; }));
  mark(Trait::WideTextures,
       std::ranges::any_of(scene.images, [](const EncodedImage& image) { return image.texelBits > 8; }));
  mark(Trait::DensityGrid, scene.volume.grid != nullptr);
  mark(Trait::MovingCamera, scene.motion.camera);
  mark(Trait::MovingSurfaces, scene.motion.segments > 0);
  return traits;
}

std::string whyOff(Stage stage, const TraitSet& present, bool gi) {
  if (stage == Stage::NormalMaps && !hasNormalMaps(present)) return "no normal map";
  if (stage == Stage::Shadows && !hasLight(present)) return "no light to cast shadows";
  if (stage == Stage::Shadows && !gi && !hasLamps(present))
    return "before gi, the environment casts no shadows";
  if (stage == Stage::LightSampling && !hasAreaLight(present))
    return "no emissive triangle and no environment";
  const std::optional<Trait> needed = stageRows()[size_t(stage)].needs;
  if (!needed || has(present, *needed)) return {};
  return traitRows()[size_t(*needed)].absence;
}

std::string whyNoLightPaths(const RenderOptions& options, const TraitSet& present) {
  // Limits, catchers and parts know paths from the camera alone.
  if (options.sampling.clampIndirect > 0.0) return "--clamp-indirect";
  if (options.light.shadowCatcher) return "--shadow-catcher";
  // A filter does not reach across the seam of a panorama.
  if (options.camera.overrides.type == CameraType::Panorama && options.camera.pixelFilter != PixelFilter::Box)
    return "--pixel-filter of a panorama";
  if (std::ranges::any_of(options.output.aovs, isLightPart)) return "--aov has parts of the light";
  if (options.camera.shutter > 0.0) return "--shutter";
  if (hasMedia(present) || options.fog.density > 0.0) return "fog, grids and solids that scatter";
  return {};
}

ShaderVariant chooseVariant(const RenderOptions& options, const TraitSet& present, Surroundings surroundings,
                            uint32_t stackNeed, BufferReads reads) {
  ShaderVariant v;
  v.stages = options.stages;
  v.traits = present;
  v.reads = reads;
  if (options.light.selection != LightSelection::Auto)
    v.traits.set(size_t(Trait::LightTree), options.light.selection != LightSelection::Power);
  v.traits.set(size_t(Trait::Fog), options.fog.density > 0.0 && !options.light.shadowCatcher);
  if (options.light.shadowCatcher) v.traits.reset(size_t(Trait::DensityGrid));
  if (options.light.caustics == Caustics::Off || !whyNoLightPaths(options, present).empty())
    v.traits.reset(size_t(Trait::Caustics));
  v.countsWork = options.output.countWork;
  v.countsVisits = options.output.debugView == DebugView::Visits;
  dropStages(v.stages, v.countsVisits);
  dropTraits(v.stages, v.countsVisits, surroundings, v.traits);
  dropIdle(v);

  // Step: choose how rays find triangles. Literals need the packed scene, and useLiterals of
  // src/session/tracer.cpp adds them.
  const bool named = options.device.traversal != TraversalMethod::Auto &&
                     options.device.traversal != TraversalMethod::Literals;
  v.traversal = named ? options.device.traversal : TraversalMethod::FrontToBack;
  if (v.traversal == TraversalMethod::Iterative) drop(v.traits, {Trait::Instances});
  v.stackSize = stackNeed <= kMaxBvhDepth ? int(kMaxBvhDepth) : int(kMaxTwoLevelDepth);
  for (int size : {24, 20, 16, 12, 8, 4}) {
    if (stackNeed <= uint32_t(size)) v.stackSize = size;
  }
  if (v.traversal == TraversalMethod::Iterative) v.stackSize = 4;

  v.uniformLights = has(v.traits, Trait::LightTree) && options.light.selection == LightSelection::Uniform;
  const bool drawsLight = has(v.stages, Stage::Gi) && hasLight(v.traits);
  v.lightCandidates = drawsLight && options.light.reuse == LightReuse::Candidates;
  v.neighbours = drawsLight && options.light.reuse == LightReuse::Spatial;
  v.pixelFilter = options.camera.pixelFilter;
  v.lens = options.camera.lens.fStop.has_value();
  v.lensShift = options.camera.overrides.lensShift.value_or(glm::dvec2(0.0)) != glm::dvec2(0.0);
  const CameraType type = options.camera.overrides.type.value_or(CameraType::Perspective);
  if (!isRectilinear(type)) v.camera = type;
  v.clampIndirect = has(v.stages, Stage::Gi) && options.sampling.clampIndirect > 0.0;
  v.shadowCatcher = has(v.stages, Stage::Gi) && options.light.shadowCatcher;
  const bool hasPage = !options.light.background || options.light.backgroundColor;
  v.transparentGlass = has(v.stages, Stage::Gi) && options.light.transparentGlass && hasPage &&
                       has(v.traits, Trait::Transmission) && !v.countsVisits;
  v.cameraRays = cameraRaysOf(v, options.sampling.cameraRays);
  v.rayCones = followsCones(options, v.traits);
  return v;
}

namespace {

/// Takes out the stages that a layer does without: what is left has the same samples, and the same hits.
void dropStagesOfLayer(bool normals, bool follows, StageSet& stages) {
  for (const StageRow& row : stageRows()) {
    const bool kept = row.stage == Stage::Sobol || row.stage == Stage::Watertight ||
                      (normals && row.stage == Stage::NormalMaps) ||
                      (follows && (row.stage == Stage::Reflections || row.stage == Stage::Refraction ||
                                   row.stage == Stage::Schlick));
    if (!kept) stages.reset(size_t(row.stage));
  }
}

}  // namespace

ShaderVariant chooseAovVariant(const RenderOptions& options, const TraitSet& present,
                               Surroundings surroundings, uint32_t stackNeed, BufferReads reads, Aov aov) {
  RenderOptions wanted = options;
  wanted.output.debugView = DebugView::None;
  if (isLightPart(aov)) {
    ShaderVariant light = chooseVariant(wanted, present, surroundings, stackNeed, reads);
    light.aov = aov;
    dropLightPaths(light.traits);
    light.neighbours = false;
    return light;
  }
  const bool guides = aov == Aov::Guides;
  const bool normals = aov == Aov::Normal || guides;
  const bool follows = guides && has(present, Trait::SmoothSurfaces);
  dropStagesOfLayer(normals, follows, wanted.stages);
  if (normals) wanted.stages.set(size_t(Stage::Phong));
  TraitSet kept = present;
  for (Trait t :
       {Trait::PunctualLights, Trait::EmissiveTriangles, Trait::EnvironmentSampling, Trait::Environment,
        Trait::Emission, Trait::Absorption, Trait::Unlit, Trait::Fog, Trait::DensityGrid}) {
    kept.reset(size_t(t));
  }
  if (!follows) {
    for (Trait t : {Trait::Specular, Trait::Transmission}) kept.reset(size_t(t));
  }
  if (aov != Aov::Albedo && !guides && !has(present, Trait::Alpha)) {
    for (Trait t : {kBaseColorTexture, Trait::VertexColors}) kept.reset(size_t(t));
  }
  ShaderVariant v = chooseVariant(wanted, kept, surroundings, stackNeed, reads);
  v.traits.reset(size_t(Trait::Environment));
  const auto keep = [&](Trait t) {
    if (has(present, t)) v.traits.set(size_t(t));
  };
  const bool glossiness = has(present, Trait::SpecularGlossiness);
  const bool roughnessTexture =
      aov == Aov::Roughness &&
      (has(present, kRoughnessTexture) || (glossiness && has(present, kSpecularColorTexture)));
  if (aov == Aov::Roughness) {
    keep(kRoughnessTexture);
    keep(Trait::SpecularGlossiness);
    if (glossiness) keep(kSpecularColorTexture);
  }
  if (roughnessTexture) {
    keep(Trait::TextureTransforms);
    keep(Trait::WideTextures);
  }
  if (roughnessTexture || aov == Aov::Texcoords) keep(Trait::Texcoords);
  if (follows) keep(Trait::SmoothSurfaces);
  if (follows) keep(Trait::Scattering);
  if (aov == Aov::Object || aov == Aov::CryptoObject) v.traits.set(size_t(Trait::ObjectNumbers));
  const bool paths = guides && has(options.stages, Stage::Gi);
  v.shadowCatcher = paths && options.light.shadowCatcher;
  v.traits.set(size_t(Trait::Fog), paths && options.fog.density > 0.0 && !options.light.shadowCatcher);
  v.traits.set(size_t(Trait::DensityGrid), paths && has(present, Trait::DensityGrid) && !v.shadowCatcher);
  v.aov = aov;
  v.rayCones = followsCones(options, v.traits);
  v.cameraRays = 1;
  return v;
}

ShaderVariant choosePictureVariant(const RenderOptions& options, const TraitSet& present,
                                   Surroundings surroundings, uint32_t stackNeed, BufferReads reads) {
  const Aov aov = rowOf(options.output.debugView).aov;
  if (aov != Aov::None) return chooseAovVariant(options, present, surroundings, stackNeed, reads, aov);
  return chooseVariant(options, present, surroundings, stackNeed, reads);
}

std::optional<ShaderVariant> lightPathVariant(const ShaderVariant& variant) {
  if (!has(variant.traits, Trait::Caustics)) return std::nullopt;
  ShaderVariant light = variant;
  light.lightPaths = true;
  light.rayCones = false;
  light.transparentGlass = false;
  light.cameraRays = 1;
  light.neighbours = false;
  light.wavefront = false;
  light.waveUnit = -1;
  return light;
}

bool usesGuiding(const ShaderVariant& variant) {
  return has(variant.traits, Trait::Caustics) && !variant.lightPaths;
}

std::optional<ShaderVariant> reservoirVariant(const ShaderVariant& variant) {
  if (!variant.neighbours) return std::nullopt;
  ShaderVariant records = variant;
  records.neighbours = false;
  records.storesReservoirs = true;
  dropLightPaths(records.traits);
  records.wavefront = false;
  records.waveUnit = -1;
  return records;
}

bool lightsByEnvironment(const ShaderVariant& variant) {
  return has(variant.traits, Trait::Environment) && has(variant.stages, Stage::Phong) &&
         !has(variant.stages, Stage::Gi);
}

bool keepsWeights(const ShaderVariant& variant) {
  const TraitSet& traits = variant.traits;
  return has(traits, Trait::VertexNormals) || has(traits, Trait::Texcoords) || has(traits, Trait::Tangents) ||
         has(traits, Trait::VertexColors) || has(traits, Trait::Creases) ||
         has(traits, Trait::MovingSurfaces);
}

bool passesSurfaces(const ShaderVariant& variant) {
  return (has(variant.traits, Trait::Alpha) && !testsAlpha(variant)) ||
         has(variant.traits, Trait::ThinGlass) || has(variant.traits, Trait::MatchedGlass) ||
         (variant.shadowCatcher && has(variant.traits, Trait::Transmission));
}

bool testsAlpha(const ShaderVariant& variant) {
  return has(variant.traits, Trait::Alpha) && variant.aov != Aov::Guides;
}

std::string variantName(const ShaderVariant& variant) {
  std::string name;
  auto append = [&](const std::string& part) { name += (name.empty() ? "" : "+") + part; };
  for (const StageRow& row : stageRows()) {
    if (has(variant.stages, row.stage)) append(row.name);
  }
  for (const TraitRow& row : traitRows()) {
    if (has(variant.traits, row.trait)) append(row.name);
  }
  append(std::string(kTraversalNames[size_t(variant.traversal)]));
  if (variant.traversal == TraversalMethod::Bvh || variant.traversal == TraversalMethod::FrontToBack)
    append("stack-" + std::to_string(variant.stackSize));
  if (variant.traversal != TraversalMethod::Literals && !variant.literals.empty()) append("large-first");
  if (variant.pixelFilter != PixelFilter::Box)
    append(std::string(kPixelFilterNames[size_t(variant.pixelFilter)]) + "-filter");
  if (variant.aov != Aov::None) append(std::string(rowOf(variant.aov).name));
  if (variant.cameraRays > 1) append(std::to_string(variant.cameraRays) + "-camera-rays");
  if (variant.countsVisits) append(std::string(rowOf(DebugView::Visits).name));
  if (variant.countsWork) append("count-work");
  if (variant.uniformLights) append("uniform-lights");
  if (variant.lightCandidates) append("light-candidates");
  if (variant.storesReservoirs) append("reservoirs");
  if (variant.neighbours) append("neighbours");
  if (variant.clampIndirect) append("clamp-indirect");
  if (variant.shadowCatcher) append("shadow-catcher");
  if (variant.transparentGlass) append("transparent-glass");
  if (variant.lens) append("lens");
  if (variant.lensShift) append("lens-shift");
  if (variant.camera != CameraType::Perspective) append(kCameraTypeNames[size_t(variant.camera)].data());
  if (variant.lightPaths) append("light-paths");
  if (variant.rayCones) append("ray-cones");
  append(std::string(kBufferReadsNames[size_t(variant.reads)]) + "-reads");
  append(std::string(kDispatchNames[size_t(variant.dispatch)]));
  if (variant.gpu) append("gpu");
  if (variant.wavefront) append("wavefront");
  return name;
}

}  // namespace fragtrace
