// SPDX-License-Identifier: MIT
#include "scene/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace fragtrace {
namespace {

/// The orientation of texture space on a triangle. In glTF, with v downwards, an unmirrored map has negative
/// area.
enum Orientation : uint32_t { kUnmirrored = 0, kMirrored = 1, kUndecided = 2 };

struct TriangleFrame {
  glm::dvec3 tangent{0.0};  ///< along dP/du; any length
  Orientation orientation = kUndecided;
};

glm::dvec3 unitOrZero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

class TangentMaker {
 public:
  TangentMaker(Vertices& vertices, std::span<Triangle> triangles, uint32_t texcoord,
               const TextureTransform& transform)
      : vertices_(vertices),
        triangles_(triangles),
        texcoords_(texcoord == 0 ? vertices.texcoord0 : vertices.texcoord1) {
    // A set that is missing is (0, 0) everywhere, so that no triangle has an orientation.
    if (texcoords_.empty()) texcoords_.assign(vertices.position.size(), glm::vec2(0.0f));
    if (transform == TextureTransform{}) return;
    for (glm::vec2& place : texcoords_) place = transform.of(place);
  }

  void make() {
    weld();
    std::vector<Orientation> orientations(triangles_.size());
    sums_.assign(2 * weldedCount_, glm::dvec3(0.0));
    used_.assign(2 * weldedCount_, false);
    for (size_t i = 0; i < triangles_.size(); ++i) orientations[i] = accumulate(triangles_[i]);
    for (size_t i = 0; i < triangles_.size(); ++i) {
      if (orientations[i] == kUndecided) orientations[i] = orientationOfNeighbours(triangles_[i]);
    }
    assign(orientations);
  }

 private:
  using Key = std::array<uint32_t, 8>;

  Key keyOf(size_t vertex) const {
    const glm::vec3 p = vertices_.position[vertex] + 0.0f;  // -0 + 0 is +0: the two count as equal
    const glm::vec3 n = vertices_.normal[vertex] + 0.0f;
    const glm::vec2 t = texcoords_[vertex] + 0.0f;
    return {std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y), std::bit_cast<uint32_t>(p.z),
            std::bit_cast<uint32_t>(n.x), std::bit_cast<uint32_t>(n.y), std::bit_cast<uint32_t>(n.z),
            std::bit_cast<uint32_t>(t.x), std::bit_cast<uint32_t>(t.y)};
  }

  static size_t hashOf(const Key& key) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (const uint32_t word : key) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    return size_t(hash);
  }

  /// Numbers vertices so that those with equal attributes have the same number, in an open-addressing table.
  void weld() {
    const size_t count = vertices_.position.size();
    const size_t mask = std::bit_ceil(2 * count + 1) - 1;
    std::vector<uint32_t> table(mask + 1, kMissIndex);  // a vertex
    welded_.resize(count);
    for (size_t vertex = 0; vertex < count; ++vertex) {
      const Key key = keyOf(vertex);
      size_t slot = hashOf(key) & mask;
      while (table[slot] != kMissIndex && keyOf(table[slot]) != key) slot = (slot + 1) & mask;
      if (table[slot] == kMissIndex) {
        table[slot] = uint32_t(vertex);
        welded_[vertex] = uint32_t(weldedCount_++);
      } else {
        welded_[vertex] = welded_[table[slot]];
      }
    }
  }

  TriangleFrame frameOf(const Triangle& triangle) const {
    const glm::dvec2 t0(texcoords_[triangle.vertex.x]);
    const glm::dvec2 t1 = glm::dvec2(texcoords_[triangle.vertex.y]) - t0;
    const glm::dvec2 t2 = glm::dvec2(texcoords_[triangle.vertex.z]) - t0;
    const glm::dvec3 p0(vertices_.position[triangle.vertex.x]);
    const glm::dvec3 p1 = glm::dvec3(vertices_.position[triangle.vertex.y]) - p0;
    const glm::dvec3 p2 = glm::dvec3(vertices_.position[triangle.vertex.z]) - p0;
    const double area = t1.x * t2.y - t1.y * t2.x;
    const glm::dvec3 tangent = unitOrZero(t2.y * p1 - t1.y * p2);
    if (area == 0.0 || tangent == glm::dvec3(0.0)) return {};
    return area > 0.0 ? TriangleFrame{tangent, kMirrored} : TriangleFrame{-tangent, kUnmirrored};
  }

  /// Adds the triangle's tangent to the sums of its corners.
  Orientation accumulate(const Triangle& triangle) {
    const TriangleFrame frame = frameOf(triangle);
    if (frame.orientation == kUndecided) return kUndecided;
    for (int corner = 0; corner < 3; ++corner) {
      const uint32_t vertex = triangle.vertex[corner];
      const glm::dvec3 normal(vertices_.normal[vertex]);
      const glm::dvec3 unitNormal = unitOrZero(normal);
      const auto inPlane = [&unitNormal](const glm::dvec3& v) {
        return unitOrZero(v - glm::dot(v, unitNormal) * unitNormal);
      };
      const glm::dvec3 here(vertices_.position[vertex]);
      const glm::dvec3 next(vertices_.position[triangle.vertex[(corner + 1) % 3]]);
      const glm::dvec3 last(vertices_.position[triangle.vertex[(corner + 2) % 3]]);
      const double angle =
          std::acos(std::clamp(glm::dot(inPlane(next - here), inPlane(last - here)), -1.0, 1.0));
      const size_t group = 2 * size_t(welded_[vertex]) + frame.orientation;
      sums_[group] += angle * inPlane(frame.tangent);
      used_[group] = true;
    }
    return frame.orientation;
  }

  /// A triangle without area in texture space takes the orientation of the triangles with which it shares
  /// most corners.
  Orientation orientationOfNeighbours(const Triangle& triangle) const {
    std::array<int, 2> corners{};
    for (int corner = 0; corner < 3; ++corner) {
      const size_t group = 2 * size_t(welded_[triangle.vertex[corner]]);
      corners[kUnmirrored] += used_[group + kUnmirrored];
      corners[kMirrored] += used_[group + kMirrored];
    }
    return corners[kMirrored] > corners[kUnmirrored] ? kMirrored : kUnmirrored;
  }

  uint32_t copyOf(uint32_t vertex) {
    const auto copy = uint32_t(vertices_.position.size());
    const auto duplicate = [vertex](auto& attribute) {
      if (attribute.empty()) return;
      const auto value = attribute[vertex];
      attribute.push_back(value);
    };
    duplicate(vertices_.position);
    duplicate(vertices_.normal);
    duplicate(vertices_.texcoord0);
    duplicate(vertices_.texcoord1);
    duplicate(vertices_.color);
    welded_.push_back(welded_[vertex]);
    return copy;
  }

  void assign(const std::vector<Orientation>& orientations) {
    const size_t count = vertices_.position.size();
    std::vector<Orientation> taken(count,
                                   kUndecided);  // orientation of the first triangle that uses the vertex
    std::vector<uint32_t> copies(count, kMissIndex);  // index of a vertex's copy for the other orientation
    for (size_t i = 0; i < triangles_.size(); ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        uint32_t& vertex = triangles_[i].vertex[corner];
        if (taken[vertex] == kUndecided) taken[vertex] = orientations[i];
        if (taken[vertex] == orientations[i]) continue;
        uint32_t& copy = copies[vertex];
        if (copy == kMissIndex) copy = copyOf(vertex);
        vertex = copy;
      }
    }
    vertices_.tangent.resize(vertices_.position.size());
    for (size_t vertex = 0; vertex < count; ++vertex) {
      const Orientation orientation = taken[vertex] == kUndecided ? kUnmirrored : taken[vertex];
      vertices_.tangent[vertex] = tangentOf(uint32_t(vertex), orientation);
      if (copies[vertex] == kMissIndex) continue;
      vertices_.tangent[copies[vertex]] =
          tangentOf(uint32_t(vertex), orientation == kMirrored ? kUnmirrored : kMirrored);
    }
  }

  glm::vec4 tangentOf(uint32_t vertex, Orientation orientation) const {
    const glm::dvec3 sum = unitOrZero(sums_[2 * size_t(welded_[vertex]) + orientation]);
    const glm::vec3 direction =
        sum == glm::dvec3(0.0) ? anyPerpendicular(vertices_.normal[vertex]) : glm::vec3(sum);
    return {direction, orientation == kMirrored ? -1.0f : 1.0f};
  }

  Vertices& vertices_;
  std::span<Triangle> triangles_;
  std::vector<glm::vec2> texcoords_;
  std::vector<uint32_t> welded_;  ///< number of the welded vertex, by vertex
  size_t weldedCount_ = 0;
  std::vector<glm::dvec3> sums_;  ///< two a welded vertex, by orientation
  std::vector<bool> used_;
};

}  // namespace

glm::vec3 anyPerpendicular(const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  // The product is with the axis along which the normal is shortest, so that it is never near zero.
  const glm::vec3 axis = size.x <= size.y && size.x <= size.z ? glm::vec3(1, 0, 0)
                         : size.y <= size.z                   ? glm::vec3(0, 1, 0)
                                                              : glm::vec3(0, 0, 1);
  const glm::vec3 perpendicular = glm::cross(normal, axis);
  const float length = glm::length(perpendicular);
  return length > 0.0f ? perpendicular / length : glm::vec3(1, 0, 0);
}

void makeTangents(Vertices& vertices, std::span<Triangle> triangles, uint32_t texcoord,
                  const TextureTransform& transform) {
  TangentMaker(vertices, triangles, texcoord, transform).make();
}

}  // namespace fragtrace
