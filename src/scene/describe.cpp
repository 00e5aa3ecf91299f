// SPDX-License-Identifier: MIT
#include "scene/describe.h"

#include <algorithm>

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

}  // namespace fragtrace
