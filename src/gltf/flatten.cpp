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

/// How an instance places each of its vertices: all by its node's matrix, or each by its joints' matrices,
/// weighed and added up (glTF 2.0, section 3.7.3.3).
class Placement {
 public:
  explicit Placement(const PrimitiveInstance& instance)
      : influences_(instance.primitive->influences), joints_(instance.joints), transform_(instance.world) {
    const size_t vertexCount = instance.primitive->vertices.position.size();
    if (!joints_.empty() && vertexCount > 0) perVertex_ = influences_.size() / vertexCount;
  }

  /// Valid until the next call.
  const Transform& of(size_t vertex) {
    if (perVertex_ == 0) return transform_;
    glm::dmat4 sum(0.0);
    for (const Influence& influence : influences_.subspan(vertex * perVertex_, perVertex_)) {
      if (influence.weight != 0.0f) sum += double(influence.weight) * joints_[influence.joint];
    }
    transform_ = Transform(sum);
    return transform_;
  }

 private:
  std::span<const Influence> influences_;
  std::span<const glm::dmat4> joints_;
  size_t perVertex_ = 0;
  Transform transform_;
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

void appendVertices(const Vertices& from, Placement& placement, const LocalSpace& space, Vertices& to) {
  const size_t first = to.position.size();
  const size_t count = from.position.size();
  for (size_t i = 0; i < count; ++i) {
    to.position.emplace_back(space.localOf(placement.of(i).positionOf(from.position[i])));
  }
  append(to.normal, from.normal, count, glm::vec3(0.0f));
  append(to.tangent, from.tangent, count, glm::vec4(0.0f));
  append(to.texcoord0, from.texcoord0, count, glm::vec2(0.0f));
  append(to.texcoord1, from.texcoord1, count, glm::vec2(0.0f));
  append(to.color, from.color, count, glm::vec4(1.0f));
  if (!from.normal.empty()) {
    for (size_t i = 0; i < count; ++i) {
      glm::vec3& normal = to.normal[first + i];
      normal = placement.of(i).normalOf(normal);
    }
  }
  if (!from.tangent.empty()) {
    for (size_t i = 0; i < count; ++i) {
      const glm::vec3 normal = from.normal.empty() ? glm::vec3(0, 0, 1) : to.normal[first + i];
      glm::vec4& tangent = to.tangent[first + i];
      tangent = placement.of(i).tangentOf(tangent, normal);
    }
  }
}

}  // namespace

BoundsDouble boundsOf(std::span<const PrimitiveInstance> instances) {
  BoundsDouble bounds;
  for (const PrimitiveInstance& instance : instances) {
    Placement placement(instance);
    for (const Triangle& triangle : instance.primitive->triangles) {
      for (int corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = triangle.vertex[corner];
        bounds.include(placement.of(vertex).positionOf(instance.primitive->vertices.position[vertex]));
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
    Placement placement(instance);
    const auto firstVertex = uint32_t(scene.vertices.position.size());
    const auto firstTriangle = uint32_t(scene.triangles.size());
    appendVertices(instance.primitive->vertices, placement, scene.space, scene.vertices);
    for (Triangle triangle : instance.primitive->triangles) {
      const bool mirrors = placement.of(triangle.vertex.x).mirrors;
      triangle.vertex += glm::uvec3(firstVertex);
      if (mirrors) std::swap(triangle.vertex.y, triangle.vertex.z);
      scene.triangles.push_back(triangle);
    }
    scene.origins.push_back(
        {instance.node, instance.mesh, firstTriangle, uint32_t(instance.primitive->triangles.size())});
  }
}

}  // namespace fragtrace
