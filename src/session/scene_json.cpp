// SPDX-License-Identifier: MIT
#include "session/scene_json.h"

namespace fragtrace {

namespace {

nlohmann::ordered_json vectorJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

nlohmann::ordered_json sceneJson(const SceneDescription& s) {
  nlohmann::ordered_json json;
  json["triangles"] = s.triangles;
  json["vertices"] = s.vertices;
  json["spheres"] = s.spheres;
  json["points"] = s.points;
  json["lines"] = s.lines;
  json["instances"] = s.instances;
  json["instancing"] = {{"shared_meshes", s.sharedMeshes},
                        {"instances", s.sharedInstances},
                        {"triangles_drawn", s.trianglesDrawn},
                        {"reason", s.sharing}};
  json["materials"] = s.materials;
  json["textures"] = s.textures;
  json["images"] = s.images;
  json["image_bytes"] = s.imageBytes;
  if (s.volumeBricks > 0) json["volume_bricks"] = s.volumeBricks;
  json["lights"] = {{"point", s.pointLights}, {"spot", s.spotLights}, {"directional", s.directionalLights}};
  json["cameras"] = {{"perspective", s.perspectiveCameras}, {"orthographic", s.orthographicCameras}};
  json["emissive_triangles"] = s.emissiveTriangles;
  json["emissive_spheres"] = s.emissiveSpheres;
  json["extensions"] = s.extensionsUsed;
  if (s.bounds.empty()) {
    json["bounds"] = nullptr;
  } else {
    json["bounds"] = {{"min", vectorJson(s.bounds.minimum)}, {"max", vectorJson(s.bounds.maximum)}};
  }
  json["origin"] = vectorJson(s.origin);
  return json;
}

nlohmann::ordered_json bvhJson(const BvhQuality& bvh) {
  nlohmann::ordered_json json;
  json["nodes"] = bvh.nodeCount;
  if (bvh.meshNodeCount > 0) json["mesh_nodes"] = bvh.meshNodeCount;
  json["leaves"] = bvh.leafCount;
  json["depth"] = bvh.depth;
  json["primitives_per_leaf"] = bvh.primitivesPerLeaf;
  json["sah_cost"] = bvh.sahCost;
  return json;
}

std::string jsonText(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace fragtrace
