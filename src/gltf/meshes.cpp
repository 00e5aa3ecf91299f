// SPDX-License-Identifier: MIT
#include "gltf/meshes.h"

#include "gltf/instancing.h"

namespace fragtrace {
namespace {

/// The node's weights, else the mesh's (glTF 2.0, section 3.7.2.2), and the joints of its skin.
MeshPose poseOf(const Document& document, const tinygltf::Node& node) {
  MeshPose pose;
  const tinygltf::Mesh& mesh = document.model.meshes.at(size_t(node.mesh));
  pose.weights = !node.weights.empty() ? node.weights : mesh.weights;
  while (!pose.weights.empty() && pose.weights.back() == 0.0) pose.weights.pop_back();
  if (node.skin >= 0) pose.jointCount = document.skins.at(size_t(node.skin)).joints.size();
  return pose;
}

std::vector<const PlacedNode*> byIndex(const Document& document, const std::vector<PlacedNode>& nodes) {
  std::vector<const PlacedNode*> result(document.model.nodes.size(), nullptr);
  for (const PlacedNode& node : nodes) result[size_t(node.index)] = &node;
  return result;
}

}  // namespace

ShownMeshes showMeshes(Document& document, const std::vector<Material>& materials,
                       const std::vector<PlacedNode>& nodes) {
  ShownMeshes shown;
  std::vector<const PlacedNode*> placed;
  if (!document.skins.empty()) placed = byIndex(document, nodes);
  for (const PlacedNode& node : nodes) {
    const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
    if (source.mesh < 0) continue;
    const tinygltf::Mesh& mesh = document.model.meshes.at(size_t(source.mesh));
    const MeshPose pose = poseOf(document, source);
    const auto [entry, isNew] = shown.decoded.try_emplace({source.mesh, pose});
    for (size_t i = 0; isNew && i < mesh.primitives.size(); ++i)
      entry->second.push_back(decodePrimitive(document, materials, source.mesh, int(i), pose));
    std::span<const glm::dmat4> joints;
    if (source.skin >= 0) {
      const auto [matrices, isFirst] = shown.joints.try_emplace(source.skin);
      if (isFirst) matrices->second = jointMatrices(document, node.index, placed);
      joints = matrices->second;
    }
    const std::string nodeName = nameOrPlace(source.name, "nodes", node.index);
    const std::string meshName = nameOrPlace(mesh.name, "meshes", source.mesh);
    const std::vector<glm::dmat4> places = placesOfMesh(document, node);
    takeMemory(document, pointerTo("nodes", node.index),
               places.size() * entry->second.size() *
                   (sizeof(PrimitiveInstance) + nodeName.size() + meshName.size()));
    const std::vector<MeshPrimitive>* whole = source.skin < 0 ? &entry->second : nullptr;
    for (const glm::dmat4& world : places) {
      for (const MeshPrimitive& primitive : entry->second) {
        if (!primitive.triangles.empty())
          shown.instances.push_back({&primitive, world, joints, nodeName, meshName, whole});
      }
    }
  }
  return shown;
}

}  // namespace fragtrace
