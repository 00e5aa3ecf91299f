// SPDX-License-Identifier: MIT
#include "pack/textures/texel_density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace fragtrace {
namespace {

constexpr double kLeast = 1e-6;  // of the largest density

/// The surfaces of a material.
struct Shown {
  double area = 0.0;                          ///< in local space
  std::array<double, 2> texcoords{0.0, 0.0};  ///< the areas in both sets of texture coordinates
};

double crossed(const glm::dvec2& a, const glm::dvec2& b) { return std::abs(a.x * b.y - a.y * b.x); }

void addTriangles(const Scene& scene, size_t first, size_t count, double areaScale, double copies,
                  std::vector<Shown>& shown) {
  const std::array sets{&scene.vertices.texcoord0, &scene.vertices.texcoord1};
  for (size_t i = first; i < first + count; ++i) {
    const Triangle& t = scene.triangles[i];
    const auto [a, b, c] = cornersOf<glm::dvec3>(scene, t);
    shown[t.material].area += areaScale * 0.5 * glm::length(glm::cross(b - a, c - a));
    for (size_t set = 0; set < sets.size(); ++set) {
      if (sets[set]->empty()) continue;
      const auto at = [&](uint32_t vertex) { return glm::dvec2((*sets[set])[vertex]); };
      const glm::dvec2 corner = at(t.vertex.x);
      shown[t.material].texcoords[set] +=
          copies * 0.5 * crossed(at(t.vertex.y) - corner, at(t.vertex.z) - corner);
    }
  }
}

std::vector<Shown> shownByMaterial(const Scene& scene) {
  std::vector<Shown> shown(scene.materials.size());
  addTriangles(scene, 0, flatTriangleCount(scene), 1.0, 1.0, shown);
  std::vector<std::pair<double, double>> copies(scene.sharedMeshes.size());  // scale of areas, number
  for (const Instance& instance : scene.instances) {
    copies[instance.mesh].first +=
        std::pow(std::abs(glm::determinant(glm::dmat3(instance.toLocal))), 2.0 / 3.0);
    copies[instance.mesh].second += 1.0;
  }
  for (size_t i = 0; i < copies.size(); ++i) {
    const SharedMesh& mesh = scene.sharedMeshes[i];
    addTriangles(scene, mesh.firstTriangle, mesh.triangleCount, copies[i].first, copies[i].second, shown);
  }
  for (const Sphere& sphere : scene.spheres) {
    shown[sphere.material].area += 4.0 * glm::pi<double>() * double(sphere.radius) * double(sphere.radius);
    shown[sphere.material].texcoords[0] += 1.0;
  }
  return shown;
}

}  // namespace

TexelDensities texelDensities(const Scene& scene) {
  std::vector<double> areas(scene.images.size(), 0.0), texels(scene.images.size(), 0.0);
  const std::vector<Shown> shown = shownByMaterial(scene);
  for (size_t i = 0; i < shown.size(); ++i) {
    for (const TextureRefRow& row : kTextureRefs) {
      const TextureRef& ref = scene.materials[i].*row.ref;
      const uint32_t image = ref.present() ? scene.textures[ref.texture].image : kMissIndex;
      if (image == kMissIndex) continue;
      const EncodedImage& picture = scene.images[image];
      const double scale = crossed(glm::dvec2(ref.transform.u), glm::dvec2(ref.transform.v));
      areas[image] += shown[i].area;
      texels[image] +=
          shown[i].texcoords[ref.texcoord] * scale * double(picture.width) * double(picture.height);
    }
  }
  TexelDensities result;
  result.ofImage.assign(areas.size(), std::numeric_limits<double>::infinity());
  for (size_t i = 0; i < areas.size(); ++i) {
    const double density = std::sqrt(texels[i] / areas[i]);
    if (density >= 0.0) result.ofImage[i] = density;  // not where both are 0, or no numbers
    if (std::isfinite(result.ofImage[i])) result.largest = std::max(result.largest, result.ofImage[i]);
  }
  for (double& density : result.ofImage) density = std::max(density, result.largest * kLeast);
  return result;
}

}  // namespace fragtrace
