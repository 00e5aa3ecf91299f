// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <utility>

#include "base/text.h"
#include "bvh/bvh.h"
#include "cli/commands.h"
#include "cli/info_contents.h"
#include "cli/info_text.h"
#include "gltf/gltf.h"
#include "image/files/decode_each.h"
#include "options/choose.h"
#include "options/option_row.h"
#include "options/parse_render.h"
#include "pack/gpu_scene.h"
#include "pack/pack_grid.h"
#include "scene/describe.h"
#include "scene/parts.h"
#include "scene/volume/read_grid.h"
#include "session/scene_json.h"
#include "session/setup.h"
#include "shader/render_options.h"
#include "shader/variant.h"

namespace fragtrace {

namespace {

struct InfoOptions {
  RenderOptions render;  ///< read are the file, and the options of reading it
  bool json = false;
  bool nodes = false;
  bool decode = false;
};

/// The bytes a triangle that a scene takes on the device by default, without textures and lights.
double gpuBytesPerTriangle(const Scene& scene, const Bvh& bvh, const TraitSet& traits,
                           Surroundings surroundings) {
  ShaderVariant variant = chooseVariant({}, traits, surroundings, bvh.stackNeed, BufferReads::Auto);
  for (uint32_t slot = 0; slot < layout::kSlotCount; ++slot) variant.traits.reset(size_t(slotTrait(slot)));
  for (const Trait t : {Trait::EmissiveTriangles, Trait::PunctualLights, Trait::Environment})
    variant.traits.reset(size_t(t));
  return double(packScene(scene, bvh, {}, variant).geometryBytes()) / double(scene.triangles.size());
}

/// Adds what the text has of the scene's parts.
void addParts(nlohmann::ordered_json& json, const Scene& scene) {
  json["scene_names"] = scene.sceneNames;
  json["animation_names"] = scene.animationNames;
  json["animations"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i < scene.animationNames.size(); ++i) {
    nlohmann::ordered_json animation = {{"name", scene.animationNames[i]}, {"duration_s", nullptr}};
    if (scene.animationSeconds[i]) animation["duration_s"] = *scene.animationSeconds[i];
    json["animations"].push_back(std::move(animation));
  }
  json["cameras"] = nlohmann::ordered_json::array();
  for (const Camera& camera : scene.cameras)
    json["cameras"].push_back({{"name", camera.name}, {"type", kindOf(camera)}});
  json["material_variants"] = scene.materialVariants;
  if (!scene.volume.source.file.empty()) json["volume"] = scene.volume.source.file.string();
}

SceneCosts costsOf(const Scene& scene) {
  const Bvh tree = buildSceneBvh(scene);
  const Surroundings surroundings = hasOwnLight(scene) ? Surroundings::None : Surroundings::Map;
  SceneCosts costs{.tree = bvhQuality(tree), .traits = traitsOf(scene, surroundings)};
  if (!scene.triangles.empty())
    costs.bytesPerTriangle = gpuBytesPerTriangle(scene, tree, costs.traits, surroundings);
  if (scene.volume.grid) costs.volumeBytes = texelsOf(*scene.volume.grid) * sizeof(glm::uvec2);
  return costs;
}

nlohmann::ordered_json nodesJson(const std::vector<SceneNode>& nodes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const SceneNode& node : nodes)
    json.push_back({{"index", node.index},
                    {"name", node.name},
                    {"depth", node.depth},
                    {"hidden", node.hidden},
                    {"contents", contentsOf(node)}});
  return json;
}

/// Adds what the text has for a reader.
void addContents(nlohmann::ordered_json& json, const RenderOptions& options, const Scene& scene,
                 const BoundsDouble& bounds) {
  json["size"] = nullptr;
  if (!bounds.empty()) {
    const glm::dvec3 size = bounds.maximum - bounds.minimum;
    json["size"] = {size.x, size.y, size.z};
  }
  json["materials"] = nlohmann::ordered_json::array();
  for (const Material* m : materialsOf(scene)) {
    nlohmann::ordered_json textures = nlohmann::ordered_json::array();
    for (const TextureContents& t : texturesOf(scene, *m))
      textures.push_back({{"slot", t.slot}, {"name", t.name}, {"width", t.width}, {"height", t.height}});
    json["materials"].push_back({{"name", m->name}, {"textures", textures}});
  }
  json["lamps"] = nlohmann::ordered_json::array();
  for (const LampContents& lamp : lampsOf(scene))
    json["lamps"].push_back(
        {{"name", lamp.name}, {"type", lamp.type}, {"intensity", lamp.intensity}, {"unit", lamp.unit}});
  json["lit_by"] = whoLights(options, scene).by;
  json["generator"] = scene.made.generator;
  json["copyright"] = scene.made.copyright;
  json["files"] = nlohmann::ordered_json::array();
  for (const FileContents& file : filesOf(options.scene, scene))
    json["files"].push_back({{"name", file.name}, {"bytes", file.bytes}});
}

/// The grids of a volume's file.
int informOfVolume(const InfoOptions& options) {
  const std::filesystem::path& path = options.render.scene;
  nlohmann::ordered_json json = {
      {"schema", 1}, {"file", path.string()}, {"grids", nlohmann::ordered_json::array()}};
  if (!options.json) std::printf("%s\n", path.string().c_str());
  for (const GridDescription& grid : listGrids(path, options.render.limits.memoryBytes)) {
    const glm::ivec3& v = grid.voxels;
    if (!options.json)
      std::printf("  grid        %s (%s%s), %d x %d x %d voxels, %s active\n", inQuotes(grid.name).c_str(),
                  grid.type.c_str(), grid.isDensity ? "" : ", no densities", v.x, v.y, v.z,
                  std::to_string(grid.activeVoxels).c_str());
    const glm::dvec3& a = grid.box.minimum;
    const glm::dvec3& b = grid.box.maximum;
    if (!options.json && !grid.box.empty()) {
      std::printf("              (%g, %g, %g) to (%g, %g, %g), values up to %g\n", a.x, a.y, a.z, b.x, b.y,
                  b.z, grid.largest);
    }
    json["grids"].push_back({{"name", grid.name},
                             {"type", grid.type},
                             {"density", grid.isDensity},
                             {"voxels", {v.x, v.y, v.z}},
                             {"active_voxels", grid.activeVoxels},
                             {"largest", grid.largest}});
    if (!grid.box.empty())
      json["grids"].back()["bounds"] = {{"min", {a.x, a.y, a.z}}, {"max", {b.x, b.y, b.z}}};
  }
  if (options.json) std::cout << jsonText(json);
  return 0;
}

int inform(const InfoOptions& options) {
  if (options.render.scene.extension() == ".nvdb") return informOfVolume(options);
  GltfOptions loading;
  loading.selection = options.render.selection;
  loading.instancing = options.render.device.instancing;
  loading.limits = options.render.limits;
  Scene scene = loadGltf(options.render.scene, loading);
  placeVolume(scene, options.render, nullptr);
  for (const std::string& odd : {whyEmpty(scene, loading.selection), strayNode(scene)}) {
    if (!odd.empty()) scene.warnings.push_back(options.render.scene.string() + ": " + odd);
  }
  if (options.decode) {
    std::vector<EncodedPicture> pictures;
    for (const EncodedImage& image : scene.images) pictures.push_back({image.bytes, nameOf(image)});
    for (std::string& error : decodeEach(pictures, [](size_t, const TexelImage&) {})) {
      if (error.empty()) continue;
      if (!loading.limits.drawMissingTextures || loading.limits.strict) throw InputError(error);
      scene.warnings.push_back(std::move(error));
    }
  }
  const SceneDescription description = describe(scene);
  for (const std::string& warning : scene.warnings) std::cerr << "fragtrace: warning: " << warning << '\n';
  if (!options.json) {
    printContents(options.render, scene, description);
    if (options.render.output.verbose) printCosts(description, costsOf(scene));
    if (options.nodes) printNodes(scene.nodes);
    return 0;
  }
  const SceneCosts costs = costsOf(scene);
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["file"] = options.render.scene.string();
  json["scene"] = sceneJson(description);
  json["bvh"] = bvhJson(costs.tree);
  if (costs.bytesPerTriangle > 0.0) json["gpu_bytes_per_triangle"] = costs.bytesPerTriangle;
  json["texture_bytes"] = description.texelBytes;
  if (costs.volumeBytes > 0) json["volume_bytes"] = costs.volumeBytes;
  nlohmann::ordered_json notNeeded = nlohmann::ordered_json::object();
  for (const StageRow& row : stageRows()) {
    const std::string reason = whyOff(row.stage, costs.traits);
    if (!reason.empty()) notNeeded[row.name] = reason;
  }
  json["not_needed"] = notNeeded;
  nlohmann::ordered_json materials = nlohmann::ordered_json::array();
  for (const Material* m : materialsOf(scene)) materials.push_back(m->name);
  json["material_names"] = materials;
  addParts(json, scene);
  addContents(json, options.render, scene, description.bounds);
  if (options.nodes) json["nodes"] = nodesJson(scene.nodes);
  json["warnings"] = scene.warnings;
  std::cout << jsonText(json);
  return 0;
}

int runInfo(const InfoOptions& options) {
  try {
    return inform(options);
  } catch (const std::exception& error) {
    if (options.json) {
      const nlohmann::ordered_json json = {
          {"schema", 1}, {"file", options.render.scene.string()}, {"error", error.what()}};
      std::cout << jsonText(json);
    }
    throw;
  }
}

}  // namespace

RunCommand addInfo(CLI::App& app) {
  struct Raw {
    RawRender render;
    bool json = false;
    bool nodes = false;
    bool decode = false;
  };
  const auto raw = std::make_shared<Raw>();
  addOption(app, "file", raw->render)->required();
  app.add_flag("--json", raw->json, "print one JSON object");
  app.add_flag("--nodes", raw->nodes, "also list the nodes of the scene");
  app.add_flag("--decode", raw->decode, "also decode the textures, so that a broken one is an error");
  for (const OptionRow& row : inputRows()) addOption(app, row.name, raw->render);
  addOption(app, "--instancing", raw->render);
  addOption(app, "--verbose", raw->render,
            "also print the tree and what it costs, and all materials of a file with many");
  return [raw] { return runInfo({raw->render.options, raw->json, raw->nodes, raw->decode}); };
}

}  // namespace fragtrace
