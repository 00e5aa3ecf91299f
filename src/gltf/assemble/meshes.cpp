// SPDX-License-Identifier: MIT
#include "gltf/assemble/meshes.h"

#include <algorithm>
#include <cmath>

#include "bvh/bvh.h"
#include "scene/strokes.h"
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
class MeshPlacement {
 public:
  explicit MeshPlacement(const PrimitiveInstance& instance)
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

void appendVertices(const Vertices& from, MeshPlacement& placement, const LocalSpace& space, Vertices& to) {
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

/// Bounds of all triangles, points and lines of a mesh in its own space; vertices that none uses do not
/// count.
BoundsDouble boundsOf(const std::vector<MeshPrimitive>& mesh) {
  Bounds box;
  for (const MeshPrimitive& primitive : mesh)
    forEachCorner(primitive, [&](uint32_t vertex) { box.include(primitive.vertices.position[vertex]); });
  return {glm::dvec3(box.minimum), glm::dvec3(box.maximum)};
}

/// A box round what is in that box.
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
  MeshPlacement placement(instance);
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

// The scene's own copy, the tree over it, and what is packed for the device, which are not all there at once.
constexpr uint64_t kBytesOfAVertex = 100;
constexpr uint64_t kBytesOfATriangle = 150;
constexpr uint64_t kBytesOfAnInstance = 700;

using Mesh = std::vector<MeshPrimitive>;

/// The uses of one mesh in the scene.
struct MeshUse {
  const MeshPrimitive* first = nullptr;  ///< its first primitive that has triangles
  uint64_t triangles = 0;
  uint64_t bytes = 0;
  uint64_t places = 0;  ///< places in which it may be shared
  uint64_t allPlaces = 0;
  bool shines = false;
  bool isShared = false;
  size_t index = 0;  ///< among the shared ones

  uint64_t flatBytes() const { return places * bytes; }
  uint64_t sharedBytes() const { return bytes + places * kBytesOfAnInstance; }
};

MeshUse useOf(const Mesh& mesh, const std::vector<Material>& materials) {
  MeshUse use;
  for (const MeshPrimitive& primitive : mesh) {
    if (primitive.triangles.empty()) continue;
    if (use.first == nullptr) use.first = &primitive;
    use.triangles += primitive.triangles.size();
    use.bytes +=
        primitive.vertices.position.size() * kBytesOfAVertex + primitive.triangles.size() * kBytesOfATriangle;
    use.shines = use.shines || materials.at(primitive.triangles[0].material).emissive();
  }
  return use;
}

/// Returns false if a matrix scales too unevenly, judged by Frobenius norms. Their product is about 3 for
/// rotations, and larger for uneven scales.
bool isWellConditioned(const glm::dmat3& matrix) {
  constexpr double kMostUneven = 32.0;
  const glm::dmat3 inverse = glm::inverse(matrix);
  double squared = 0.0;
  double inverseSquared = 0.0;
  for (int c = 0; c < 3; ++c) {
    squared += glm::dot(matrix[c], matrix[c]);
    inverseSquared += glm::dot(inverse[c], inverse[c]);
  }
  return std::sqrt(squared) * std::sqrt(inverseSquared) <= kMostUneven;
}

using MeshUses = std::map<const Mesh*, MeshUse>;

bool mayShare(const PrimitiveInstance& i, const MeshUses& uses) {
  return i.whole != nullptr && !uses.at(i.whole).shines && isWellConditioned(glm::dmat3(i.world));
}

/// Counts the uses of each mesh in the scene.
MeshUses countUses(const std::vector<PrimitiveInstance>& instances, const std::vector<Material>& materials) {
  MeshUses uses;
  for (const PrimitiveInstance& i : instances) {
    const auto [use, isNew] = uses.try_emplace(i.whole);
    if (isNew && i.whole != nullptr) use->second = useOf(*i.whole, materials);
    if (i.primitive != use->second.first) continue;
    ++use->second.allPlaces;
    if (mayShare(i, uses)) ++use->second.places;
  }
  return uses;
}

/// Meshes that are shared, with their places, and all else as it is.
void part(std::vector<PrimitiveInstance> instances, MeshUses& uses, PlacedMeshes& placed) {
  for (PrimitiveInstance& i : instances) {
    MeshUse& use = uses.at(i.whole);
    if (!use.isShared || !mayShare(i, uses)) {
      placed.flat.push_back(std::move(i));
    } else if (i.primitive == use.first) {
      if (use.index == 0) {
        placed.shared.push_back({i.whole, i.mesh, {}});
        use.index = placed.shared.size();
      }
      placed.shared[use.index - 1].places.push_back({i.world, std::move(i.node), i.nodeIndex});
    }
  }
}

/// Names the meshes that are copied though the scene has them more than once; empty if there are none.
std::string copiesAmong(const MeshUses& uses) {
  uint64_t shining = 0;
  uint64_t uneven = 0;
  for (const auto& [mesh, use] : uses) {
    if (mesh == nullptr || use.allPlaces < 2) continue;
    shining += use.shines ? 1 : 0;
    uneven += use.shines ? 0 : use.allPlaces - use.places;
  }
  std::string text = shining > 0 ? "emissive meshes (" + std::to_string(shining) + ")" : "";
  if (shining > 0 && uneven > 0) text += ", ";
  if (uneven > 0) text += "unevenly scaled instances (" + std::to_string(uneven) + ")";
  return text;
}

std::string megabytes(uint64_t bytes) { return std::to_string((bytes + 500000) / 1000000) + " MB"; }

}  // namespace

BoundsDouble boundsOf(std::span<const PrimitiveInstance> instances, std::span<const MeshToShare> shared) {
  BoundsDouble bounds;
  for (const PrimitiveInstance& instance : instances) {
    MeshPlacement placement(instance);
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

bool paysToShare(const SharingCost& cost, uint64_t limit) {
  constexpr uint64_t kSmall = uint64_t(64) << 20;
  return cost.flat > kSmall && cost.shared < cost.flat && (cost.flat / 2 > cost.shared || cost.flat > limit);
}

PlacedMeshes chooseSharing(std::vector<PrimitiveInstance> instances, Instancing wanted,
                           const std::vector<Material>& materials, uint64_t limit) {
  SharingCost cost;
  uint64_t flatTriangles = 0;
  for (const PrimitiveInstance& i : instances) {
    const uint64_t strokes = i.primitive->strokes.ends.size();
    const uint64_t triangles = i.primitive->triangles.size() + trianglesOf(i.primitive->strokes);
    const uint64_t vertices = i.primitive->vertices.position.size() + strokes * kMostStrokeVertices;
    cost.flat += vertices * kBytesOfAVertex + triangles * kBytesOfATriangle;
    flatTriangles += triangles;
  }
  MeshUses uses = countUses(instances, materials);

  // Step: which of them would take less when shared.
  PlacedMeshes placed;
  cost.shared = cost.flat;
  uint64_t largest = 0;
  uint64_t instanceCount = 0;
  for (auto& [mesh, use] : uses) {
    const bool saves = use.sharedBytes() < use.flatBytes() / 2;
    use.isShared = use.places > 1 && (wanted == Instancing::Share || saves);
    if (!use.isShared) continue;
    cost.shared += use.sharedBytes();
    cost.shared -= use.flatBytes();
    largest = std::max(largest, use.triangles);
    instanceCount += use.places;
    flatTriangles -= use.places * use.triangles;
  }

  // Step: the choice for all of them.
  const std::string amounts = megabytes(cost.shared) + " instead of " + megabytes(cost.flat);
  bool isShared = false;
  if (wanted == Instancing::Flatten) {
    placed.reason = "--instancing flatten";
  } else if (instanceCount == 0) {
    placed.reason = "no mesh that can be shared appears often enough in the scene";
  } else if (!fitsTwoLevels(flatTriangles + instanceCount, largest)) {
    placed.reason = "two trees would be deeper than the stack";
  } else if (wanted == Instancing::Share) {
    isShared = true;
    placed.reason = "--instancing share: " + amounts;
  } else {
    isShared = paysToShare(cost, limit);
    placed.reason = (isShared ? "saves memory: " : "too little to save: ") + amounts;
  }
  placed.copies = wanted == Instancing::Flatten ? "" : copiesAmong(uses);
  placed.bytes = isShared ? cost.shared : cost.flat;
  if (!isShared) {
    placed.flat = std::move(instances);
    return placed;
  }

  part(std::move(instances), uses, placed);
  return placed;
}

namespace {

/// The node's weights, else the mesh's (glTF 2.0, section 3.7.2.2), and the joints of its skin.
MeshPose poseOf(const Document& document, const tinygltf::Node& node) {
  MeshPose pose;
  const tinygltf::Mesh& mesh = document.model.meshes.at(size_t(node.mesh));
  pose.weights = !node.weights.empty() ? node.weights : mesh.weights;
  while (!pose.weights.empty() && pose.weights.back() == 0.0) pose.weights.pop_back();
  if (node.skin >= 0) pose.jointCount = document.skins.at(size_t(node.skin)).joints.size();
  return pose;
}

DecodedMesh decodeMesh(Document& document, const std::vector<Material>& materials, int mesh,
                       const MeshPose& pose) {
  DecodedMesh decoded;
  const size_t count = document.model.meshes.at(size_t(mesh)).primitives.size();
  for (size_t i = 0; i < count; ++i) {
    auto primitive = document.diagnostics.keepRest(
        "the primitive", [&] { return decodePrimitive(document, materials, mesh, int(i), pose); });
    decoded.primitives.push_back(primitive ? std::move(*primitive) : MeshPrimitive());
  }
  decoded.bounds = boundsOf(decoded.primitives);
  return decoded;
}

bool hasStrokes(const MeshPrimitive& primitive) { return !primitive.strokes.ends.empty(); }

bool hasNoInfluences(const MeshPrimitive& primitive) {
  return !primitive.empty() && primitive.influences.empty();
}

/// Drops the places where a mesh is so small that squares of its size underflow. A size of 0 is none of them:
/// files hide meshes that way.
void checkSizes(Document& document, const PlacedNode& node, const BoundsDouble& bounds,
                std::vector<glm::dmat4>& places) {
  if (bounds.empty()) return;
  const std::string place = pointerTo("nodes", node.index);
  const size_t dropped = std::erase_if(places, [&](const glm::dmat4& world) {
    const BoundsDouble placed = transformed(bounds, world);
    const glm::dvec3 farthest = glm::max(glm::abs(placed.minimum), glm::abs(placed.maximum));
    if (!(std::max({farthest.x, farthest.y, farthest.z}) <= kFarthest))
      document.diagnostics.lose(place, "its mesh reaches farther than 1e30 m from the origin");
    const glm::dvec3 extent = placed.extent();
    const double size = std::max({extent.x, extent.y, extent.z});
    return size > 0.0 && size < kSmallest;
  });
  if (dropped == 0) return;
  const bool isScaled = !document.model.nodes.at(size_t(node.index)).scale.empty();
  document.diagnostics.warn(isScaled ? place + "/scale" : place,
                            "its mesh is less than 1e-75 m in size, and left out", dropped);
}

std::vector<const PlacedNode*> byIndex(const Document& document, const std::vector<PlacedNode>& nodes) {
  std::vector<const PlacedNode*> result(document.model.nodes.size(), nullptr);
  for (const PlacedNode& node : nodes) result[size_t(node.index)] = &node;
  return result;
}

/// Adds the mesh of a node.
void showMesh(Document& document, const std::vector<Material>& materials, const PlacedNode& node,
              const std::vector<const PlacedNode*>& placed, ShownMeshes& shown) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  const tinygltf::Mesh& mesh = document.model.meshes.at(size_t(source.mesh));
  const MeshPose pose = poseOf(document, source);
  const auto [entry, isNew] = shown.decoded.try_emplace({source.mesh, pose});
  if (isNew) entry->second = decodeMesh(document, materials, source.mesh, pose);
  const DecodedMesh& decoded = entry->second;
  std::span<const glm::dmat4> joints;
  if (source.skin >= 0) {
    auto matrices = shown.joints.find(source.skin);
    if (matrices == shown.joints.end())
      matrices = shown.joints.emplace(source.skin, jointMatrices(document, node.index, placed)).first;
    joints = matrices->second;
    if (std::ranges::any_of(decoded.primitives, hasNoInfluences))
      document.diagnostics.warn(pointerTo("nodes", node.index, "skin"),
                                "has a mesh without joints and weights, which stands where its node does");
  }
  const std::string nodeName = nameOrPlace(source.name, "nodes", node.index);
  const std::string meshName = nameOrPlace(mesh.name, "meshes", source.mesh);
  std::vector<glm::dmat4> places = placesOfMesh(document, node);
  if (joints.empty()) checkSizes(document, node, decoded.bounds, places);
  takeMemory(document, pointerTo("nodes", node.index),
             places.size() * decoded.primitives.size() *
                 (sizeof(PrimitiveInstance) + nodeName.size() + meshName.size()));
  const bool mayShare = source.skin < 0 && std::ranges::none_of(decoded.primitives, hasStrokes);
  const std::vector<MeshPrimitive>* whole = mayShare ? &decoded.primitives : nullptr;
  for (const glm::dmat4& world : places) {
    for (const MeshPrimitive& primitive : decoded.primitives) {
      if (!primitive.empty())
        shown.instances.push_back(
            {&primitive, world, joints, nodeName, uint32_t(node.index), meshName, whole});
    }
  }
}

}  // namespace

ShownMeshes showMeshes(Document& document, const std::vector<Material>& materials,
                       const std::vector<PlacedNode>& nodes) {
  ShownMeshes shown;
  std::vector<const PlacedNode*> placed;
  if (!document.skins.empty()) placed = byIndex(document, nodes);
  for (const PlacedNode& node : nodes) {
    if (document.model.nodes.at(size_t(node.index)).mesh < 0 || node.hidden) continue;
    document.diagnostics.keepRest("the mesh here", [&] {
      showMesh(document, materials, node, placed, shown);
      return true;
    });
  }
  return shown;
}

}  // namespace fragtrace
