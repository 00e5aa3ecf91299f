// SPDX-License-Identifier: MIT
#include "gltf/flatten.h"

#include <cmath>

#include "scene/tangents.h"

namespace fragtrace {
namespace {

/// Unit, or zero where there is no direction.
glm::dvec3 directionOf(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

/// How a node's matrix acts on positions, normals and tangents.
struct Transform {
  explicit Transform(const glm::dmat4& world)
      : linear(world), translation(world[3]), mirrors(glm::determinant(linear) < 0.0) {
    // The cofactors are the inverse transpose times the determinant, and exist for singular matrices too.
    const double sign = mirrors ? -1.0 : 1.0;
    normal = glm::dmat3(sign * glm::cross(linear[1], linear[2]), sign * glm::cross(linear[2], linear[0]),
                        sign * glm::cross(linear[0], linear[1]));
  }

  glm::dvec3 positionOf(const glm::vec3& p) const { return linear * glm::dvec3(p) + translation; }

  glm::vec3 normalOf(const glm::vec3& n) const {
    const glm::dvec3 direction = directionOf(normal * glm::dvec3(n));
    // Only a matrix that flattens the mesh to a line or point takes the direction away, and then no ray can
    // hit it.
    return direction == glm::dvec3(0.0) ? glm::vec3(0, 0, 1) : glm::vec3(direction);
  }

  glm::vec4 tangentOf(const glm::vec4& t, const glm::vec3& worldNormal) const {
    const glm::vec3 direction(directionOf(linear * glm::dvec3(t)));
    return {direction == glm::vec3(0.0f) ? anyPerpendicular(worldNormal) : direction, mirrors ? -t.w : t.w};
  }

  glm::dmat3 linear;
  glm::dvec3 translation;
  glm::dmat3 normal{1.0};
  bool mirrors;
};

/// Appends an attribute as it is, or the same value for each vertex of a primitive that does not have it.
template <typename Attribute>
void append(std::vector<Attribute>& to, const std::vector<Attribute>& from, size_t count,
            const Attribute& otherwise) {
  if (to.capacity() == 0) return;
  if (from.empty()) {
    to.insert(to.end(), count, otherwise);
  } else {
    to.insert(to.end(), from.begin(), from.end());
  }
}

/// Makes room for the attributes that at least one primitive has.
template <typename Attribute>
void reserveIfUsed(std::span<const PrimitiveInstance> instances, size_t total,
                   std::vector<Attribute> Vertices::*member, Vertices& vertices) {
  for (const PrimitiveInstance& instance : instances) {
    if ((instance.primitive->vertices.*member).empty()) continue;
    (vertices.*member).reserve(total);
    return;
  }
}

void appendVertices(const Vertices& from, const Transform& transform, const LocalSpace& space, Vertices& to) {
  const size_t first = to.position.size();
  const size_t count = from.position.size();
  for (const glm::vec3& position : from.position) {
    to.position.emplace_back(space.localOf(transform.positionOf(position)));
  }
  append(to.normal, from.normal, count, glm::vec3(0.0f));
  append(to.tangent, from.tangent, count, glm::vec4(0.0f));
  append(to.texcoord0, from.texcoord0, count, glm::vec2(0.0f));
  append(to.texcoord1, from.texcoord1, count, glm::vec2(0.0f));
  append(to.color, from.color, count, glm::vec4(1.0f));
  if (!from.normal.empty()) {
    for (size_t i = first; i < first + count; ++i) to.normal[i] = transform.normalOf(to.normal[i]);
  }
  if (!from.tangent.empty()) {
    for (size_t i = first; i < first + count; ++i) {
      const glm::vec3 normal = from.normal.empty() ? glm::vec3(0, 0, 1) : to.normal[i];
      to.tangent[i] = transform.tangentOf(to.tangent[i], normal);
    }
  }
}

}  // namespace

BoundsDouble boundsOf(std::span<const PrimitiveInstance> instances) {
  BoundsDouble bounds;
  for (const PrimitiveInstance& instance : instances) {
    const Transform transform(instance.world);
    for (const Triangle& triangle : instance.primitive->triangles) {
      for (int corner = 0; corner < 3; ++corner) {
        bounds.include(transform.positionOf(instance.primitive->vertices.position[triangle.vertex[corner]]));
      }
    }
  }
  return bounds;
}

void flatten(std::span<const PrimitiveInstance> instances, Scene& scene) {
  size_t vertexCount = 0;
  size_t triangleCount = 0;
  for (const PrimitiveInstance& instance : instances) {
    vertexCount += instance.primitive->vertices.position.size();
    triangleCount += instance.primitive->triangles.size();
  }
  scene.triangles.reserve(triangleCount);
  scene.vertices.position.reserve(vertexCount);
  reserveIfUsed(instances, vertexCount, &Vertices::normal, scene.vertices);
  reserveIfUsed(instances, vertexCount, &Vertices::tangent, scene.vertices);
  reserveIfUsed(instances, vertexCount, &Vertices::texcoord0, scene.vertices);
  reserveIfUsed(instances, vertexCount, &Vertices::texcoord1, scene.vertices);
  reserveIfUsed(instances, vertexCount, &Vertices::color, scene.vertices);

  for (const PrimitiveInstance& instance : instances) {
    const Transform transform(instance.world);
    const auto firstVertex = uint32_t(scene.vertices.position.size());
    const auto firstTriangle = uint32_t(scene.triangles.size());
    appendVertices(instance.primitive->vertices, transform, scene.space, scene.vertices);
    for (Triangle triangle : instance.primitive->triangles) {
      triangle.vertex += glm::uvec3(firstVertex);
      if (transform.mirrors) std::swap(triangle.vertex.y, triangle.vertex.z);
      scene.triangles.push_back(triangle);
    }
    scene.origins.push_back(
        {instance.node, instance.mesh, firstTriangle, uint32_t(instance.primitive->triangles.size())});
  }
}

}  // namespace fragtrace
