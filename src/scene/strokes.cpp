// SPDX-License-Identifier: MIT
#include "scene/strokes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <utility>

#include "scene/creases.h"
#include "scene/tangents.h"

namespace fragtrace {

namespace {

constexpr int kSides = 6;

/// Sizes of strokes, in local space.
class StrokeSize {
 public:
  StrokeSize(const LocalSpace& space, const Camera& camera, int pictureHeight, double pixels)
      : perspective_(camera.perspective),
        position_(space.localOf(camera.position)),
        forward_(camera.forward) {
    // The circumradius of a hexagon with the area of the circle.
    const double rounder = std::sqrt(glm::two_pi<double>() / (3.0 * std::sqrt(3.0)));
    const double halfHeight = perspective_ ? std::tan(0.5 * camera.fovY) : camera.halfHeight / space.unit;
    radius_ = rounder * 0.5 * pixels * 2.0 * halfHeight / pictureHeight;
  }

  double at(const glm::dvec3& point) const {
    if (!perspective_) return radius_;
    // Of what lies beside or behind the camera the depth would be nothing.
    constexpr double kLeastCosine = 0.25;
    const glm::dvec3 way = point - position_;
    return radius_ * std::max(glm::dot(way, forward_), kLeastCosine * glm::length(way));
  }

  /// Unit, to the camera.
  glm::dvec3 towardsCamera(const glm::dvec3& point) const {
    const glm::dvec3 way = position_ - point;
    const double length = glm::length(way);
    return perspective_ && length > 0.0 ? way / length : -forward_;
  }

 private:
  bool perspective_;
  glm::dvec3 position_;
  glm::dvec3 forward_;
  double radius_ = 0.0;  ///< of a perspective camera: at depth 1
};

/// What the solid of a point or of a line is drawn with.
Material strokeMaterial(const Material& given, bool lit) {
  Material m = given;
  m.unlit = m.unlit || !lit;
  m.doubleSided = false;  // solids have no inside to be seen
  m.normalTexture = {};
  m.clearcoatNormalTexture = {};
  m.anisotropyStrength = 0.0f;
  m.anisotropyTexture = {};
  m.perlinNormal = {};
  return m;
}

class StrokeBuilder {
 public:
  StrokeBuilder(Scene& scene, const StrokeSize& size) : scene_(scene), size_(size) {}

  void add(const Strokes& strokes) {
    const size_t before = triangles_.size();
    material_ = materialOf(strokes);
    for (const glm::uvec2& ends : strokes.ends) addSolid(ends.x, ends.y);
    origins_.push_back({strokes.node, strokes.mesh, flatTriangleCount(scene_) + uint32_t(before),
                        uint32_t(triangles_.size() - before), strokes.nodeIndex});
  }

  /// Behind the other triangles in local space, before those of shared meshes.
  void finish() {
    const uint32_t flat = flatTriangleCount(scene_);
    const auto count = uint32_t(triangles_.size());
    const auto after = std::ranges::lower_bound(scene_.origins, flat, {}, &PrimitiveOrigin::firstTriangle) -
                       scene_.origins.begin();
    for (size_t i = size_t(after); i < scene_.origins.size(); ++i) scene_.origins[i].firstTriangle += count;
    scene_.origins.insert(scene_.origins.begin() + after, origins_.begin(), origins_.end());
    scene_.strokeTriangles = count;
    for (SharedMesh& mesh : scene_.sharedMeshes) mesh.firstTriangle += count;
    scene_.triangles.insert(scene_.triangles.begin() + std::ptrdiff_t(flat), triangles_.begin(),
                            triangles_.end());
  }

 private:
  uint32_t materialOf(const Strokes& strokes) {
    const auto [entry, isNew] = materials_.try_emplace({strokes.material, strokes.lit}, 0u);
    if (isNew) {
      entry->second = uint32_t(scene_.materials.size());
      scene_.materials.push_back(strokeMaterial(scene_.materials.at(strokes.material), strokes.lit));
    }
    return entry->second;
  }

  /// A vertex at a place with all other attributes of one that is there.
  uint32_t vertexLike(uint32_t like, const glm::dvec3& position) {
    Vertices& v = scene_.vertices;
    const auto repeat = [&](auto& attribute) {
      if (!attribute.empty()) {
        const auto value = attribute[like];
        attribute.push_back(value);
      }
    };
    repeat(v.normal);
    repeat(v.tangent);
    repeat(v.texcoord0);
    repeat(v.texcoord1);
    repeat(v.color);
    v.position.emplace_back(position);
    return uint32_t(v.position.size() - 1);
  }

  /// The hexagon's corners, counter-clockwise seen from where `axis` points.
  std::array<uint32_t, kSides> addRing(uint32_t like, const glm::dvec3& center, const glm::dvec3& axis,
                                       double radius) {
    const glm::dvec3 side(anyPerpendicular(glm::vec3(axis)));
    const glm::dvec3 first = glm::normalize(side - glm::dot(side, axis) * axis);
    const glm::dvec3 second = glm::cross(axis, first);
    std::array<uint32_t, kSides> ring{};
    for (int i = 0; i < kSides; ++i) {
      const double angle = glm::two_pi<double>() * i / kSides;
      ring[size_t(i)] =
          vertexLike(like, center + radius * (std::cos(angle) * first + std::sin(angle) * second));
    }
    return ring;
  }

  void addTriangle(uint32_t a, uint32_t b, uint32_t c) { triangles_.push_back({{a, b, c}, material_, true}); }

  void addSolid(uint32_t from, uint32_t to) {
    const glm::dvec3 a(scene_.vertices.position[from]);
    const glm::dvec3 b(scene_.vertices.position[to]);
    const double length = glm::length(b - a);
    const bool isPoint = length == 0.0;
    const glm::dvec3 axis = isPoint ? size_.towardsCamera(a) : (b - a) / length;
    const double radiusA = size_.at(a);
    const double radiusB = size_.at(b);
    const auto ringA = addRing(from, a, axis, radiusA);
    const auto ringB = isPoint ? ringA : addRing(to, b, axis, radiusB);
    const uint32_t apexA = vertexLike(from, a - radiusA * axis);
    const uint32_t apexB = vertexLike(to, b + radiusB * axis);
    for (size_t i = 0; i < kSides; ++i) {
      const size_t next = (i + 1) % kSides;
      addTriangle(apexA, ringA[next], ringA[i]);
      if (!isPoint) {
        addTriangle(ringA[i], ringA[next], ringB[next]);
        addTriangle(ringA[i], ringB[next], ringB[i]);
      }
      addTriangle(apexB, ringB[i], ringB[next]);
    }
  }

  Scene& scene_;
  const StrokeSize& size_;
  uint32_t material_ = 0;
  std::map<std::pair<uint32_t, bool>, uint32_t> materials_;
  std::vector<Triangle> triangles_;
  std::vector<PrimitiveOrigin> origins_;
};

}  // namespace

void addStrokes(Scene& scene, const Camera& camera, int pictureHeight, double pixels) {
  if (scene.strokes.empty()) return;
  const StrokeSize size(scene.space, camera, pictureHeight, pixels);
  StrokeBuilder builder(scene, size);
  for (const Strokes& strokes : scene.strokes) builder.add(strokes);
  builder.finish();
  scene.insets = creaseInsets(scene);
}

}  // namespace fragtrace
