// SPDX-License-Identifier: MIT
#include "gltf/build/flatten.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/vectors.h"
#include "scene/tangents.h"

namespace fragtrace {
namespace {

/// Unit, or zero where there is no direction.
glm::dvec3 directionOf(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

/// The action of a node's matrix on positions, normals and tangents.
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

/// Places the vertices of an instance: all by its node's matrix, or each by its joints' matrices,
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
void reserveIfUsed(std::span<const MeshPrimitive* const> primitives, size_t total,
                   std::vector<Attribute> Vertices::*member, Vertices& vertices) {
  for (const MeshPrimitive* primitive : primitives) {
    if ((primitive->vertices.*member).empty()) continue;
    (vertices.*member).reserve(total);
    return;
  }
}

void reserveAll(std::span<const MeshPrimitive* const> primitives, Scene& scene) {
  size_t vertexCount = 0;
  size_t triangleCount = 0;
  for (const MeshPrimitive* primitive : primitives) {
    vertexCount += primitive->vertices.position.size();
    triangleCount += primitive->triangles.size();
  }
  scene.triangles.reserve(triangleCount);
  scene.vertices.position.reserve(vertexCount);
  reserveIfUsed(primitives, vertexCount, &Vertices::normal, scene.vertices);
  reserveIfUsed(primitives, vertexCount, &Vertices::tangent, scene.vertices);
  reserveIfUsed(primitives, vertexCount, &Vertices::texcoord0, scene.vertices);
  reserveIfUsed(primitives, vertexCount, &Vertices::texcoord1, scene.vertices);
  reserveIfUsed(primitives, vertexCount, &Vertices::color, scene.vertices);
}

void appendVertices(const Vertices& from, Placement& placement, const LocalSpace& space, Vertices& to) {
  const size_t first = to.position.size();
  const size_t count = from.position.size();
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 position(space.localOf(placement.of(i).positionOf(from.position[i])));
    // The scene's size is that of its triangles; what none of them uses may be anywhere.
    to.position.push_back(isFinite(position) ? position : glm::vec3(0.0f));
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

/// Calls use(vertex) for each corner of a triangle and end of a line.
template <typename Use>
void forEachCorner(const MeshPrimitive& primitive, const Use& use) {
  for (const Triangle& triangle : primitive.triangles) {
    for (int corner = 0; corner < 3; ++corner) use(triangle.vertex[corner]);
  }
  for (const glm::uvec2& ends : primitive.strokes.ends) {
    use(ends.x);
    use(ends.y);
  }
}

/// Appends an instance's strokes, but none if it is scaled to a single point: files hide things in this way.
void appendStrokes(const PrimitiveInstance& instance, uint32_t firstVertex, Scene& scene) {
  if (instance.joints.empty() && glm::dmat3(instance.world) == glm::dmat3(0.0)) return;
  Strokes& strokes = scene.strokes.emplace_back(instance.primitive->strokes);
  strokes.node = instance.node;
  strokes.mesh = instance.mesh;
  strokes.nodeIndex = instance.nodeIndex;
  for (glm::uvec2& ends : strokes.ends) ends += glm::uvec2(firstVertex);
}

void appendPrimitive(const PrimitiveInstance& instance, const LocalSpace& space, Scene& scene) {
  Placement placement(instance);
  const auto firstVertex = uint32_t(scene.vertices.position.size());
  const auto firstTriangle = uint32_t(scene.triangles.size());
  appendVertices(instance.primitive->vertices, placement, space, scene.vertices);
  if (!instance.primitive->strokes.ends.empty()) return appendStrokes(instance, firstVertex, scene);
  for (Triangle triangle : instance.primitive->triangles) {
    const bool mirrors = placement.of(triangle.vertex.x).mirrors;
    triangle.vertex += glm::uvec3(firstVertex);
    if (mirrors) std::swap(triangle.vertex.y, triangle.vertex.z);
    scene.triangles.push_back(triangle);
  }
  scene.origins.push_back({instance.node, instance.mesh, firstTriangle,
                           uint32_t(instance.primitive->triangles.size()), instance.nodeIndex});
}

/// Appends the positions that triangles use, each once.
void appendUsed(const MeshPrimitive& primitive, std::vector<glm::vec3>& points) {
  std::vector<bool> isUsed(primitive.vertices.position.size(), false);
  forEachCorner(primitive, [&](uint32_t vertex) {
    if (!isUsed[vertex]) points.push_back(primitive.vertices.position[vertex]);
    isUsed[vertex] = true;
  });
}

bool contains(const BoundsDouble& box, const BoundsDouble& other) {
  return glm::all(glm::lessThanEqual(box.minimum, other.minimum)) &&
         glm::all(glm::greaterThanEqual(box.maximum, other.maximum));
}

/// The space of a shared mesh: its middle is the origin, and no coordinate is above 1. Sizes are powers of
/// two, so that only the move rounds.
LocalSpace spaceOf(const std::vector<MeshPrimitive>& mesh) {
  const BoundsDouble box = boundsOf(mesh);
  const glm::dvec3 half = 0.5 * box.extent();
  int exponent = 0;
  std::frexp(std::max({half.x, half.y, half.z}), &exponent);
  return {box.center(), std::ldexp(1.0, exponent)};
}

void appendShared(const MeshToShare& shared, Scene& scene) {
  const LocalSpace space = spaceOf(*shared.mesh);
  const auto mesh = uint32_t(scene.sharedMeshes.size());
  const auto firstTriangle = uint32_t(scene.triangles.size());
  for (const MeshPrimitive& primitive : *shared.mesh) {
    if (primitive.triangles.empty()) continue;
    PrimitiveInstance own;
    own.primitive = &primitive;
    own.mesh = shared.name;
    appendPrimitive(own, space, scene);
  }
  scene.sharedMeshes.push_back({firstTriangle, uint32_t(scene.triangles.size()) - firstTriangle});
  for (const MeshToShare::Place& place : shared.places) {
    const glm::dmat3 linear = glm::dmat3(place.world) * (space.unit / scene.space.unit);
    const glm::dvec3 middle(place.world * glm::dvec4(space.origin, 1.0));
    glm::dmat4 toLocal(linear);
    toLocal[3] = glm::dvec4(scene.space.localOf(middle), 1.0);
    scene.instances.push_back({toLocal, mesh, place.node, place.nodeIndex});
  }
}

}  // namespace

BoundsDouble boundsOf(const std::vector<MeshPrimitive>& mesh) {
  Bounds box;
  for (const MeshPrimitive& primitive : mesh)
    forEachCorner(primitive, [&](uint32_t vertex) { box.include(primitive.vertices.position[vertex]); });
  return {glm::dvec3(box.minimum), glm::dvec3(box.maximum)};
}

BoundsDouble transformed(const BoundsDouble& box, const glm::dmat4& matrix) {
  BoundsDouble result;
  for (unsigned i = 0; i < 8; ++i) {
    const glm::dvec3 corner((i & 1u) != 0 ? box.maximum.x : box.minimum.x,
                            (i & 2u) != 0 ? box.maximum.y : box.minimum.y,
                            (i & 4u) != 0 ? box.maximum.z : box.minimum.z);
    result.include(glm::dvec3(matrix * glm::dvec4(corner, 1.0)));
  }
  return result;
}

BoundsDouble boundsOf(std::span<const PrimitiveInstance> instances, std::span<const MeshToShare> shared) {
  BoundsDouble bounds;
  for (const PrimitiveInstance& instance : instances) {
    Placement placement(instance);
    forEachCorner(*instance.primitive, [&](uint32_t vertex) {
      bounds.include(placement.of(vertex).positionOf(instance.primitive->vertices.position[vertex]));
    });
  }
  for (const MeshToShare& mesh : shared) {
    std::vector<glm::vec3> points;
    for (const MeshPrimitive& primitive : *mesh.mesh) appendUsed(primitive, points);
    BoundsDouble box;
    for (const glm::vec3& point : points) box.include(glm::dvec3(point));
    for (const MeshToShare::Place& place : mesh.places) {
      const Transform transform(place.world);
      // Most instances lie between others; only the outer ones are looked at closely.
      if (contains(bounds, transformed(box, place.world))) continue;
      for (const glm::vec3& point : points) bounds.include(transform.positionOf(point));
    }
  }
  return bounds;
}

void flatten(std::span<const PrimitiveInstance> instances, std::span<const MeshToShare> shared,
             Scene& scene) {
  std::vector<const MeshPrimitive*> primitives;
  primitives.reserve(instances.size());
  for (const PrimitiveInstance& instance : instances) primitives.push_back(instance.primitive);
  size_t places = 0;
  for (const MeshToShare& mesh : shared) {
    for (const MeshPrimitive& primitive : *mesh.mesh) primitives.push_back(&primitive);
    places += mesh.places.size();
  }
  reserveAll(primitives, scene);
  for (const PrimitiveInstance& instance : instances) appendPrimitive(instance, scene.space, scene);
  scene.instances.reserve(places);
  for (const MeshToShare& mesh : shared) appendShared(mesh, scene);
}

}  // namespace fragtrace
