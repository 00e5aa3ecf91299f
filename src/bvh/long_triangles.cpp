// SPDX-License-Identifier: MIT
#include "bvh/long_triangles.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace fragtrace {
namespace {

using TriangleCorners = std::array<glm::dvec3, 3>;

/// A piece that may be cut, and the area that boxes lose by it.
struct PieceCut {
  double gain = 0.0;
  uint32_t item = 0;
  int axis = 0;
  double place = 0.0;

  bool operator<(const PieceCut& other) const {
    return gain != other.gain ? gain < other.gain : item > other.item;
  }
};

bool mayBeCut(const Material& m) { return !m.testsAlpha() && !m.transmissive() && !m.emissive(); }

/// The box of a long triangle has many times the area of its two sides.
bool isLong(const TriangleCorners& corners, const Bounds& box) {
  constexpr double kLeast = 16.0;
  const auto& [a, b, c] = corners;
  return areaOf(box) > kLeast * glm::length(glm::cross(b - a, c - a));
}

std::vector<uint32_t> longTriangles(const Scene& scene, std::span<const Bounds> boxes, const Bounds& all,
                                    double leastMet) {
  std::vector<uint32_t> found;
  double area = 0.0;
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const Triangle& t = scene.triangles[i];
    if (!mayBeCut(scene.materials[t.material]) || !isLong(cornersOf<glm::dvec3>(scene, t), boxes[i]))
      continue;
    found.push_back(i);
    area += areaOf(boxes[i]);
  }
  if (area < leastMet * areaOf(all)) found.clear();
  return found;
}

/// The first of the planes that halve a range again and again which lies between `low` and `high`.
double halvingPlane(double low, double high, double begin, double end) {
  for (;;) {
    const double middle = 0.5 * (begin + end);
    if ((middle > low && middle < high) || middle <= begin || middle >= end) return middle;
    (middle <= low ? begin : end) = middle;
  }
}

/// The box of a triangle between two planes across an axis, within another box of it. It is larger by what
/// rounding moves a hit: that goes with the size of the whole triangle (docs/design/numerics.md, Boxes).
Bounds boxBetween(const TriangleCorners& corners, const Bounds& within, int axis, double low, double high) {
  constexpr double kRounding = 16.0 * 0x1p-24;
  constexpr float kFar = std::numeric_limits<float>::infinity();
  BoxOf<glm::dvec3> part;
  BoxOf<glm::dvec3> whole;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3& a = corners[i];
    const glm::dvec3& b = corners[(i + 1) % 3];
    whole.include(a);
    if (a[axis] >= low && a[axis] <= high) part.include(a);
    for (const double plane : {low, high}) {
      if ((a[axis] < plane) == (b[axis] < plane)) continue;
      glm::dvec3 p = glm::mix(a, b, (plane - a[axis]) / (b[axis] - a[axis]));
      p[axis] = plane;
      part.include(p);
    }
  }
  const glm::dvec3 extent = whole.extent();
  const double margin = kRounding * std::max({extent.x, extent.y, extent.z});
  Bounds box;
  for (int i = 0; i < 3; ++i) {
    box.minimum[i] = std::max(std::nextafter(float(part.minimum[i] - margin), -kFar), within.minimum[i]);
    box.maximum[i] = std::min(std::nextafter(float(part.maximum[i] + margin), kFar), within.maximum[i]);
  }
  return box;
}

/// Both halves of a piece that is cut.
std::array<Bounds, 2> halvesOf(const TriangleCorners& corners, const Bounds& box, int axis, double place) {
  return {boxBetween(corners, box, axis, double(box.minimum[axis]), place),
          boxBetween(corners, box, axis, place, double(box.maximum[axis]))};
}

/// The cut of a piece across its longest axis.
PieceCut cutOfPiece(const Scene& scene, const BuildItem& piece, uint32_t item, const Bounds& all) {
  const TriangleCorners corners = cornersOf<glm::dvec3>(scene, scene.triangles[piece.primitive]);
  const glm::vec3 extent = piece.bounds.extent();
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const double place = halvingPlane(piece.bounds.minimum[axis], piece.bounds.maximum[axis], all.minimum[axis],
                                    all.maximum[axis]);
  const auto [first, second] = halvesOf(corners, piece.bounds, axis, place);
  return {areaOf(piece.bounds) - areaOf(first) - areaOf(second), item, axis, place};
}

}  // namespace

std::vector<BuildItem> cutLong(const Scene& scene, std::span<const Bounds> primitiveBounds, double leastMet) {
  std::vector<BuildItem> items;
  Bounds all;
  for (const Bounds& box : primitiveBounds) all.include(box);
  const std::vector<uint32_t> found = longTriangles(scene, primitiveBounds, all, leastMet);
  if (found.empty()) return items;
  const auto most = size_t(double(primitiveBounds.size()) * kMostPieces);
  items.reserve(most);
  for (uint32_t i = 0; i < primitiveBounds.size(); ++i) items.push_back({primitiveBounds[i], i});
  std::priority_queue<PieceCut> cuts;
  const auto offer = [&](uint32_t item) {
    const PieceCut cut = cutOfPiece(scene, items[item], item, all);
    if (cut.gain > 0.0) cuts.push(cut);
  };
  for (const uint32_t item : found) offer(item);
  while (items.size() < most && !cuts.empty()) {
    const PieceCut best = cuts.top();
    cuts.pop();
    BuildItem& piece = items[best.item];
    const TriangleCorners corners = cornersOf<glm::dvec3>(scene, scene.triangles[piece.primitive]);
    const auto [first, second] = halvesOf(corners, piece.bounds, best.axis, best.place);
    const uint32_t primitive = piece.primitive;
    piece.bounds = first;
    items.push_back({second, primitive});
    offer(best.item);
    offer(uint32_t(items.size() - 1));
  }
  return items;
}

}  // namespace fragtrace
