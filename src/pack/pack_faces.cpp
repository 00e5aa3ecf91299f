// SPDX-License-Identifier: MIT
#include "pack/pack_faces.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/words.h"
#include "pack/pack_tree.h"
#include "scene/hit_error.h"
#include "scene/motion/moving_scene.h"

namespace fragtrace {

namespace {

/// The upper bits of a positive float that is at least this error.
uint32_t errorBits(double error) {
  constexpr uint32_t kDropped = (1u << layout::kFloatErrorShift) - 1u;
  const uint32_t up = floatWord(std::nextafter(float(error), std::numeric_limits<float>::infinity()));
  return (up + kDropped) >> layout::kFloatErrorShift << layout::kFaceErrorShift;
}

void appendTriangle(Words& words, const Scene& scene, const Triangle& t) {
  const auto [v0, v1, v2] = cornersOf(scene, t);
  const glm::vec4 plane = planeOf(v0, v1, v2);
  const uint32_t flat = t.flat ? layout::kFaceFlat : 0u;
  const double error =
      std::max(hitPointError({v0, v1, v2}), hitPointError(cornersOf(scene, atEnd(scene, t))));
  const uint32_t word = t.material | flat | errorBits(error);
  words.insert(words.end(), {floatWord(plane.x), floatWord(plane.y), floatWord(plane.z), word,
                             floatWord(plane.w), t.vertex.x, t.vertex.y, t.vertex.z});
}

void appendSphere(Words& words, const Scene& scene, uint32_t sphere) {
  const Sphere& s = scene.spheres[sphere];
  const Sphere& end = atEnd(scene, sphere);
  // q and -q are the same rotation; the shader derives w >= 0 from the rest.
  const glm::quat q = s.rotation.w < 0.0f ? -s.rotation : s.rotation;
  const glm::vec3 reach =
      glm::max(glm::abs(s.center) + glm::vec3(s.radius), glm::abs(end.center) + glm::vec3(end.radius));
  const uint32_t word = s.material | layout::kFaceSphere | errorBits(hitPointError({reach, reach, reach}));
  words.insert(words.end(), {floatWord(q.x), floatWord(q.y), floatWord(q.z), word});
  appendRow(words, s.center, s.radius);
}

void appendInset(Words& words, const Scene& scene, uint32_t primitive) {
  if (primitive >= scene.triangles.size()) {  // a sphere, or nothing
    words.insert(words.end(), 4, 0u);
    return;
  }
  const glm::uvec3& v = scene.triangles[primitive].vertex;
  const std::vector<glm::vec3>& p = scene.vertices.position;
  const glm::dvec3 middle = (glm::dvec3(p[v.x]) + glm::dvec3(p[v.y]) + glm::dvec3(p[v.z])) / 3.0;
  appendRow(words, glm::vec3(middle), 0.0f);
  words.back() = scene.insets.empty() ? 0u : scene.insets[primitive];
}

/// Triangles of a shared mesh have the number 0: their instances have numbers.
uint32_t objectNumberOf(const Scene& scene, uint32_t primitive) {
  if (primitive == kMissIndex) return 0;
  if (primitive >= scene.triangles.size())
    return scene.spheres[primitive - scene.triangles.size()].nodeIndex + 1;
  if (primitive >= flatTriangleCount(scene)) return 0;
  const auto after = std::ranges::upper_bound(scene.origins, primitive, {}, &PrimitiveOrigin::firstTriangle);
  return std::prev(after)->nodeIndex + 1;
}

}  // namespace

glm::vec4 planeOf(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  const glm::dvec3 cross = glm::cross(glm::dvec3(v1) - glm::dvec3(v0), glm::dvec3(v2) - glm::dvec3(v0));
  const double length = glm::length(cross);
  if (length <= 0.0) return glm::vec4(0.0f);
  const glm::vec3 normal(cross / length);
  const glm::dvec3 middle = (glm::dvec3(v0) + glm::dvec3(v1) + glm::dvec3(v2)) / 3.0;
  return {normal, float(glm::dot(glm::dvec3(normal), middle))};
}

Words packFaces(const Scene& scene, const Bvh& bvh, bool creases) {
  if (scene.materials.size() > layout::kFaceMaterialMask)
    throw InputError("the scene has " + std::to_string(scene.materials.size()) + " materials, at most " +
                     std::to_string(layout::kFaceMaterialMask) + " can be drawn");
  Words words;
  const size_t slots = bvh.leaves.size() * 2;
  words.reserve(slots * (layout::kFaceRows + (creases ? 1u : 0u)) * 4);
  for (const BvhLeaf& leaf : bvh.leaves) {
    for (const uint32_t primitive : leaf.primitive) {
      if (primitive == kMissIndex) {
        words.insert(words.end(), layout::kFaceRows * 4, 0u);
      } else if (primitive < scene.triangles.size()) {
        appendTriangle(words, scene, scene.triangles[primitive]);
      } else {
        appendSphere(words, scene, primitive - uint32_t(scene.triangles.size()));
      }
    }
  }
  for (size_t slot = 0; creases && slot < slots; ++slot)
    appendInset(words, scene, bvh.leaves[slot / 2].primitive[slot % 2]);
  return words;
}

void appendObjectNumbers(const Scene& scene, const Bvh& bvh, Words& words) {
  for (const BvhLeaf& leaf : bvh.leaves) {
    for (const uint32_t primitive : leaf.primitive) words.push_back(objectNumberOf(scene, primitive));
  }
  if (!scene.instances.empty()) words.resize(words.size() + firstInstanceBlock(bvh));
  for (const Instance& instance : scene.instances) words.push_back(instance.nodeIndex + 1);
  words.resize((words.size() + 3) / 4 * 4);
}

}  // namespace fragtrace
