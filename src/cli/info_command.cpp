// SPDX-License-Identifier: MIT
#include <cstdio>
#include <iostream>

#include "cli/commands.h"
#include "cli/scene_json.h"
#include "gltf/gltf.h"
#include "stage/variant.h"

namespace fragtrace {

namespace {

void printText(const std::filesystem::path& path, const SceneDescription& s, const BvhQuality& bvh,
               const TraitSet& traits) {
  std::printf("%s\n", path.string().c_str());
  std::printf("  triangles   %zu (%zu emissive), vertices %zu, spheres %zu\n", s.triangles,
              s.emissiveTriangles, s.vertices, s.spheres);
  std::printf("  materials   %zu, textures %zu, images %zu (%.1f MB encoded)\n", s.materials, s.textures,
              s.images, double(s.imageBytes) / 1e6);
  std::printf("  lights      %zu point, %zu spot, %zu directional\n", s.pointLights, s.spotLights,
              s.directionalLights);
  std::printf("  cameras     %zu perspective, %zu orthographic\n", s.perspectiveCameras,
              s.orthographicCameras);
  std::string extensions;
  for (const std::string& name : s.extensionsUsed) extensions += (extensions.empty() ? "" : ", ") + name;
  std::printf("  extensions  %s\n", extensions.empty() ? "none" : extensions.c_str());
  if (s.bounds.empty()) {
    std::printf("  bounds      empty\n");
  } else {
    const glm::dvec3& a = s.bounds.minimum;
    const glm::dvec3& b = s.bounds.maximum;
    std::printf("  bounds      (%g, %g, %g) to (%g, %g, %g) m\n", a.x, a.y, a.z, b.x, b.y, b.z);
  }
  std::printf("  tree        %u nodes, %u leaves, depth %u, %.2f primitives a leaf, SAH cost %.2f\n",
              bvh.nodeCount, bvh.leafCount, bvh.depth, bvh.primitivesPerLeaf, bvh.sahCost);
  for (const StageRow& row : stageRows()) {
    const std::string reason = whyOff(row.stage, traits);
    if (!reason.empty()) std::printf("  not needed  %s (%s)\n", row.name, reason.c_str());
  }
}

}  // namespace

int runInfo(const InfoOptions& options) {
  const Scene scene = loadGltf(options.scene);
  const SceneDescription description = describe(scene);
  const BvhQuality bvh = bvhQuality(buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size())));
  for (const std::string& warning : scene.warnings) std::cerr << "fragtrace: warning: " << warning << '\n';
  const Surroundings surroundings = hasOwnLight(scene) ? Surroundings::None : Surroundings::DefaultLight;
  const TraitSet traits = traitsOf(scene, surroundings);
  if (!options.json) {
    printText(options.scene, description, bvh, traits);
    return 0;
  }
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["file"] = options.scene.string();
  json["scene"] = sceneJson(description);
  json["bvh"] = bvhJson(bvh);
  nlohmann::ordered_json notNeeded = nlohmann::ordered_json::object();
  for (const StageRow& row : stageRows()) {
    const std::string reason = whyOff(row.stage, traits);
    if (!reason.empty()) notNeeded[row.name] = reason;
  }
  json["not_needed"] = notNeeded;
  nlohmann::ordered_json materials = nlohmann::ordered_json::array();
  for (const Material& m : scene.materials) materials.push_back(m.name);
  json["material_names"] = materials;
  json["warnings"] = scene.warnings;
  std::cout << jsonText(json);
  return 0;
}

}  // namespace fragtrace
