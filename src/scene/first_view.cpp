// SPDX-License-Identifier: MIT
#include "scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fragtrace {

namespace {

/// The sum of area * n * n^T over the triangles, n being the unit normal. Seen along d, the mean squared
/// cosine of the surfaces is d^T * sum * d / trace(sum).
struct Facing {
  glm::dmat3 sum{0.0};

  /// Adds a surface whose `normal` is as long as its area.
  void add(const glm::dvec3& normal) {
    const double area = glm::length(normal);
    if (area > 0.0) sum += glm::outerProduct(normal, normal) / area;
  }
};

Facing facingOf(const Scene& scene, size_t first, size_t count) {
  Facing facing;
  for (size_t i = first; i < first + count; ++i) {
    const auto& corner = scene.triangles[i].vertex;
    const glm::dvec3 a(scene.vertices.position[corner[0]]);
    facing.add(0.5 * glm::cross(glm::dvec3(scene.vertices.position[corner[1]]) - a,
                                glm::dvec3(scene.vertices.position[corner[2]]) - a));
  }
  return facing;
}

/// Sums up the scene without strokes, which face the camera anyway. The space is local, its axes are the
/// world's.
Facing facingOf(const Scene& scene) {
  Facing facing = facingOf(scene, 0, flatTriangleCount(scene) - scene.strokeTriangles);
  std::vector<Facing> meshes;
  for (const SharedMesh& mesh : scene.sharedMeshes)
    meshes.push_back(facingOf(scene, mesh.firstTriangle, mesh.triangleCount));
  for (const Instance& instance : scene.instances) {
    const glm::dmat3 linear(instance.toLocal);
    // The cofactors transform areas, exactly if the scale is the same along all axes.
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const double scale = std::cbrt(std::abs(glm::determinant(cofactors)));
    if (scale > 0.0) facing.sum += cofactors * meshes[instance.mesh].sum * glm::transpose(cofactors) / scale;
  }
  for (const Sphere& sphere : scene.spheres)
    facing.sum += glm::dmat3(double(sphere.radius) * sphere.radius);  // alike from all sides
  return facing;
}

/// 0 if all surfaces are seen along their edges, 1 if they face the camera.
double meanSquaredCosine(const Facing& facing, const Orbit& orbit) {
  const glm::dvec3 d = outwardsOf(orbit);
  const double trace = facing.sum[0][0] + facing.sum[1][1] + facing.sum[2][2];
  return trace > 0.0 ? glm::dot(d, facing.sum * d) / trace : 1.0;
}

}  // namespace

Orbit firstView(const Scene& scene) {
  // The limit for a view along the edge: 14 degrees or less to the surface. A level floor is seen at 20.
  constexpr double kEdge = 0.06;
  constexpr std::array<Orbit, 3> kOthers{
      {{.azimuthDegrees = -kFirstView.azimuthDegrees, .elevationDegrees = kFirstView.elevationDegrees},
       {.azimuthDegrees = kFirstView.azimuthDegrees, .elevationDegrees = 55.0},
       {.azimuthDegrees = 180.0 + kFirstView.azimuthDegrees,
        .elevationDegrees = kFirstView.elevationDegrees}}};
  const Facing facing = facingOf(scene);
  const auto seen = [&](const Orbit& orbit) { return meanSquaredCosine(facing, orbit); };
  return seen(kFirstView) >= kEdge ? kFirstView : *std::ranges::max_element(kOthers, {}, seen);
}

CameraOverrides settledOverrides(CameraOverrides asked, const Scene& scene) {
  const bool fits = asked.asksForFit();
  const bool isChosen = asked.fit || asked.fitShadow || !asked.fitTo.empty();
  asked.fit = fits;
  if (!scene.cameras.empty() || asked.position || asked.orbit) return asked;
  if (asked.type == CameraType::Panorama) {
    asked.position = scene.bounds.empty() ? glm::dvec3(0.0) : scene.bounds.center();
    return asked;
  }
  asked.orbit = firstView(scene);
  if (asked.type == CameraType::Fisheye) return asked;
  asked.fit = fits || (!asked.focalPoint && !asked.parallelScale);
  asked.leavesStrays = asked.fit && !isChosen;
  return asked;
}

}  // namespace fragtrace
