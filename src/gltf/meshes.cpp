// SPDX-License-Identifier: MIT
#include "gltf/meshes.h"

#include <algorithm>

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
  size_t vertexCount = 0;
  size_t triangleCount = 0;
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
    for (const MeshPrimitive& primitive : entry->second) {
      if (primitive.triangles.empty()) continue;
      shown.instances.push_back({&primitive, node.world, joints,
                                 nameOrPlace(source.name, "nodes", node.index),
                                 nameOrPlace(mesh.name, "meshes", source.mesh)});
      vertexCount += primitive.vertices.position.size();
      triangleCount += primitive.triangles.size();
    }
  }
  if (std::max(vertexCount, triangleCount) >= kMissIndex) {
    document.diagnostics.refuse("", std::to_string(triangleCount) + " triangles with " +
                                        std::to_string(vertexCount) +
                                        " vertices are too many for 32-bit indices");
  }
  // The scene's own copy, the tree over it, and what is packed for the device, which are not all there at
  // once.
  constexpr uint64_t kBytesOfAVertex = 100;
  constexpr uint64_t kBytesOfATriangle = 150;
  takeMemory(document, "", vertexCount * kBytesOfAVertex + triangleCount * kBytesOfATriangle);
  return shown;
}

}  // namespace fragtrace
