// SPDX-License-Identifier: MIT
#include "scene/describe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/text.h"

namespace fragtrace {

SceneDescription describe(const Scene& scene) {
  SceneDescription result;
  result.triangles = scene.triangles.size();
  result.vertices = scene.vertices.position.size();
  result.spheres = scene.spheres.size();
  for (const Strokes& strokes : scene.strokes) {
    const auto points =
        size_t(std::ranges::count_if(strokes.ends, [](const glm::uvec2& ends) { return ends.x == ends.y; }));
    result.points += points;
    result.lines += strokes.ends.size() - points;
  }
  result.sharedMeshes = scene.sharedMeshes.size();
  result.sharedInstances = scene.instances.size();
  result.sharing = scene.sharing;
  std::vector<size_t> primitives(scene.sharedMeshes.size(), 0);
  for (const PrimitiveOrigin& origin : scene.origins) {
    if (origin.firstTriangle < flatTriangleCount(scene)) {
      ++result.instances;
      continue;
    }
    const auto after =
        std::ranges::upper_bound(scene.sharedMeshes, origin.firstTriangle, {}, &SharedMesh::firstTriangle);
    ++primitives[size_t(after - scene.sharedMeshes.begin()) - 1];
  }
  result.trianglesDrawn = flatTriangleCount(scene);
  for (const Instance& instance : scene.instances) {
    result.instances += primitives[instance.mesh];
    result.trianglesDrawn += scene.sharedMeshes[instance.mesh].triangleCount;
  }
  result.materials = scene.materials.size();
  result.textures = scene.textures.size();
  result.images = scene.images.size();
  for (const EncodedImage& image : scene.images) {
    result.imageBytes += image.bytes.size();
    result.texelBytes += texelBytes(image);
  }
  if (scene.volume.grid) result.volumeBricks = scene.volume.grid->values.size() / kBrickVoxels;
  const auto lights = [&scene](LightType type) {
    return size_t(std::ranges::count(scene.lights, type, &Light::type));
  };
  result.pointLights = lights(LightType::Point);
  result.spotLights = lights(LightType::Spot);
  result.directionalLights = lights(LightType::Directional);
  for (const Camera& camera : scene.cameras) {
    ++(camera.type == CameraType::Perspective ? result.perspectiveCameras : result.orthographicCameras);
  }
  const auto shines = [&scene](const auto& primitive) {
    const Material& material = scene.materials.at(primitive.material);
    return material.emissive() && !material.unlit;
  };
  result.emissiveTriangles = size_t(std::count_if(scene.triangles.begin(), scene.triangles.end(), shines));
  result.emissiveSpheres = size_t(std::count_if(scene.spheres.begin(), scene.spheres.end(), shines));
  result.extensionsUsed = scene.extensionsUsed;
  result.bounds = scene.bounds;
  result.origin = scene.space.origin;
  return result;
}

// Sentences about scenes of which little or nothing is seen.

namespace {

constexpr size_t kSamples = 16384;
constexpr double kStrays = 0.01;  // part of the triangles
constexpr double kFar = 100.0;    // diagonals of the box of the others

/// Triangles that a node draws.
struct Piece {
  const std::string& node;
  uint32_t nodeIndex;
  size_t first;
  size_t count;
  const glm::dmat4& toLocal;
};

const glm::dmat4 kUnmoved(1.0);

std::vector<Piece> piecesOf(const Scene& scene) {
  std::vector<Piece> pieces;
  for (const PrimitiveOrigin& origin : scene.origins) {
    if (origin.firstTriangle >= flatTriangleCount(scene)) break;  // a shared mesh, which instances draw
    pieces.push_back({origin.node, origin.nodeIndex, origin.firstTriangle, origin.triangleCount, kUnmoved});
  }
  for (const Instance& instance : scene.instances) {
    const SharedMesh& mesh = scene.sharedMeshes[instance.mesh];
    pieces.push_back(
        {instance.node, instance.nodeIndex, mesh.firstTriangle, mesh.triangleCount, instance.toLocal});
  }
  return pieces;
}

glm::dvec3 firstCorner(const Scene& scene, const Piece& piece, size_t triangle) {
  const uint32_t vertex = scene.triangles[piece.first + triangle].vertex.x;
  return glm::dvec3(piece.toLocal * glm::dvec4(glm::dvec3(scene.vertices.position[vertex]), 1.0));
}

/// The shortest interval that holds nearly all of these numbers.
glm::dvec2 nearlyAll(std::vector<double> values) {
  std::ranges::sort(values);
  const auto strays = size_t(kStrays * double(values.size()));
  glm::dvec2 shortest(values.front(), values.back());
  for (size_t below = 0; below <= strays; ++below) {
    const glm::dvec2 interval(values[below], values[values.size() - 1 - strays + below]);
    if (interval.y - interval.x < shortest.y - shortest.x) shortest = interval;
  }
  return shortest;
}

/// The box of nearly all triangles, in local space, by a vertex of each.
BoundsDouble boxOfMost(const Scene& scene, const std::vector<Piece>& pieces, size_t triangles) {
  const size_t step = (triangles + kSamples - 1) / kSamples;
  std::array<std::vector<double>, 3> places;
  size_t next = 0;
  for (const Piece& piece : pieces) {
    for (; next < piece.count; next += step) {
      const glm::dvec3 place = firstCorner(scene, piece, next);
      for (int axis = 0; axis < 3; ++axis) places[size_t(axis)].push_back(place[axis]);
    }
    next -= piece.count;
  }
  BoundsDouble box;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec2 interval = nearlyAll(std::move(places[size_t(axis)]));
    box.minimum[axis] = interval.x;
    box.maximum[axis] = interval.y;
  }
  return box;
}

}  // namespace

bool hasNoArea(const Scene& scene) {
  if (!scene.spheres.empty() || !scene.strokes.empty() || scene.bounds.empty() ||
      !scene.volume.source.file.empty())
    return false;
  const glm::dvec3 extent = scene.bounds.extent();
  return (extent.x == 0.0) + (extent.y == 0.0) + (extent.z == 0.0) >= 2;
}

std::string whyEmpty(const Scene& scene, const SceneSelection& selection) {
  if (hasNoArea(scene))
    return "all triangles lie in one point or line, such as by a scale of 0: nothing to draw";
  if (!scene.triangles.empty() || !scene.spheres.empty() || !scene.strokes.empty() || scene.volume.grid)
    return "";
  return std::string("no triangle, sphere, point or line: ") +
         (selection.hiddenNodes.empty() ? "nothing to draw" : "--hide leaves nothing to draw");
}

std::vector<std::string> setInVain(const Scene& scene, const SceneSelection& selection) {
  std::vector<std::string> places;
  if (selection.set.empty()) return places;
  std::vector<bool> isDrawn(scene.materials.size());
  const auto note = [&](const auto& drawn) { isDrawn[drawn.material] = true; };
  std::ranges::for_each(scene.triangles, note);
  std::ranges::for_each(scene.spheres, note);
  std::ranges::for_each(scene.strokes, note);
  for (const SetNumber& set : selection.set) {
    for (size_t i = 0; i < isDrawn.size(); ++i) {
      const std::string& place = scene.materials[i].place;
      if (!isDrawn[i] && !place.empty() && set.pointer.starts_with(place + "/"))
        places.push_back(set.pointer + ": nothing that is drawn has this material");
    }
    for (size_t i = 0; i < scene.lightSources.size(); ++i) {
      const bool isPlaced = std::ranges::find(scene.lights, i, &Light::source) != scene.lights.end();
      if (!isPlaced && set.pointer.starts_with(formatted("/extensions/KHR_lights_punctual/lights/%zu/", i)))
        places.push_back(set.pointer + ": no node that is shown has this light");
    }
  }
  return places;
}

std::string strayNode(const Scene& scene) {
  const std::vector<Piece> pieces = piecesOf(scene);
  size_t triangles = 0;
  for (const Piece& piece : pieces) triangles += piece.count;
  if (double(triangles) * kStrays < 1.0) return "";
  const BoundsDouble most = boxOfMost(scene, pieces, triangles);
  const double size = glm::length(most.extent());
  if (!(size > 0.0) || glm::length(scene.bounds.extent()) < kFar * size * scene.space.unit) return "";
  // More than triangles may be in the scene's box, such as a volume.
  const Piece* stray = nullptr;
  double farthest = 0.5 * kFar * size;
  for (const Piece& piece : pieces) {
    for (size_t i = 0; i < piece.count; ++i) {
      for (const glm::dvec3& corner : cornersOf<glm::dvec3>(scene, scene.triangles[piece.first + i])) {
        const glm::dvec3 place(piece.toLocal * glm::dvec4(corner, 1.0));
        const double distance = glm::distance(place, most.center());
        if (distance <= farthest) continue;
        farthest = distance;
        stray = &piece;
      }
    }
  }
  if (stray == nullptr) return "";
  size_t ofNode = 0;
  for (const Piece& piece : pieces) ofNode += piece.nodeIndex == stray->nodeIndex ? piece.count : 0;
  const bool small = double(ofNode) <= kStrays * double(triangles);
  constexpr double kManyDigits = 1e6;
  const double times = farthest / (0.5 * size);
  return "node " + inQuotes(stray->node) + " reaches " +
         (times < kManyDigits ? std::to_string(std::lround(times)) : shortText(times)) +
         " times as far as 99 % of the triangles, which are a dot where the whole scene is framed" +
         (small ? "; --hide " + std::to_string(stray->nodeIndex) + " leaves the node out"
                : ": a vertex of its mesh lies far off");
}

}  // namespace fragtrace
