// SPDX-License-Identifier: MIT
#include "pack/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "base/vectors.h"
#include "base/words.h"
#include "pack/energy_tables.h"
#include "pack/guiding.h"
#include "pack/pack_environment.h"
#include "pack/pack_lights.h"
#include "pack/pack_tree.h"
#include "pack/textures/pack_textures.h"
#include "scene/casters.h"

namespace fragtrace {

namespace {

static_assert(layout::kBrickTexels * 4 == kBrickVoxels);

/// Largest values of a brick: of all voxels, and of those at its lower sides. Bit 0 of the index means X = 0,
/// bit 1 Y = 0, bit 2 Z = 0. Half floats that are not negative have the order of their bits.
using Largest = std::array<uint16_t, 8>;

Largest largestOf(const uint16_t* values) {
  Largest largest{};
  for (int i = 0; i < int(kBrickVoxels); ++i) {
    const uint32_t sides =
        uint32_t((i & 7) == 0) | uint32_t(((i >> 3) & 7) == 0) << 1 | uint32_t((i >> 6) == 0) << 2;
    for (uint32_t s = 0; s < 8; ++s) {
      if ((s & ~sides) == 0) largest[s] = std::max(largest[s], values[i]);
    }
  }
  return largest;
}

void appendHalves(Words& texels, const uint16_t* halves, size_t count) {
  for (size_t i = 0; i < count; i += 2) texels.push_back(uint32_t(halves[i]) | uint32_t(halves[i + 1]) << 16);
}

/// The table has an entry for the bricks before the first along each axis, too.
size_t tableTexelsOf(const VolumeGrid& grid) {
  const glm::ivec3 bricks = grid.bricks + 1;
  return size_t(bricks.x) * size_t(bricks.y) * size_t(bricks.z);
}

size_t texelsPerBrick(const VolumeGrid& grid) {
  return size_t(layout::kBrickTexels) + (grid.radiance.empty() ? 0 : kBrickVoxels);
}

constexpr std::array kGeometryBindings{
    layout::kNodesBinding,     layout::kLeavesBinding,   layout::kFacesBinding, layout::kNormalsBinding,
    layout::kTexcoordsBinding, layout::kTangentsBinding, layout::kColorsBinding};

template <typename Row>
Words packVertices(size_t count, Row&& row) {
  Words words;
  words.reserve(count * 4);
  for (size_t i = 0; i < count; ++i) appendRow(words, row(i));
  return words;
}

void packAttributes(const Vertices& v, const TraitSet& traits, GpuScene& packed) {
  using namespace layout;
  const size_t count = v.position.size();
  // A variant may read arrays that the scene lacks (tests/probe).
  if (has(traits, Trait::VertexNormals)) {
    packed.buffers[kNormalsBinding] = packVertices(
        count, [&](size_t i) { return v.normal.empty() ? glm::vec4(0.0f) : glm::vec4(v.normal[i], 0.0f); });
  }
  if (has(traits, Trait::Texcoords)) {
    packed.buffers[kTexcoordsBinding] = packVertices(count, [&](size_t i) {
      return glm::vec4(v.texcoord0.empty() ? glm::vec2(0.0f) : v.texcoord0[i],
                       v.texcoord1.empty() ? glm::vec2(0.0f) : v.texcoord1[i]);
    });
  }
  if (has(traits, Trait::Tangents)) {
    packed.buffers[kTangentsBinding] =
        packVertices(count, [&](size_t i) { return v.tangent.empty() ? glm::vec4(0.0f) : v.tangent[i]; });
  }
  if (has(traits, Trait::VertexColors)) {
    packed.buffers[kColorsBinding] =
        packVertices(count, [&](size_t i) { return v.color.empty() ? glm::vec4(1.0f) : v.color[i]; });
  }
}

/// 1 / local space along which light is lost: attenuationColor = exp(-absorption * attenuationDistance); a
/// black channel absorbs all.
glm::vec3 absorption(const Material& m, double unit) {
  if (!std::isfinite(m.attenuationDistance) || m.attenuationDistance <= 0.0f) return glm::vec3(0.0f);
  constexpr double kMost = 1e30;  // finite, so that no distance of zero makes it a NaN
  const glm::dvec3 lost = -glm::log(glm::dvec3(m.attenuationColor)) * (unit / double(m.attenuationDistance));
  return glm::vec3(glm::clamp(lost, glm::dvec3(0.0), glm::dvec3(kMost)));
}

/// Albedo of one scattering inside of a solid, whose textures count by their mean (KHR_materials_scatter,
/// after Kulla and Conty, Revisiting Physically Based Shading at Imageworks, 2017).
glm::vec3 scatteringAlbedo(const Material& m, TexturePacker& textures) {
  const float strength = m.scatterStrength * textures.mean(m.scatterStrengthTexture, TransferCurve::Linear).a;
  const glm::vec3 color =
      m.multiscatterColor * glm::vec3(textures.mean(m.multiscatterColorTexture, TransferCurve::Srgb));
  const glm::dvec3 rho = glm::clamp(glm::dvec3(strength * color), 0.0, 1.0);
  const glm::dvec3 s = 4.09712 + 4.20863 * rho - glm::sqrt(9.59217 + 41.6808 * rho + 17.7126 * rho * rho);
  const double g = m.scatterOfDraft ? 0.0 : double(m.scatterAnisotropy);
  return glm::vec3(glm::clamp((1.0 - s * s) / (1.0 - g * s * s), 0.0, 1.0));
}

// The flags are in the order of Caster.
constexpr std::array kCasterFlags{0u, layout::kMaterialCaster, layout::kMaterialGlossyCaster};
uint32_t materialFlags(const Material& m) {
  uint32_t flags = 0;
  if (m.alphaMode == AlphaMode::Mask) flags |= layout::kMaterialMask;
  if (m.alphaMode == AlphaMode::Blend) flags |= layout::kMaterialBlend;
  if (m.doubleSided) flags |= layout::kMaterialDoubleSided;
  if (m.unlit) flags |= layout::kMaterialUnlit;
  if (m.scattersInside()) flags |= layout::kMaterialScatters;
  if (m.specularGlossiness) flags |= layout::kMaterialSpecularGlossiness;
  return flags;
}

/// Flags of materials that follow from where their solids are.
std::vector<uint32_t> solidFlags(const Scene& scene) {
  std::vector<uint32_t> flags(scene.materials.size(), 0);
  for (size_t i = 0; i < scene.solids.closed.size(); ++i)
    if (scene.solids.closed[i]) flags[i] = layout::kMaterialClosed;
  for (const Light& light : scene.lights) {
    if (light.type == LightType::Directional) continue;
    for (const uint32_t material : solidsAround(scene.solids, glm::dvec3(light.position)))
      flags[material] |= layout::kMaterialHoldsLamps;
  }
  return flags;
}

/// The rows of extensions.
void appendLayers(Words& words, const Material& m, TexturePacker& textures) {
  appendRow(words,
            glm::vec4(m.clearcoatFactor, m.clearcoatRoughnessFactor, m.clearcoatNormalScale, m.dispersion));
  appendRow(words, m.sheenColorFactor, m.sheenRoughnessFactor);
  appendRow(words, glm::vec4(m.anisotropyStrength, std::cos(m.anisotropyRotation),
                             std::sin(m.anisotropyRotation), 0.0f));
  appendRow(words, glm::vec4(m.iridescenceFactor, m.iridescenceIor, m.iridescenceThicknessMinimum,
                             m.iridescenceThicknessMaximum));
  appendRow(words, m.diffuseTransmissionColorFactor, m.diffuseTransmissionFactor);
  appendRow(words, m.scattersInside() ? scatteringAlbedo(m, textures) : m.multiscatterColor,
            m.scatterAnisotropy);
  appendRow(words, glm::vec4(m.scattersThinly() ? m.scatterStrength : 0.0f, 0.0f, 0.0f, 0.0f));
}

/// The rows of the uses of textures.
Words slotsOf(const Material& m, const TraitSet& traits, TexturePacker& textures) {
  Words words;
  for (uint32_t slot = 0; slot < layout::kSlotCount; ++slot) {
    const glm::uvec4 use =
        readsTexture(slot, m, traits) ? textures.slot(m.*kTextureRefs[slot].ref) : glm::uvec4(0u);
    words.insert(words.end(), {use.x, use.y, use.z, use.w});
  }
  return words;
}

void appendMaterial(Words& words, const Material& described, double unit, double emitterPdf, uint32_t flags,
                    size_t glassTable, const TraitSet& traits, TexturePacker& textures) {
  const size_t first = words.size();
  const Words slots = slotsOf(described, traits, textures);
  const Material m = textures.withoutBroken(described);
  appendRow(words, m.baseColorFactor);
  appendRow(words, m.emissiveFactor * m.emissiveStrength, m.alphaCutoff);
  appendRow(words, glm::vec4(m.metallicFactor, m.roughnessFactor, m.ior, m.transmissionFactor));
  appendRow(words, m.specularColorFactor, m.specularFactor);
  appendRow(words, absorption(m, unit), m.thicknessFactor > 0.0f ? 1.0f + float(glassTable) : 0.0f);
  appendRow(words, glm::vec3(m.normalScale, m.occlusionStrength, float(emitterPdf)), 0.0f);
  words.back() = materialFlags(m) | flags;
  appendRow(words, glm::vec4(m.perlinNormal.frequency, m.perlinNormal.amplitude,
                             float(m.perlinNormal.octaves), float(m.number)));
  words.insert(words.end(), slots.begin(), slots.end());
  appendLayers(words, m, textures);
  if (words.size() - first != layout::kMaterialRows * 4)
    throw std::logic_error("a packed material has other rows than layout.glsl says");
}

/// One row per cell of a table with the values at its four corners (shaders/energy.glsl).
void appendCells(Words& words, const EnergyTable& table) {
  constexpr size_t kNodes = EnergyTable::kNodes;
  for (size_t j = 0; j < EnergyTable::kCells; ++j) {
    for (size_t i = 0; i < EnergyTable::kCells; ++i) {
      const float* corner = table.nodes.data() + j * kNodes + i;
      appendRow(words, {corner[0], corner[1], corner[kNodes], corner[kNodes + 1]});
    }
  }
}

/// The cells of the loss, then one row per cell of the average loss.
void appendEnergyTable(Words& words) {
  const GgxEnergyTable& table = ggxEnergyTable();
  appendCells(words, table.loss);
  for (size_t j = 0; j < EnergyTable::kCells; ++j) {
    appendRow(words, {table.averageLoss[j], table.averageLoss[j + 1], 0.0f, 0.0f});
  }
}

/// The indices of refraction of solids that get a table, each once.
std::vector<float> indicesOfRoughGlass(const Scene& scene, const ShaderVariant& variant) {
  std::vector<float> indices;
  if (!usesGlassTables(variant)) return indices;
  const TraitRow& row = traitRows()[size_t(Trait::RoughGlass)];
  for (const Material& m : scene.materials) {
    if (m.thicknessFactor > 0.0f && row.ofMaterial(m, Coordinates{}) &&
        std::ranges::find(indices, m.ior) == indices.end())
      indices.push_back(m.ior);
  }
  return indices;
}

size_t tableOf(const std::vector<float>& indices, const Material& m) {
  const auto found = std::ranges::find(indices, m.ior);
  return found == indices.end() ? 0 : size_t(found - indices.begin());
}

EnvironmentDraws drawsOf(const ShaderVariant& variant) {
  if (!has(variant.traits, Trait::EnvironmentSampling)) return EnvironmentDraws::Nothing;
  return has(variant.stages, Stage::Gi) ? EnvironmentDraws::LightAndPaths : EnvironmentDraws::Light;
}

std::vector<glm::vec3> meanRadiance(const Scene& scene, const TraitSet& traits, TexturePacker& textures) {
  std::vector<glm::vec3> radiance(scene.materials.size(), glm::vec3(0.0f));
  if (!has(traits, Trait::Emission)) return radiance;
  for (size_t i = 0; i < radiance.size(); ++i) {
    if (scene.materials[i].emissive()) radiance[i] = textures.meanRadiance(scene.materials[i]);
  }
  return radiance;
}

/// The properties of the packed map that the lights need. The map may be on the device already.
KeptArrays::KeptEnvironment packMap(const Environment& environment, const ShaderVariant& variant,
                                    KeptArrays* kept, GpuScene& packed) {
  const EnvironmentDraws draws = drawsOf(variant);
  const bool suns = has(variant.traits, Trait::Sun) || has(variant.traits, Trait::MapSun);
  const bool keeps = kept != nullptr && environment.kind == Surroundings::Map;
  const auto serves = [&](const KeptArrays::KeptEnvironment& packedBefore) {
    return packedBefore.draws == int(draws) && packedBefore.forCatcher == variant.shadowCatcher &&
           packedBefore.light == lightsByEnvironment(variant) && packedBefore.suns == suns &&
           has(variant.traits, Trait::Backdrop) == (packedBefore.backdropSize.x > 0);
  };
  if (keeps && kept->environment && serves(*kept->environment)) {
    packed.unchanged[layout::kEnvironmentBinding] = true;
    packed.unchanged[layout::kEnvironmentInversionBinding] = true;
    return *kept->environment;
  }
  const double sunPower = environment.sun ? powerOf(*environment.sun) : 0.0;
  PackedEnvironment map = packEnvironment(environment.image, draws, sunPower);
  KeptArrays::KeptEnvironment result{map.size,
                                     {0, 0},
                                     glm::vec3(0.0f),
                                     map.power,
                                     int(draws),
                                     variant.shadowCatcher,
                                     lightsByEnvironment(variant),
                                     suns,
                                     environment.mapSun ? environment.mapSun->power : sunPower};
  if (has(variant.traits, Trait::Backdrop)) {
    // A program that is forced to have one (tests/probe) draws the map itself.
    const Image& seen = environment.backdrop.values.empty() ? environment.image : environment.backdrop;
    result.backdropSize = {seen.width, seen.height};
    appendBackdrop(seen, map.texels);
  }
  if (suns) appendSuns(environment, map.drawnPower, map.texels);
  Image withSun;
  if (result.light) appendEnvironmentLight(wholeMap(environment, withSun), map.texels);
  if (variant.shadowCatcher) result.upwardIrradiance = upwardIrradiance(environment.image);
  if (environment.sun) {
    const SunDisc& sun = *environment.sun;
    result.power += sunPower;
    result.upwardIrradiance += glm::vec3(sun.irradiance * std::max(0.0, sun.direction.y));
  }
  packed.buffers[layout::kEnvironmentBinding] = std::move(map.texels);
  packed.buffers[layout::kEnvironmentInversionBinding] = std::move(map.inversion);
  if (kept != nullptr) kept->environment = keeps ? std::optional(result) : std::nullopt;
  return result;
}

double radiusOf(const Bvh& bvh) { return 0.5f * glm::length(bvh.bounds.extent()); }

/// The map of a scene of that radius, and the part of the light that it has.
void placeMap(const Environment& environment, const ShaderVariant& variant, double radius, KeptArrays* kept,
              GpuScene& packed) {
  const KeptArrays::KeptEnvironment surroundings = packMap(environment, variant, kept, packed);
  packed.environmentSize = surroundings.size;
  packed.backdropSize = surroundings.backdropSize;
  packed.upwardIrradiance = surroundings.upwardIrradiance;
  packed.lightShare.samplesEnvironment = has(variant.traits, Trait::EnvironmentSampling);
  packed.lightShare.environment = surroundings.power * radius * radius;
  packed.lightShare.sun = surroundings.sunPower * radius * radius;
}

std::vector<std::pair<std::string, size_t>> imagesOf(const Scene& scene) {
  std::vector<std::pair<std::string, size_t>> images;
  for (const EncodedImage& image : scene.images) images.emplace_back(image.name, image.bytes.size());
  return images;
}

/// Materials, their tables, and the numbers of objects. materialPdf: of the light samples on each material.
void packMaterials(const Scene& scene, const Bvh& bvh, const ShaderVariant& variant,
                   const std::vector<double>& materialPdf, const std::vector<Caster>& casters,
                   TexturePacker& textures, GpuScene& packed) {
  using namespace layout;
  const std::vector<float> glass = indicesOfRoughGlass(scene, variant);
  const std::vector<uint32_t> ofSolids = solidFlags(scene);
  Words& materials = packed.buffers[kMaterialsBinding];
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    appendMaterial(materials, scene.materials[i], scene.space.unit, materialPdf[i],
                   kCasterFlags[size_t(casters[i])] | ofSolids[i], tableOf(glass, scene.materials[i]),
                   variant.traits, textures);
  }
  textures.appendTransforms(materials);
  if (has(variant.traits, Trait::Sheen)) appendCells(materials, sheenAlbedoTable());
  packed.energyTableRow = uint32_t(materials.size() / 4);
  if (has(variant.stages, Stage::EnergyCompensation)) appendEnergyTable(materials);
  for (const float ior : glass) {
    const GlassAlbedoTable& table = glassAlbedoTable(ior);
    appendCells(materials, table.outside);
    appendCells(materials, table.inside);
  }
  packed.objectRow = uint32_t(materials.size() / 4);
  if (has(variant.traits, Trait::ObjectNumbers)) appendObjectNumbers(scene, bvh, materials);
}

/// Decodes the pictures of the plan, unless they are on the device by the same plan.
TexturePacker packTextures(const Scene& scene, const TexturePlan& plan, KeptArrays* kept,
                           const DecodeProgress& progress, const TexelMemory& memory, GpuScene& packed) {
  const bool keeps =
      kept != nullptr && kept->images == imagesOf(scene) && kept->textures.places == plan.places;
  TexturePacker textures(scene, plan, keeps ? kept->pictures : std::vector<PictureFacts>(), progress, memory);
  packed.textures = plan;
  packed.pictures = textures.takePictures();
  packed.brokenPictures = textures.takeBroken();
  if (kept == nullptr) return textures;
  kept->images = imagesOf(scene);
  kept->textures = plan;
  kept->pictures = textures.facts();
  return textures;
}

/// The grid of densities, unless it is on the device.
void packVolume(const Scene& scene, const TraitSet& traits, KeptArrays* kept, GpuScene& packed) {
  const VolumeGrid* grid = has(traits, Trait::DensityGrid) ? scene.volume.grid.get() : nullptr;
  if (kept != nullptr && grid != nullptr && kept->grid == grid) {
    packed.unchanged[layout::kBricksBinding] = true;
    packed.densities = kept->densities;
    return;
  }
  if (grid != nullptr) packed.densities = packGrid(*grid, packed.buffers[layout::kBricksBinding]);
  if (kept == nullptr) return;
  kept->grid = grid;
  kept->densities = packed.densities;
}

/// The triangles that the tree does without. A tree on the device that was packed without others is not kept.
std::vector<bool> cutOutOf(const Scene& scene, const ShaderVariant& variant, const TexturePacker& textures,
                           KeptArrays* kept) {
  std::vector<bool> cutOut;
  if (testsAlpha(variant) && !variant.countsVisits) cutOut = cutOutTriangles(scene, variant.traits, textures);
  if (kept == nullptr || kept->cutOut == cutOut) return cutOut;
  kept->geometry = false;
  kept->cutOut = cutOut;
  return cutOut;
}

/// Tree, leaves, faces and vertices, unless they are on the device as they are.
void packGeometry(const Scene& scene, const Bvh& bvh, const TraitSet& traits, bool kept, GpuScene& packed) {
  using namespace layout;
  if (kept) {
    for (const uint32_t binding : kGeometryBindings) packed.unchanged[binding] = true;
    return;
  }
  packed.buffers[kNodesBinding] = packNodes(bvh, has(traits, Trait::MovingSurfaces));
  if (!scene.instances.empty()) appendInstances(scene, bvh, packed.buffers[kNodesBinding]);
  packed.buffers[kLeavesBinding] = packLeaves(scene, bvh, has(traits, Trait::MovingSurfaces));
  packed.buffers[kFacesBinding] = packFaces(scene, bvh, has(traits, Trait::Creases));
  packAttributes(scene.vertices, traits, packed);
}

}  // namespace

size_t texelsOf(const VolumeGrid& grid) {
  return tableTexelsOf(grid) + grid.values.size() / kBrickVoxels * texelsPerBrick(grid);
}

PackedGrid packGrid(const VolumeGrid& grid, Words& texels) {
  PackedGrid packed;
  packed.bricks = grid.bricks + 1;
  packed.largest = grid.largest;
  packed.brightest = grid.brightest;
  const glm::dmat4 toBricks = glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / kBrickSide));
  packed.fromFile = toBricks * glm::translate(glm::dmat4(1.0), glm::dvec3(kBrickSide - grid.minimum)) *
                    glm::inverse(grid.toWorld);

  const size_t stored = grid.values.size() / kBrickVoxels;
  std::vector<Largest> largest(stored);
  for (size_t i = 0; i < stored; ++i) largest[i] = largestOf(&grid.values[i * kBrickVoxels]);
  const auto tableTexels = uint32_t(tableTexelsOf(grid));
  const auto perBrick = uint32_t(texelsPerBrick(grid));
  texels.reserve(2 * texelsOf(grid));

  for (int z = -1; z < grid.bricks.z; ++z) {
    for (int y = -1; y < grid.bricks.y; ++y) {
      for (int x = -1; x < grid.bricks.x; ++x) {
        // Interpolation at a brick's upper sides also reads the lower sides of the next bricks.
        uint16_t most = 0;
        for (uint32_t s = 0; s < 8; ++s) {
          const uint32_t number = grid.entryOf(glm::ivec3(x, y, z) + glm::ivec3(s & 1, (s >> 1) & 1, s >> 2));
          if (number > 0) most = std::max(most, largest[number - 1][s]);
        }
        const uint32_t number = grid.entryOf({x, y, z});
        texels.push_back(number == 0 ? 0 : tableTexels + (number - 1) * perBrick);
        texels.push_back(floatWord(glm::unpackHalf1x16(most)));
      }
    }
  }
  for (size_t i = 0; i < stored; ++i) {
    appendHalves(texels, &grid.values[i * kBrickVoxels], kBrickVoxels);
    if (grid.radiance.empty()) continue;
    for (size_t v = i * kBrickVoxels; v < (i + 1) * kBrickVoxels; ++v) {
      const std::array<uint16_t, 4> rgb{grid.radiance[3 * v], grid.radiance[3 * v + 1],
                                        grid.radiance[3 * v + 2], 0};
      appendHalves(texels, rgb.data(), rgb.size());
    }
  }
  return packed;
}

size_t GpuScene::bytes() const {
  size_t words = 0;
  for (const Words& buffer : buffers) words += buffer.size();
  return words * sizeof(uint32_t) + (pictures.empty() ? 0 : textures.bytes());
}

size_t GpuScene::geometryBytes() const {
  size_t words = 0;
  for (const uint32_t binding : kGeometryBindings) words += buffers[binding].size();
  return words * sizeof(uint32_t);
}

GpuScene packSurroundings(const Bvh& bvh, const Environment& environment, const ShaderVariant& variant,
                          KeptArrays& kept) {
  GpuScene packed;
  packed.unchanged.fill(true);
  if (!has(variant.traits, Trait::Environment)) return packed;
  kept.environment.reset();
  packed.unchanged[layout::kEnvironmentBinding] = false;
  packed.unchanged[layout::kEnvironmentInversionBinding] = false;
  placeMap(environment, variant, radiusOf(bvh), &kept, packed);
  return packed;
}

GpuScene packScene(const Scene& scene, const Bvh& bvh, const Environment& environment,
                   const ShaderVariant& variant, const TexturePlan& plan, KeptArrays* kept,
                   const DecodeProgress& progress, const TexelMemory& memory) {
  using namespace layout;
  GpuScene packed;
  const TraitSet& traits = variant.traits;
  TexturePacker textures = packTextures(scene, plan, kept, progress, memory, packed);
  packed.cutOut = cutOutOf(scene, variant, textures, kept);
  const Bvh without = packed.cutOut.empty() ? Bvh() : pruned(bvh, packed.cutOut);
  const Bvh& drawn = packed.cutOut.empty() ? bvh : without;
  packed.extent = sceneExtent(bvh.bounds);
  packed.leafCount = uint32_t(bvh.leaves.size());
  packed.segments = segmentsOf(scene, bvh);
  const double radius = radiusOf(bvh);
  packGeometry(scene, drawn, traits, kept != nullptr && kept->geometry, packed);

  // Step: lights; the environment shares light samples with the rest by power.
  const std::vector<glm::vec3> radiance = meanRadiance(scene, traits, textures);
  std::vector<uint32_t> slots;
  if (has(traits, Trait::EmissiveTriangles)) slots = leafSlots(scene, drawn);
  PackedEmitters emitters = packEmitters(scene, radiance, slots, bvh.leaves.size() * 2, radius, variant);
  packed.emitterCount = emitters.count;
  const std::vector<Caster> casters = castersOf(scene);
  if (has(traits, Trait::Caustics)) {
    for (const Ball& ball : casterBalls(scene, casters, kMostCasters))
      packed.casters.emplace_back(ball.middle, ball.radius);
    packed.wideLamps = !samplesSun(traits) && areLampsWide(scene, casters);
  }
  packed.buffers[kEmittersBinding] = std::move(emitters.entries);
  if (has(traits, Trait::PunctualLights)) {
    packed.buffers[kLightsBinding] = packLights(scene);
    packed.punctualLights = uint32_t(scene.lights.size());
  }
  if (has(traits, Trait::Caustics))
    packed.buffers[kLightsBinding].resize(packed.buffers[kLightsBinding].size() + kGuidingRows * 4);
  if (has(traits, Trait::Environment)) {
    placeMap(environment, variant, radius, kept, packed);
    packed.lightShare.emitters = emitters.power;
    packed.lightShare.anyEmitters = emitters.count > 0;
  }

  packMaterials(scene, bvh, variant, emitters.materialPdf, casters, textures, packed);
  packVolume(scene, traits, kept, packed);
  return packed;
}

GpuScene packScene(const Scene& scene, const Bvh& bvh, const Environment& environment,
                   const ShaderVariant& variant) {
  return packScene(scene, bvh, environment, variant, planTextures(scene, variant.traits));
}

namespace {

float wordFloat(uint32_t word) { return std::bit_cast<float>(word); }

float roundedUp(double x) { return std::nextafter(float(x), std::numeric_limits<float>::infinity()); }

glm::vec3 rowOf(const glm::mat3& m, int row) { return {m[0][row], m[1][row], m[2][row]}; }

void appendInstance(const Instance& instance, const BvhMesh& tree, Words& words) {
  const glm::mat3 toLocal{glm::dmat3(instance.toLocal)};
  const glm::mat3 toMesh{glm::inverse(glm::dmat3(toLocal))};
  const glm::vec3 place{glm::dvec3(instance.toLocal[3])};
  const InstanceOffset offset = instanceOffset(glm::dmat3(toLocal), glm::dmat3(toMesh), glm::dvec3(place));
  for (int row = 0; row < 3; ++row) appendRow(words, rowOf(toMesh, row), place[row]);
  appendRow(words, glm::vec3(wordFloat(tree.wideRoot), roundedUp(offset.scale), 0.0f), 0.0f);
  const float handedness = glm::determinant(glm::dmat3(toLocal)) < 0.0 ? -1.0f : 1.0f;
  const std::array<float, 3> beside{roundedUp(offset.base), handedness,
                                    roundedUp(stretchBound(glm::dmat3(toMesh)))};
  for (int row = 0; row < 3; ++row) appendRow(words, rowOf(toLocal, row), beside[size_t(row)]);
}

}  // namespace

InstanceOffset instanceOffset(const glm::dmat3& toLocal, const glm::dmat3& toMesh, const glm::dvec3& place) {
  constexpr double kUnit = 0x1p-24;
  constexpr double kOfMeshOffset = 32.0;  // units in hitPointError()
  const double stretch = stretchBound(toLocal);
  const double there = rowNorm(toLocal);
  const double back = rowNorm(toMesh);
  const glm::dvec3 far = glm::abs(place);
  return {(stretch * (22.0 + 9.0 * back * there + 24.0 * back * stretch) + 9.0 * there) / kOfMeshOffset,
          4.0 * kUnit * std::max({far.x, far.y, far.z})};
}

uint32_t firstInstanceBlock(const Bvh& bvh) {
  return uint32_t((bvh.wide.size() * layout::kNodeRows + layout::kInstanceRows - 1) / layout::kInstanceRows);
}

void appendInstances(const Scene& scene, const Bvh& bvh, Words& nodes) {
  constexpr size_t kBlockWords = size_t(layout::kInstanceRows) * 4;
  checkIndices("instances", firstInstanceBlock(bvh) + scene.instances.size());
  nodes.reserve((firstInstanceBlock(bvh) + scene.instances.size()) * kBlockWords);
  nodes.resize(firstInstanceBlock(bvh) * kBlockWords);
  for (const Instance& instance : scene.instances) appendInstance(instance, bvh.meshes[instance.mesh], nodes);
}

}  // namespace fragtrace
