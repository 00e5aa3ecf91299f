// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <utility>

#include "base/text.h"
#include "bvh/bvh.h"
#include "cli/commands.h"
#include "gltf/gltf.h"
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
  ShaderVariant variant = chooseVariant({}, traits, surroundings, bvh.depth, BufferReads::Auto);
  for (const TraitRow& row : traitRows()) {
    if (row.textures.front()) variant.traits.reset(size_t(row.trait));
  }
  for (const Trait t : {Trait::EmissiveTriangles, Trait::PunctualLights, Trait::Environment})
    variant.traits.reset(size_t(t));
  return double(packScene(scene, bvh, {}, variant).geometryBytes()) / double(scene.triangles.size());
}

/// The parts that options may name: how many, and of each its index, its name and a note; nothing where there
/// is none.
void printParts(const char* what, const std::vector<std::string>& names,
                const std::vector<std::string>& notes = {}) {
  if (names.empty()) return;
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string note = i < notes.size() ? notes[i] : "";
    list +=
        (i == 0 ? "" : ", ") + std::to_string(i) + " " + (names[i].empty() ? "unnamed" : inQuotes(names[i]));
    if (!note.empty()) list += " (" + note + ")";
  }
  std::printf("  %-11s %zu: %s\n", what, names.size(), list.c_str());
}

const char* kindOf(const Camera& camera) { return kCameraTypeNames[size_t(camera.type)].data(); }

void printAllParts(const Scene& scene) {
  std::vector<std::string> cameras;
  std::vector<std::string> kinds;
  for (const Camera& camera : scene.cameras) {
    cameras.push_back(camera.name);
    kinds.emplace_back(kindOf(camera));
  }
  std::vector<std::string> durations;
  for (const std::optional<double>& seconds : scene.animationSeconds) {
    durations.push_back(seconds ? formatted("%.4g s", *seconds) : "of unknown duration");
  }
  if (cameras.empty()) std::printf("  cameras     none\n");
  printParts("cameras", cameras, kinds);
  printParts("scenes", scene.sceneNames);
  printParts("animations", scene.animationNames, durations);
  printParts("variants", scene.materialVariants);
  const VolumeSource& volume = scene.volume.source;
  if (!volume.file.empty())
    std::printf("  volume      %s\n",
                withoutControls(volume.file.string() + (volume.grid ? ":" + *volume.grid : "")).c_str());
}

/// Adds the same as JSON.
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

/// The contents of a node, in words.
std::vector<std::string> contentsOf(const SceneNode& node) {
  std::vector<std::string> words;
  if (node.mesh) words.emplace_back("mesh");
  if (node.light) words.emplace_back("light");
  if (node.camera) words.emplace_back("camera");
  return words;
}

/// Prints a line for each node, indented below its parent.
void printNodes(const std::vector<SceneNode>& nodes) {
  std::printf("  nodes       %zu\n", nodes.size());
  for (const SceneNode& node : nodes) {
    std::string notes = node.hidden ? ", hidden" : "";
    for (const std::string& word : contentsOf(node)) notes += ", " + word;
    std::printf("    %*s%u %s%s\n", 2 * node.depth, "", node.index, inQuotes(node.name).c_str(),
                notes.c_str());
  }
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

void printText(const std::filesystem::path& path, const SceneDescription& s, const BvhQuality& bvh,
               double bytesPerTriangle, size_t volumeBytes, const TraitSet& traits) {
  std::printf("%s\n", path.string().c_str());
  std::printf("  triangles   %zu (%zu emissive), vertices %zu, spheres %zu\n", s.triangles,
              s.emissiveTriangles, s.vertices, s.spheres);
  if (s.points + s.lines > 0)
    std::printf("  lines       %zu points, %zu line segments (as solids of --line-width pixels)\n", s.points,
                s.lines);
  std::printf("  materials   %zu, textures %zu, images %zu (%.1f MB encoded)\n", s.materials, s.textures,
              s.images, double(s.imageBytes) / 1e6);
  std::printf("  lights      %zu point, %zu spot, %zu directional\n", s.pointLights, s.spotLights,
              s.directionalLights);
  std::printf("  extensions  %s\n",
              s.extensionsUsed.empty() ? "none" : withoutControls(joined(s.extensionsUsed)).c_str());
  if (s.bounds.empty()) {
    std::printf("  bounds      empty\n");
  } else {
    const glm::dvec3& a = s.bounds.minimum;
    const glm::dvec3& b = s.bounds.maximum;
    std::printf("  bounds      (%g, %g, %g) to (%g, %g, %g) m\n", a.x, a.y, a.z, b.x, b.y, b.z);
  }
  std::printf("  tree        %u nodes, %u leaves, depth %u, %.2f primitives per leaf, SAH cost %.2f\n",
              bvh.nodeCount, bvh.leafCount, bvh.depth, bvh.primitivesPerLeaf, bvh.sahCost);
  const double geometry = bytesPerTriangle * double(s.triangles);
  if (s.sharedMeshes > 0)
    std::printf(
        "  shared      %zu meshes in %zu instances, %zu triangles drawn; %u nodes are theirs, %u above "
        "them\n",
        s.sharedMeshes, s.sharedInstances, s.trianglesDrawn, bvh.meshNodeCount,
        bvh.nodeCount - bvh.meshNodeCount);
  std::printf("  instancing  %s\n", s.sharing.c_str());
  std::printf("  GPU memory  %.1f MB: geometry %.1f",
              (geometry + double(s.texelBytes) + double(volumeBytes)) / 1e6, geometry / 1e6);
  if (s.triangles > 0) std::printf(" (%.1f bytes per triangle)", bytesPerTriangle);
  std::printf(", textures %.1f", double(s.texelBytes) / 1e6);
  if (volumeBytes > 0) std::printf(", volume %.1f", double(volumeBytes) / 1e6);
  std::printf("\n");
  for (const StageRow& row : stageRows()) {
    const std::string reason = whyOff(row.stage, traits);
    if (!reason.empty()) std::printf("  not needed  %s (%s)\n", row.name, reason.c_str());
  }
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
    for (const EncodedImage& image : scene.images) {
      try {
        decodeTexels(image.bytes, nameOf(image));
      } catch (const InputError& error) {
        if (!loading.limits.drawMissingTextures || loading.limits.strict) throw;
        scene.warnings.emplace_back(error.what());
      }
    }
  }
  const SceneDescription description = describe(scene);
  const Bvh tree = buildSceneBvh(scene);
  const BvhQuality bvh = bvhQuality(tree);
  for (const std::string& warning : scene.warnings) std::cerr << "fragtrace: warning: " << warning << '\n';
  const Surroundings surroundings = hasOwnLight(scene) ? Surroundings::None : Surroundings::Map;
  const TraitSet traits = traitsOf(scene, surroundings);
  const double bytesPerTriangle =
      scene.triangles.empty() ? 0.0 : gpuBytesPerTriangle(scene, tree, traits, surroundings);
  const size_t volumeBytes = scene.volume.grid ? texelsOf(*scene.volume.grid) * sizeof(glm::uvec2) : 0;
  if (!options.json) {
    printText(options.render.scene, description, bvh, bytesPerTriangle, volumeBytes, traits);
    printAllParts(scene);
    if (options.nodes) printNodes(scene.nodes);
    return 0;
  }
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["file"] = options.render.scene.string();
  json["scene"] = sceneJson(description);
  json["bvh"] = bvhJson(bvh);
  if (bytesPerTriangle > 0.0) json["gpu_bytes_per_triangle"] = bytesPerTriangle;
  json["texture_bytes"] = description.texelBytes;
  if (volumeBytes > 0) json["volume_bytes"] = volumeBytes;
  nlohmann::ordered_json notNeeded = nlohmann::ordered_json::object();
  for (const StageRow& row : stageRows()) {
    const std::string reason = whyOff(row.stage, traits);
    if (!reason.empty()) notNeeded[row.name] = reason;
  }
  json["not_needed"] = notNeeded;
  nlohmann::ordered_json materials = nlohmann::ordered_json::array();
  for (const Material& m : scene.materials) materials.push_back(m.name);
  json["material_names"] = materials;
  addParts(json, scene);
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
  return [raw] { return runInfo({raw->render.options, raw->json, raw->nodes, raw->decode}); };
}

}  // namespace fragtrace
