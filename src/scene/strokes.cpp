// SPDX-License-Identifier: MIT
#include "scene/strokes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <utility>

#include "scene/camera.h"
#include "scene/creases.h"
#include "scene/tangents.h"

namespace fragtrace {

namespace {

constexpr int kSides = 6;
using Ring = std::array<uint32_t, kSides>;  // vertices

/// Sizes of strokes, in local space.
class StrokeSize {
 public:
  StrokeSize(const LocalSpace& space, const Camera& camera, glm::ivec2 pictureSize, double pixels)
      : parallel_(camera.type == CameraType::Orthographic),
        round_(!isRectilinear(camera.type)),
        position_(space.localOf(camera.position)),
        forward_(camera.forward) {
    // The circumradius of a hexagon with the area of the circle.
    const double rounder = std::sqrt(glm::two_pi<double>() / (3.0 * std::sqrt(3.0)));
    const double halfHeight = halfExtents(camera, pictureSize.x, pictureSize.y, space.unit).y;
    radius_ = rounder * 0.5 * pixels * 2.0 * halfHeight / pictureSize.y;
  }

  /// The radius at a point: its solid covers as many pixels as the circle. Seen at an angle c to the axis it
  /// is longer by 1 / cos c.
  double atPoint(const glm::dvec3& point) const {
    if (parallel_) return radius_;
    const double distance = glm::length(point - position_);
    if (round_) return radius_ * distance;
    const double depth = std::abs(depthOf(point));
    return distance > 0.0 ? radius_ * depth * std::sqrt(depth / distance) : 0.0;
  }

  /// The radius of a line along `axis`, unit: as wide as asked across the line, in the picture's plane.
  double acrossLine(const glm::dvec3& point, const glm::dvec3& axis) const {
    if (parallel_) return radius_;
    const glm::dvec3 way = point - position_;
    if (round_) return radius_ * glm::length(way);
    const double depth = depthOf(point);
    const glm::dvec3 across = glm::cross(axis, way);
    const double length = glm::length(across);
    if (depth == 0.0 || length == 0.0) return radius_ * std::abs(depth);
    // The length of that step in the plane at depth 1.
    const glm::dvec3 step = across / length;
    const double along = glm::dot(step, forward_);
    const glm::dvec3 sideways = (step - along * forward_) - (way / depth - forward_) * along;
    return radius_ * std::abs(depth) / std::max(glm::length(sideways), 1e-3);
  }

  /// The depth along the view's axis, or from a round camera; negative behind a perspective camera.
  double depthOf(const glm::dvec3& point) const {
    if (round_) return glm::length(point - position_);
    return parallel_ ? 1.0 : glm::dot(point - position_, forward_);
  }

  /// The unit vector to the camera.
  glm::dvec3 towardsCamera(const glm::dvec3& point) const {
    const glm::dvec3 way = position_ - point;
    const double length = glm::length(way);
    return !parallel_ && length > 0.0 ? way / length : -forward_;
  }

 private:
  bool parallel_;
  bool round_;  ///< a panorama or a fisheye, whose pixels are even in angle
  glm::dvec3 position_;
  glm::dvec3 forward_;
  double radius_ = 0.0;  ///< the radius at depth 1, or everywhere in a parallel view
};

/// The material of the solid of a point or line. Without normals it shows the sum of base colour and emission
/// (glTF 2.0, section 3.7.2.1); a texture of emission is then left out.
Material strokeMaterial(const Material& given, bool lit) {
  Material m = given;
  if (!lit && !m.unlit) {
    m.unlit = true;
    if (!m.emissiveTexture.present())
      m.baseColorFactor += glm::vec4(m.emissiveFactor * m.emissiveStrength, 0.0f);
  }
  m.doubleSided = false;  // solids have no inside to be seen
  m.normalTexture = {};
  m.clearcoatNormalTexture = {};
  m.anisotropyStrength = 0.0f;
  m.anisotropyTexture = {};
  m.perlinNormal = {};
  return m;
}

/// The attributes at a share of the way from one vertex to another.
struct Blend {
  uint32_t from = 0;
  uint32_t to = 0;
  float part = 0.0f;
};

class StrokeBuilder {
 public:
  StrokeBuilder(Scene& scene, const StrokeSize& size) : scene_(scene), size_(size) {}

  void add(const Strokes& strokes) {
    const size_t before = triangles_.size();
    material_ = materialOf(strokes);
    for (const glm::uvec2& ends : strokes.ends) ends.x == ends.y ? addPoint(ends.x) : addLine(ends.x, ends.y);
    origins_.push_back({strokes.node, strokes.mesh, flatTriangleCount(scene_) + uint32_t(before),
                        uint32_t(triangles_.size() - before), strokes.nodeIndex});
  }

  void finish() {
    scene_.strokeTriangles = uint32_t(triangles_.size());
    insertFlatTriangles(scene_, triangles_, origins_);
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

  /// A vertex at a place, with attributes blended between those of two others.
  uint32_t vertexBetween(const Blend& like, const glm::dvec3& position) {
    Vertices& v = scene_.vertices;
    const auto append = [&](auto& attribute) {
      if (attribute.empty()) return;
      const auto value = attribute[like.from];
      const auto other = attribute[like.to];
      attribute.push_back(like.part == 0.0f ? value : value + (other - value) * like.part);
    };
    append(v.normal);
    append(v.tangent);
    append(v.texcoord0);
    append(v.texcoord1);
    append(v.color);
    v.position.emplace_back(position);
    return uint32_t(v.position.size() - 1);
  }

  /// The hexagon's corners, counter-clockwise as seen from the point of `axis`.
  Ring addRing(const Blend& like, const glm::dvec3& center, const glm::dvec3& axis, double radius) {
    const glm::dvec3 side(anyPerpendicular(glm::vec3(axis)));
    const glm::dvec3 first = glm::normalize(side - glm::dot(side, axis) * axis);
    const glm::dvec3 second = glm::cross(axis, first);
    Ring ring{};
    for (int i = 0; i < kSides; ++i) {
      const double angle = glm::two_pi<double>() * i / kSides;
      ring[size_t(i)] =
          vertexBetween(like, center + radius * (std::cos(angle) * first + std::sin(angle) * second));
    }
    return ring;
  }

  void addTriangle(uint32_t a, uint32_t b, uint32_t c) { triangles_.push_back({{a, b, c}, material_, true}); }

  /// Adds two pyramids, with a prism between them unless they share their ring.
  void addSolid(uint32_t apexA, const Ring& ringA, const Ring& ringB, uint32_t apexB) {
    for (size_t i = 0; i < kSides; ++i) {
      const size_t next = (i + 1) % kSides;
      addTriangle(apexA, ringA[next], ringA[i]);
      if (ringA != ringB) {
        addTriangle(ringA[i], ringA[next], ringB[next]);
        addTriangle(ringA[i], ringB[next], ringB[i]);
      }
      addTriangle(apexB, ringB[i], ringB[next]);
    }
  }

  void addPoint(uint32_t vertex) {
    const glm::dvec3 place(scene_.vertices.position[vertex]);
    const glm::dvec3 axis = size_.towardsCamera(place);
    const double radius = size_.atPoint(place);
    const Blend like{vertex, vertex, 0.0f};
    const auto ring = addRing(like, place, axis, radius);
    const uint32_t behind = vertexBetween(like, place - radius * axis);
    const uint32_t before = vertexBetween(like, place + radius * axis);
    addSolid(behind, ring, ring, before);
  }

  /// A line that passes the camera becomes two, because its width is 0 where its depth is 0.
  void addLine(uint32_t from, uint32_t to) {
    const glm::dvec3 a(scene_.vertices.position[from]);
    const glm::dvec3 b(scene_.vertices.position[to]);
    const double length = glm::length(b - a);
    if (length == 0.0) return;
    const double depthA = size_.depthOf(a);
    const double depthB = size_.depthOf(b);
    if (depthA * depthB >= 0.0) return addSegment({from, to, 0.0f}, {from, to, 1.0f}, a, b);
    const double part = depthA / (depthA - depthB);
    const glm::dvec3 between = a + part * (b - a);
    addSegment({from, to, 0.0f}, {from, to, float(part)}, a, between);
    addSegment({from, to, float(part)}, {from, to, 1.0f}, between, b);
  }

  void addSegment(const Blend& likeA, const Blend& likeB, const glm::dvec3& a, const glm::dvec3& b) {
    const double length = glm::length(b - a);
    if (length == 0.0) return;
    const glm::dvec3 axis = (b - a) / length;
    const double radiusA = size_.acrossLine(a, axis);
    const double radiusB = size_.acrossLine(b, axis);
    const auto ringA = addRing(likeA, a, axis, radiusA);
    const auto ringB = addRing(likeB, b, axis, radiusB);
    const uint32_t apexA = vertexBetween(likeA, a - radiusA * axis);
    const uint32_t apexB = vertexBetween(likeB, b + radiusB * axis);
    addSolid(apexA, ringA, ringB, apexB);
  }

  Scene& scene_;
  const StrokeSize& size_;
  uint32_t material_ = 0;
  std::map<std::pair<uint32_t, bool>, uint32_t> materials_;
  std::vector<Triangle> triangles_;
  std::vector<PrimitiveOrigin> origins_;
};

}  // namespace

void insertFlatTriangles(Scene& scene, const std::vector<Triangle>& triangles,
                         const std::vector<PrimitiveOrigin>& origins) {
  const uint32_t flat = flatTriangleCount(scene);
  const auto count = uint32_t(triangles.size());
  const auto after = std::ranges::lower_bound(scene.origins, flat, {}, &PrimitiveOrigin::firstTriangle) -
                     scene.origins.begin();
  for (size_t i = size_t(after); i < scene.origins.size(); ++i) scene.origins[i].firstTriangle += count;
  scene.origins.insert(scene.origins.begin() + after, origins.begin(), origins.end());
  for (SharedMesh& mesh : scene.sharedMeshes) mesh.firstTriangle += count;
  scene.triangles.insert(scene.triangles.begin() + std::ptrdiff_t(flat), triangles.begin(), triangles.end());
}

size_t trianglesOf(const Strokes& strokes) {
  size_t count = 0;
  for (const glm::uvec2& ends : strokes.ends)
    count += ends.x == ends.y ? kTrianglesOfAPoint : kTrianglesOfALine;
  return count;
}

void addStrokes(Scene& scene, const Camera& camera, glm::ivec2 pictureSize, double pixels) {
  if (scene.strokes.empty()) return;
  const StrokeSize size(scene.space, camera, pictureSize, pixels);
  StrokeBuilder builder(scene, size);
  for (const Strokes& strokes : scene.strokes) builder.add(strokes);
  builder.finish();
  settleCreases(scene);
}

}  // namespace fragtrace
