// SPDX-License-Identifier: MIT
#include "gltf/build/meshes.h"

#include <algorithm>
#include <utility>

#include "gltf/build/nodes.h"

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

DecodedMesh decodeMesh(Document& document, const std::vector<Material>& materials, int mesh,
                       const MeshPose& pose) {
  DecodedMesh decoded;
  const size_t count = document.model.meshes.at(size_t(mesh)).primitives.size();
  for (size_t i = 0; i < count; ++i) {
    auto primitive = document.diagnostics.keepRest(
        "the primitive", [&] { return decodePrimitive(document, materials, mesh, int(i), pose); });
    decoded.primitives.push_back(primitive ? std::move(*primitive) : MeshPrimitive());
  }
  decoded.bounds = boundsOf(decoded.primitives);
  return decoded;
}

bool hasStrokes(const MeshPrimitive& primitive) { return !primitive.strokes.ends.empty(); }

bool hasNoInfluences(const MeshPrimitive& primitive) {
  return !primitive.empty() && primitive.influences.empty();
}

/// Drops the places where a mesh is so small that squares of its size underflow. A size of 0 is none of them:
/// files hide meshes that way.
void checkSizes(Document& document, const PlacedNode& node, const BoundsDouble& bounds,
                std::vector<glm::dmat4>& places) {
  if (bounds.empty()) return;
  const std::string place = pointerTo("nodes", node.index);
  const size_t dropped = std::erase_if(places, [&](const glm::dmat4& world) {
    const BoundsDouble placed = transformed(bounds, world);
    const glm::dvec3 farthest = glm::max(glm::abs(placed.minimum), glm::abs(placed.maximum));
    if (!(std::max({farthest.x, farthest.y, farthest.z}) <= kFarthest))
      document.diagnostics.lose(place, "its mesh reaches farther than 1e30 m from the origin");
    const glm::dvec3 extent = placed.extent();
    const double size = std::max({extent.x, extent.y, extent.z});
    return size > 0.0 && size < kSmallest;
  });
  if (dropped == 0) return;
  const bool isScaled = !document.model.nodes.at(size_t(node.index)).scale.empty();
  document.diagnostics.warn(isScaled ? place + "/scale" : place,
                            "its mesh is less than 1e-75 m in size, and left out", dropped);
}

std::vector<const PlacedNode*> byIndex(const Document& document, const std::vector<PlacedNode>& nodes) {
  std::vector<const PlacedNode*> result(document.model.nodes.size(), nullptr);
  for (const PlacedNode& node : nodes) result[size_t(node.index)] = &node;
  return result;
}

/// Adds the mesh of a node.
void showMesh(Document& document, const std::vector<Material>& materials, const PlacedNode& node,
              const std::vector<const PlacedNode*>& placed, ShownMeshes& shown) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  const tinygltf::Mesh& mesh = document.model.meshes.at(size_t(source.mesh));
  const MeshPose pose = poseOf(document, source);
  const auto [entry, isNew] = shown.decoded.try_emplace({source.mesh, pose});
  if (isNew) entry->second = decodeMesh(document, materials, source.mesh, pose);
  const DecodedMesh& decoded = entry->second;
  std::span<const glm::dmat4> joints;
  if (source.skin >= 0) {
    auto matrices = shown.joints.find(source.skin);
    if (matrices == shown.joints.end())
      matrices = shown.joints.emplace(source.skin, jointMatrices(document, node.index, placed)).first;
    joints = matrices->second;
    if (std::ranges::any_of(decoded.primitives, hasNoInfluences))
      document.diagnostics.warn(pointerTo("nodes", node.index, "skin"),
                                "has a mesh without joints and weights, which stands where its node does");
  }
  const std::string nodeName = nameOrPlace(source.name, "nodes", node.index);
  const std::string meshName = nameOrPlace(mesh.name, "meshes", source.mesh);
  std::vector<glm::dmat4> places = placesOfMesh(document, node);
  if (joints.empty()) checkSizes(document, node, decoded.bounds, places);
  takeMemory(document, pointerTo("nodes", node.index),
             places.size() * decoded.primitives.size() *
                 (sizeof(PrimitiveInstance) + nodeName.size() + meshName.size()));
  const bool mayShare = source.skin < 0 && std::ranges::none_of(decoded.primitives, hasStrokes);
  const std::vector<MeshPrimitive>* whole = mayShare ? &decoded.primitives : nullptr;
  for (const glm::dmat4& world : places) {
    for (const MeshPrimitive& primitive : decoded.primitives) {
      if (!primitive.empty())
        shown.instances.push_back(
            {&primitive, world, joints, nodeName, uint32_t(node.index), meshName, whole});
    }
  }
}

}  // namespace

ShownMeshes showMeshes(Document& document, const std::vector<Material>& materials,
                       const std::vector<PlacedNode>& nodes) {
  ShownMeshes shown;
  std::vector<const PlacedNode*> placed;
  if (!document.skins.empty()) placed = byIndex(document, nodes);
  for (const PlacedNode& node : nodes) {
    if (document.model.nodes.at(size_t(node.index)).mesh < 0 || node.hidden) continue;
    document.diagnostics.keepRest("the mesh here", [&] {
      showMesh(document, materials, node, placed, shown);
      return true;
    });
  }
  return shown;
}

}  // namespace fragtrace
