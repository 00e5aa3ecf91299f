// SPDX-License-Identifier: MIT
#include "bvh/open_panes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bvh/bvh.h"

namespace fragtrace {

namespace {

using glm::dvec3;

constexpr double kNear = 1e-3;              ///< share of a part's size
constexpr double kThickestPane = 1.0 / 20;  ///< the same, of a pane
constexpr size_t kMostLookedAt = 64;        ///< places of a part that are looked at

using PlaceEdge = std::pair<uint32_t, uint32_t>;

/// Triangles of solid glass that hang together.
struct GlassPart {
  std::vector<uint32_t> triangles;
  std::vector<PlaceEdge> open;  ///< edges of one triangle alone
};

bool isSolidGlass(const Scene& scene, uint32_t triangle) {
  const Material& material = scene.materials[scene.triangles[triangle].material];
  return material.passesLight() && material.solid();
}

/// One number for all vertices in the same place.
class PlaceNumbers {
 public:
  uint32_t numberOf(const glm::vec3& p) {
    return numbers_.try_emplace({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}, uint32_t(numbers_.size()))
        .first->second;
  }

 private:
  std::map<std::array<float, 3>, uint32_t> numbers_;
};

/// JoinedSets that are joined (Tarjan 1975, with paths halved).
class JoinedSets {
 public:
  uint32_t find(uint32_t i) {
    while (parents_.size() <= i) parents_.push_back(uint32_t(parents_.size()));
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parents_[find(a)] = find(b); }

 private:
  std::vector<uint32_t> parents_;
};

std::vector<GlassPart> openParts(const Scene& scene) {
  PlaceNumbers places;
  JoinedSets sets;
  std::vector<std::pair<uint32_t, std::array<uint32_t, 3>>> faces;
  std::map<PlaceEdge, std::pair<int, PlaceEdge>>
      edges;  // by places: how many triangles, and the vertices of one
  for (uint32_t i = 0; i < flatTriangleCount(scene); ++i) {
    if (!isSolidGlass(scene, i)) continue;
    const Triangle& t = scene.triangles[i];
    std::array<uint32_t, 3> at{};
    for (int c = 0; c < 3; ++c) at[size_t(c)] = places.numberOf(scene.vertices.position[t.vertex[c]]);
    if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
    for (size_t c = 0; c < 3; ++c) {
      const size_t next = (c + 1) % 3;
      sets.join(at[c], at[next]);
      auto& [count, vertices] = edges[std::minmax(at[c], at[next])];
      ++count;
      vertices = {t.vertex[int(c)], t.vertex[int(next)]};
    }
    faces.emplace_back(i, at);
  }
  std::map<uint32_t, GlassPart> parts;
  for (const auto& [key, edge] : edges) {
    if (edge.first == 1) parts[sets.find(key.first)].open.push_back(edge.second);
  }
  for (const auto& [triangle, at] : faces) {
    const auto part = parts.find(sets.find(at[0]));
    if (part != parts.end()) part->second.triangles.push_back(triangle);
  }
  std::vector<GlassPart> open;
  for (auto& [set, part] : parts) open.push_back(std::move(part));
  return open;
}

/// The squared distance of a point from a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
double squaredDistance(const dvec3& p, const std::array<dvec3, 3>& t) {
  const dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double area = glm::dot(normal, normal);
  bool isOver = area > 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t c = 0; c < 3; ++c) {
    const dvec3 edge = t[(c + 1) % 3] - t[c];
    const dvec3 to = p - t[c];
    isOver = isOver && glm::dot(glm::cross(edge, to), normal) >= 0.0;
    const double length = glm::dot(edge, edge);
    const double along = length > 0.0 ? std::clamp(glm::dot(to, edge) / length, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, glm::dot(to - along * edge, to - along * edge));
  }
  const double above = glm::dot(p - t[0], normal);
  return isOver ? above * above / area : nearest;
}

/// Returns true if a triangle lies on the way of a segment.
bool crossesSegment(const dvec3& from, const dvec3& to, const std::array<dvec3, 3>& t) {
  const dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double a = glm::dot(from - t[0], normal), b = glm::dot(to - t[0], normal);
  if (a == b || (a > 0.0) == (b > 0.0)) return false;
  const dvec3 at = from + (to - from) * (a / (a - b));
  for (size_t c = 0; c < 3; ++c) {
    if (glm::dot(glm::cross(t[(c + 1) % 3] - t[c], at - t[c]), normal) < 0.0) return false;
  }
  return true;
}

/// What the rule asks about a part.
class PaneTest {
 public:
  PaneTest(const Scene& scene, const GlassPart& part) : scene_(scene), part_(part) {
    for (const uint32_t i : part.triangles) {
      const auto corners = cornersOf<dvec3>(scene, scene.triangles[i]);
      across_ += glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      for (const dvec3& corner : corners) box_.include(corner);
    }
    size_ = glm::length(box_.extent());
    const Material& material = scene.materials[scene.triangles[part.triangles[0]].material];
    thickness_ = double(material.thicknessFactor) / scene.space.unit;
    gather();
  }

  bool isPane() const {
    const bool isFlat = thickness_ <= kThickestPane * size_ && flatness() <= thickness_;
    return (isFlat || hangsFree()) && !liesOverBed();
  }

 private:
  struct Near {
    std::array<dvec3, 3> corners;
    bool isOwn;
  };

  /// Collects the triangles that are near enough to count.
  void gather() {
    BoundsDouble around = box_;
    const dvec3 reach(std::max(kNear * size_, std::min(thickness_, size_)));
    around.minimum -= reach;
    around.maximum += reach;
    for (uint32_t i = 0; i < flatTriangleCount(scene_); ++i) {
      const Bounds box = triangleBounds(scene_, i);
      if (glm::all(glm::lessThanEqual(dvec3(box.minimum), around.maximum)) &&
          glm::all(glm::lessThanEqual(around.minimum, dvec3(box.maximum))))
        near_.push_back(
            {cornersOf<dvec3>(scene_, scene_.triangles[i]), std::ranges::binary_search(part_.triangles, i)});
    }
  }

  /// The extent of the part along its mean normal.
  double flatness() const {
    const double length = glm::length(across_);
    if (!(length > 0.0)) return std::numeric_limits<double>::infinity();
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const uint32_t i : part_.triangles) {
      for (const dvec3& corner : cornersOf<dvec3>(scene_, scene_.triangles[i])) {
        const double height = glm::dot(corner, across_) / length;
        least = std::min(least, height);
        most = std::max(most, height);
      }
    }
    return most - least - 1e-6 * size_;
  }

  bool hangsFree() const {
    double free = 0.0, whole = 0.0;
    for (size_t i = 0; i < part_.open.size(); i += part_.open.size() / kMostLookedAt + 1) {
      const dvec3 a(scene_.vertices.position[part_.open[i].first]);
      const dvec3 b(scene_.vertices.position[part_.open[i].second]);
      const auto isNear = [&](const Near& other) {
        const auto has = [&](const dvec3& p) {
          return std::ranges::find(other.corners, p) != other.corners.end();
        };
        return !(other.isOwn && has(a) && has(b)) &&
               squaredDistance(0.5 * (a + b), other.corners) <= kNear * size_ * kNear * size_;
      };
      whole += glm::length(b - a);
      if (std::ranges::none_of(near_, isNear)) free += glm::length(b - a);
    }
    return free > 0.5 * whole;
  }

  /// Returns true if another surface lies behind most of the part's places, within its thickness.
  bool liesOverBed() const {
    size_t count = 0, over = 0;
    for (size_t i = 0; i < part_.triangles.size(); i += part_.triangles.size() / kMostLookedAt + 1) {
      const auto t = cornersOf<dvec3>(scene_, scene_.triangles[part_.triangles[i]]);
      const dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
      if (glm::length(normal) == 0.0) continue;
      const dvec3 from = (t[0] + t[1] + t[2]) / 3.0;
      const dvec3 to = from - glm::normalize(normal) * (1.05 * std::min(thickness_, size_));
      ++count;
      over += std::ranges::any_of(
          near_, [&](const Near& other) { return !other.isOwn && crossesSegment(from, to, other.corners); });
    }
    return 2 * over > count;
  }

  const Scene& scene_;
  const GlassPart& part_;
  dvec3 across_{0.0};
  BoundsDouble box_;
  double size_ = 0.0;
  double thickness_ = 0.0;
  std::vector<Near> near_;
};

}  // namespace

std::map<std::string, size_t> thinOpenPanes(Scene& scene) {
  std::map<std::string, size_t> count;
  if (std::ranges::none_of(scene.materials, [](const Material& m) { return m.passesLight() && m.solid(); }))
    return count;
  std::map<uint32_t, uint32_t> copies;
  std::vector<uint32_t> thin;
  for (const GlassPart& part : openParts(scene)) {
    if (!PaneTest(scene, part).isPane()) continue;
    ++count[scene.materials[scene.triangles[part.triangles[0]].material].place];
    thin.insert(thin.end(), part.triangles.begin(), part.triangles.end());
  }
  for (const uint32_t i : thin) {
    uint32_t& material = scene.triangles[i].material;
    const auto [copy, isNew] = copies.try_emplace(material, uint32_t(scene.materials.size()));
    if (isNew) {
      scene.materials.push_back(scene.materials[material]);
      scene.materials.back().thicknessFactor = 0.0f;
    }
    material = copy->second;
  }
  return count;
}

}  // namespace fragtrace
