// SPDX-License-Identifier: MIT
#include "gltf/gltf.h"

#include <algorithm>
#include <map>
#include <new>

#include "errors.h"
#include "gltf/document.h"
#include "gltf/flatten.h"
#include "gltf/materials.h"
#include "gltf/nodes.h"
#include "gltf/placed.h"
#include "gltf/primitives.h"

namespace fragtrace {
namespace {

using DecodedMeshes = std::map<int, std::vector<MeshPrimitive>>;

/// Decodes each mesh once, however many nodes show it.
std::vector<PrimitiveInstance> placeMeshes(Document& document, const std::vector<Material>& materials,
                                           const std::vector<PlacedNode>& nodes, DecodedMeshes& decoded) {
  std::vector<PrimitiveInstance> instances;
  size_t vertexCount = 0;
  size_t triangleCount = 0;
  for (const PlacedNode& node : nodes) {
    const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
    if (source.mesh < 0) continue;
    if (source.skin >= 0) {
      document.diagnostics.warn(pointerTo("nodes", node.index, "skin"), "skins are not applied");
    }
    const tinygltf::Mesh& mesh = document.model.meshes.at(size_t(source.mesh));
    const auto [entry, isNew] = decoded.try_emplace(source.mesh);
    for (size_t i = 0; isNew && i < mesh.primitives.size(); ++i) {
      entry->second.push_back(decodePrimitive(document, materials, source.mesh, int(i)));
    }
    for (const MeshPrimitive& primitive : entry->second) {
      if (primitive.triangles.empty()) continue;
      instances.push_back({&primitive, node.world, nameOrPlace(source.name, "nodes", node.index),
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
  return instances;
}

BoundsDouble boundsOf(const std::vector<PlacedSphere>& spheres) {
  BoundsDouble bounds;
  for (const PlacedSphere& sphere : spheres) {
    bounds.include(sphere.center - glm::dvec3(sphere.radius));
    bounds.include(sphere.center + glm::dvec3(sphere.radius));
  }
  return bounds;
}

/// Chooses the origin and sees to it that single precision can hold the scene around it.
void recentre(const GltfOptions& options, const Diagnostics& diagnostics, Scene& scene) {
  const BoundsDouble& bounds = scene.bounds;
  scene.origin = options.recenterOn.value_or(bounds.empty() ? glm::dvec3(0.0) : bounds.center());
  if (bounds.empty()) return;
  // Shaders multiply up to four lengths (a squared area), which must stay below the largest float, about
  // 3e38.
  constexpr double kLargestCoordinate = 1e9;
  const glm::dvec3 farthest =
      glm::max(glm::abs(bounds.minimum - scene.origin), glm::abs(bounds.maximum - scene.origin));
  if (!(std::max({farthest.x, farthest.y, farthest.z}) <= kLargestCoordinate)) {
    diagnostics.refuse("",
                       "the scene is more than 1e9 m in size, or as far from the point it is recentred on");
  }
}

/// The default material was appended last, and goes again if nothing uses it.
void dropUnusedDefaultMaterial(Scene& scene) {
  const auto last = uint32_t(scene.materials.size() - 1);
  const auto usesLast = [last](const auto& part) { return part.material == last; };
  if (last > 0 && std::none_of(scene.triangles.begin(), scene.triangles.end(), usesLast) &&
      std::none_of(scene.spheres.begin(), scene.spheres.end(), usesLast)) {
    scene.materials.pop_back();
  }
}

Scene buildScene(const std::filesystem::path& path, const GltfOptions& options) {
  Document document = readDocument(path);
  Scene scene;
  scene.extensionsUsed = document.model.extensionsUsed;
  addMaterials(document, scene);

  // What nodes place, in world space.
  const std::vector<PlacedNode> nodes = placeNodes(document);
  DecodedMeshes decoded;
  const std::vector<PrimitiveInstance> instances = placeMeshes(document, scene.materials, nodes, decoded);
  document.model.buffers.clear();
  std::vector<PlacedSphere> spheres;
  for (const PlacedNode& node : nodes) {
    if (const auto camera = cameraAt(document, node)) scene.cameras.push_back(*camera);
    if (const auto sphere = sphereAt(document, node)) spheres.push_back(*sphere);
  }

  // Local space.
  scene.bounds = boundsOf(instances);
  scene.bounds.include(boundsOf(spheres));
  recentre(options, document.diagnostics, scene);
  flatten(instances, scene);
  for (const PlacedSphere& sphere : spheres) {
    scene.spheres.push_back({glm::vec3(sphere.center - scene.origin), float(sphere.radius),
                             glm::quat(sphere.rotation), sphere.material, sphere.node});
  }
  for (const PlacedNode& node : nodes) {
    if (const auto light = lightAt(document, node, scene.origin)) scene.lights.push_back(*light);
  }
  dropUnusedDefaultMaterial(scene);
  scene.warnings = document.diagnostics.warnings();
  return scene;
}

}  // namespace

Scene loadGltf(const std::filesystem::path& path, const GltfOptions& options) {
  try {
    return buildScene(path, options);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(path.string() + ": not enough memory to load it");
  } catch (const std::exception& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

}  // namespace fragtrace
