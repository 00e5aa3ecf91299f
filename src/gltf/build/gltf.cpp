// SPDX-License-Identifier: MIT
#include "gltf/gltf.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <set>

#include "base/errors.h"
#include "base/text.h"
#include "bvh/contacts.h"
#include "gltf/build/materials.h"
#include "gltf/build/meshes.h"
#include "gltf/build/nodes.h"
#include "gltf/build/placed.h"
#include "gltf/build/read_document.h"
#include "gltf/build/textures.h"
#include "scene/camera.h"
#include "scene/creases.h"
#include "scene/strokes.h"

namespace fragtrace {
namespace {

/// Refuses what 32-bit indices or the memory limit do not allow.
void takeMeshes(Document& document, const PlacedMeshes& placed) {
  size_t vertexCount = 0;
  size_t triangleCount = 0;
  const auto count = [&](const MeshPrimitive& primitive) {
    vertexCount += primitive.vertices.position.size();
    triangleCount += primitive.triangles.size();
    vertexCount += primitive.strokes.ends.size() * kMostStrokeVertices;
    triangleCount += trianglesOf(primitive.strokes);
  };
  for (const PrimitiveInstance& instance : placed.flat) count(*instance.primitive);
  for (const MeshToShare& shared : placed.shared) {
    for (const MeshPrimitive& primitive : *shared.mesh) count(primitive);
  }
  if (std::max(vertexCount, triangleCount) >= kMissIndex) {
    document.diagnostics.refuse("", std::to_string(triangleCount) + " triangles with " +
                                        std::to_string(vertexCount) +
                                        " vertices are too many for 32-bit indices");
  }
  takeMemory(document, "", placed.bytes);
}

BoundsDouble boundsOf(const std::vector<PlacedSphere>& spheres) {
  BoundsDouble bounds;
  for (const PlacedSphere& sphere : spheres) {
    bounds.include(sphere.center - glm::dvec3(sphere.radius));
    bounds.include(sphere.center + glm::dvec3(sphere.radius));
  }
  return bounds;
}

/// The place of the camera, if it is known; none: the camera frames the scene.
std::optional<glm::dvec3> cameraFor(const GltfOptions& options, const Scene& scene) {
  if (options.cameraPosition) return options.cameraPosition;
  const std::optional<int> named = cameraIndexOf({}, options.selection.camera, scene.cameras);
  const auto index = size_t(named.value_or(std::max(options.cameraIndex, 0)));
  return index < scene.cameras.size() ? std::optional(scene.cameras[index].position) : std::nullopt;
}

/// Chooses local space.
void recentre(const GltfOptions& options, const Diagnostics& diagnostics, Scene& scene) {
  const BoundsDouble& bounds = scene.bounds;
  LocalSpace& space = scene.space;
  space.origin =
      options.recenterOn ? *options.recenterOn : recentringPoint(cameraFor(options, scene), bounds);
  if (bounds.empty()) return;
  const glm::dvec3 farthest =
      glm::max(glm::abs(bounds.minimum - space.origin), glm::abs(bounds.maximum - space.origin));
  const double reach = std::max({farthest.x, farthest.y, farthest.z});
  if (!(reach <= kFarthest)) {
    diagnostics.refuse("",
                       "the scene is more than 1e30 m in size, or as far from the point it is recentred on");
  }
  // Shaders multiply up to five lengths. If the scene's largest coordinate is within these limits, triangles
  // of a ten millionth of it, and cameras a million times as far away, stay within what floats can hold.
  constexpr double kLeastReach = 0x1p-4;
  constexpr double kMostReach = 0x1p16;
  constexpr int kReachBits = 10;
  if (reach == 0.0 || (reach >= kLeastReach && reach <= kMostReach)) return;
  int exponent = 0;
  std::frexp(reach, &exponent);
  space.unit = std::ldexp(1.0, std::max(exponent, -900) - kReachBits);
}

/// Says which parts have no inside.
void warnThinned(const std::map<std::string, size_t>& thinned, Diagnostics& diagnostics) {
  for (const auto& [place, count] : thinned)
    diagnostics.warn(place,
                     "has a thickness, and is on a part that bounds no solid; such a part is drawn as a "
                     "thin wall",
                     count);
}

/// The default material was appended last, and goes again if nothing uses it.
void dropUnusedDefaultMaterial(Scene& scene, uint32_t last) {
  if (last + 1 != scene.materials.size()) return;
  const auto usesLast = [last](const auto& part) { return part.material == last; };
  if (last > 0 && std::ranges::none_of(scene.triangles, usesLast) &&
      std::ranges::none_of(scene.spheres, usesLast) && std::ranges::none_of(scene.strokes, usesLast)) {
    scene.materials.pop_back();
  }
}

std::vector<SceneNode> namedNodes(const Document& document, const std::vector<PlacedNode>& placed) {
  std::vector<SceneNode> nodes;
  nodes.reserve(placed.size());
  for (const PlacedNode& node : placed) {
    const tinygltf::Node& source = document.model.nodes[size_t(node.index)];
    nodes.push_back({nameOrPlace(source.name, "nodes", node.index), uint32_t(node.index), node.depth,
                     node.hidden, node.hiddenInFile, source.mesh >= 0 || source.extras.Has("shape"),
                     source.extensions.contains("KHR_lights_punctual"), source.camera >= 0});
  }
  return nodes;
}

/// Gives the scene its cameras and its volume, and returns its spheres: all in world space.
std::vector<PlacedSphere> takeParts(Document& document, const std::vector<PlacedNode>& nodes,
                                    bool readsVolume, Scene& scene) {
  std::vector<PlacedSphere> spheres;
  for (const PlacedNode& node : nodes) {
    Diagnostics& diagnostics = document.diagnostics;
    const auto camera = diagnostics.keepRest("the camera", [&] { return cameraAt(document, node); });
    if (camera && *camera) scene.cameras.push_back(**camera);
    if (node.hidden) continue;
    const auto sphere = diagnostics.keepRest("the sphere", [&] { return sphereAt(document, node); });
    if (sphere && *sphere) spheres.push_back(**sphere);
    std::optional<Volume> volume;
    if (readsVolume) volume = volumeAt(document, node);
    if (volume && !scene.volume.source.file.empty())
      document.diagnostics.warn(pointerTo("nodes", node.index, "extras", "fragtrace_volume"),
                                "a scene has one volume; this one is left out");
    else if (volume)
      scene.volume = std::move(*volume);
  }
  return spheres;
}

/// Takes over the warnings. Refuses a scene of which losses leave nothing, and with --strict any warning.
void settle(const Diagnostics& diagnostics, const GltfOptions& options, Scene& scene) {
  const bool isEmpty = scene.triangles.empty() && scene.spheres.empty() && scene.strokes.empty() &&
                       scene.volume.source.file.empty();
  if (isEmpty && diagnostics.firstLoss() && options.selection.hiddenNodes.empty())
    throw InputError(*diagnostics.firstLoss());
  scene.warnings = diagnostics.warnings();
  const std::vector<std::string> faults = diagnostics.warnings(true);
  if (!options.limits.strict || faults.empty()) return;
  const size_t others = faults.size() - 1;
  const std::string more = others > 0 ? ", and " + countText(others, "other warning") : "";
  throw InputError(faults[0] + " (--strict refuses it" + more + ")");
}

/// Settles what follows from where surfaces are in local space: panes, solids, what lies at one place,
/// creases.
void settleSurfaces(const std::vector<PlacedSphere>& spheres, Diagnostics& diagnostics, Scene& scene) {
  std::vector<SolidPart> parts = solidParts(scene, 0, flatTriangleCount(scene));
  warnThinned(thinOpenPanes(scene, parts), diagnostics);
  partSolids(scene, parts);
  partFromGlass(scene);
  markLampsInSurfaces(scene);
  if (scene.strokes.empty()) settleCreases(scene);  // else addStrokes() does it
  for (const PlacedSphere& sphere : spheres) {
    scene.spheres.push_back({glm::vec3(scene.space.localOf(sphere.center)),
                             float(sphere.radius / scene.space.unit), glm::quat(sphere.rotation),
                             sphere.material, sphere.node, sphere.nodeIndex});
  }
  scene.solids = solidsOf(scene);
  settleLeastAlpha(scene);
}

Scene buildScene(const std::filesystem::path& path, const GltfOptions& options,
                 std::shared_ptr<KeptDocument>* kept) {
  std::shared_ptr<KeptDocument> read = kept != nullptr ? std::move(*kept) : nullptr;
  if (!read) read = std::make_shared<KeptDocument>(readDocument(path, options));
  const bool keeps = kept != nullptr && !read->animations.empty();
  Document document = posed(*read, keeps, options);
  Scene scene;
  scene.extensionsUsed = document.model.extensionsUsed;
  scene.refersToFiles = document.refersToFiles;
  scene.made = document.made;
  scene.sceneNames = document.sceneNames;
  scene.animationNames = document.animationNames;
  scene.animationSeconds = document.animationSeconds;
  scene.materialVariants = document.materialVariants;
  scene.lightSources = lightSources(document);
  const auto suns = std::ranges::count_if(options.selection.lights, &AddedLight::isSun);
  for (LightSource& source : std::span(scene.lightSources).last(size_t(suns))) source.added = true;

  // World space.
  const std::vector<PlacedNode> nodes = placeNodes(document, options.selection);
  addMaterials(document, nodes, scene);
  makeDoubleSided(options.selection.doubleSided, scene);
  scene.nodes = namedNodes(document, nodes);
  if (options.progress) options.progress("building the meshes", 0.45);
  ShownMeshes shown = showMeshes(document, scene.materials, nodes);
  if (keeps) {
    takeBack(document, *read);
    read->keyTimes = std::move(document.keyTimes);
    // The document outlives this load, so it must not keep the progress.
    read->document.progress = {};
    read->document.access.progress = {};
    *kept = std::move(read);
  }
  document.model.buffers.clear();
  const std::vector<PlacedSphere> spheres = takeParts(document, nodes, options.readsVolume, scene);

  // Local space.
  const PlacedMeshes meshes =
      chooseSharing(std::move(shown.instances), options.instancing, scene.materials, document.memory.left());
  takeMeshes(document, meshes);
  scene.sharing = meshes.reason + (meshes.copies.empty() ? "" : "; always copied: " + meshes.copies);
  const bool isAsked = options.instancing == Instancing::Share;
  if (isAsked && (meshes.shared.empty() || !meshes.copies.empty()))
    document.diagnostics.warn(
        "", (meshes.shared.empty() ? "nothing is shared: " : "not all is shared: ") + scene.sharing);
  scene.bounds = boundsOf(meshes.flat, meshes.shared);
  scene.bounds.include(boundsOf(spheres));
  recentre(options, document.diagnostics, scene);
  flatten(meshes.flat, meshes.shared, scene);
  const auto defaultMaterial = uint32_t(scene.materials.size() - 1);
  settleSurfaces(spheres, document.diagnostics, scene);
  for (const PlacedNode& node : nodes) {
    if (node.hidden) continue;
    const auto light =
        document.diagnostics.keepRest("the light", [&] { return lightAt(document, node, scene.space); });
    if (light && *light) scene.lights.push_back(**light);
  }
  dropUnusedDefaultMaterial(scene, defaultMaterial);
  settle(document.diagnostics, options, scene);
  return scene;
}

}  // namespace

std::vector<double> keyTimesOf(const KeptDocument& document) {
  const std::set<double> times(document.keyTimes.begin(), document.keyTimes.end());
  return {times.begin(), times.end()};
}

Scene loadGltf(const std::filesystem::path& path, const GltfOptions& options,
               std::shared_ptr<KeptDocument>* kept) {
  try {
    return buildScene(path, options, kept);
  } catch (const InputError&) {
    throw;
  } catch (const UsageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(path.string() + ": not enough memory to load it");
  } catch (const std::exception& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

}  // namespace fragtrace
