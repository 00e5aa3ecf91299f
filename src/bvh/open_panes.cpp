// SPDX-License-Identifier: MIT
#include "bvh/open_panes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bvh/bvh.h"
#include "bvh/overlaps.h"
#include "scene/solids.h"

namespace fragtrace {

namespace {

using glm::dvec3;

constexpr double kNear = 1e-3;              ///< share of a part's size
constexpr double kThickestPane = 1.0 / 20;  ///< the same, of a pane
constexpr size_t kMostLookedAt = 64;        ///< places of a part that are looked at

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

struct Near {
  std::array<dvec3, 3> corners;
  bool isOwn;
};

/// Tells of a part whether it is a pane.
class PaneTest {
 public:
  PaneTest(const Scene& scene, const SolidPart& part) : scene_(scene), part_(part) {
    for (const uint32_t i : part.triangles) {
      const auto corners = cornersOf<dvec3>(scene, scene.triangles[i]);
      across_ += glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      for (const dvec3& corner : corners) box_.include(corner);
    }
    size_ = glm::length(box_.extent());
    thickness_ = double(scene.materials[part.material].thicknessFactor) / scene.space.unit;
  }

  /// The box of what is near enough to count.
  Bounds reach() const {
    const dvec3 reach(std::max(kNear * size_, std::min(thickness_, size_)));
    return {glm::vec3(box_.minimum - reach), glm::vec3(box_.maximum + reach)};
  }

  void addNear(uint32_t triangle) {
    near_.push_back({cornersOf<dvec3>(scene_, scene_.triangles[triangle]),
                     std::ranges::binary_search(part_.triangles, triangle)});
  }

  const SolidPart& part() const { return part_; }

  bool isPane() const {
    const bool isFlat = thickness_ <= kThickestPane * size_ && flatness() <= thickness_;
    return (isFlat || hangsFree()) && !liesOverBed();
  }

 private:
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
      const dvec3 a(scene_.vertices.position[part_.open[i][0]]);
      const dvec3 b(scene_.vertices.position[part_.open[i][1]]);
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
  const SolidPart& part_;
  dvec3 across_{0.0};
  BoundsDouble box_;
  double size_ = 0.0;
  double thickness_ = 0.0;
  std::vector<Near> near_;
};

/// The tests of open parts, which know what is near.
std::vector<PaneTest> testsOf(const Scene& scene, const std::vector<SolidPart>& parts) {
  std::vector<PaneTest> tests;
  std::vector<Bounds> reaches;
  for (const SolidPart& part : parts) {
    if (part.open.empty()) continue;
    tests.emplace_back(scene, part);
    reaches.push_back(tests.back().reach());
  }
  if (tests.empty()) return tests;
  const Bvh bvh = buildBvh(std::move(reaches), uint32_t(tests.size()));
  for (uint32_t i = 0; i < flatTriangleCount(scene); ++i)
    meetAll(bvh, triangleBounds(scene, i), [&](uint32_t test) { tests[test].addNear(i); });
  return tests;
}

}  // namespace

std::map<std::string, size_t> thinOpenPanes(Scene& scene, std::vector<SolidPart>& parts) {
  std::map<std::string, size_t> count;
  std::map<uint32_t, uint32_t> copies;
  for (const PaneTest& test : testsOf(scene, parts)) {
    if (!test.isPane()) continue;
    const uint32_t material = test.part().material;
    ++count[scene.materials[material].place];
    const auto [copy, isNew] = copies.try_emplace(material, uint32_t(scene.materials.size()));
    if (isNew) {
      scene.materials.push_back(scene.materials[material]);
      scene.materials.back().thicknessFactor = 0.0f;
    }
    for (const uint32_t triangle : test.part().triangles) scene.triangles[triangle].material = copy->second;
  }
  std::erase_if(parts, [&](const SolidPart& part) {
    return scene.triangles[part.triangles[0]].material != part.material;
  });
  return count;
}

}  // namespace fragtrace
