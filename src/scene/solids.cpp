// SPDX-License-Identifier: MIT
#include "scene/solids.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <numeric>
#include <utility>

#include "scene/creases.h"
#include "scene/scene.h"

namespace fragtrace {

namespace {

using Corners = std::array<glm::vec3, 3>;

bool boundsSolids(const Material& m) { return m.solid() && m.passesLight(); }

/// An edge of a triangle from the lower of its two places to the higher, or the other way round.
struct Edge {
  uint32_t low = 0, high = 0;
  uint32_t material = 0;
  uint32_t triangle = 0;
  bool forward = true;

  std::array<uint32_t, 3> key() const { return {low, high, material}; }
};

std::vector<Edge> edgesOf(const Scene& scene, const std::vector<uint32_t>& triangles) {
  const std::vector<uint32_t> places = placesOf(scene);
  std::vector<Edge> edges;
  edges.reserve(triangles.size() * 3);
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = scene.triangles[triangles[i]];
    for (int c = 0; c < 3; ++c) {
      const uint32_t from = places[t.vertex[c]];
      const uint32_t to = places[t.vertex[(c + 1) % 3]];
      if (from != to) edges.push_back({std::min(from, to), std::max(from, to), t.material, i, from < to});
    }
  }
  return edges;
}

/// Connected triangles as sets (disjoint-set forest).
class Sets {
 public:
  explicit Sets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<uint32_t> parent_;
};

/// Edges along which more triangles run one way than the other: as many of these as run too much.
std::vector<Edge> unmatched(std::vector<Edge> edges) {
  std::ranges::sort(edges, {}, &Edge::key);
  std::vector<Edge> left;
  for (size_t i = 0; i < edges.size();) {
    const size_t first = i;
    int balance = 0;
    for (; i < edges.size() && edges[i].key() == edges[first].key(); ++i)
      balance += edges[i].forward ? 1 : -1;
    for (size_t j = first; j < i && balance != 0; ++j) {
      if (edges[j].forward != (balance > 0)) continue;
      left.push_back(edges[j]);
      balance += balance > 0 ? -1 : 1;
    }
  }
  return left;
}

/// The edges with places of one set that rounding alone parts as one place: a seam of a sphere has places at
/// 0 and at 2 pi.
std::vector<Edge> withoutSeams(const Scene& scene, const std::vector<Edge>& edges, Sets& sets) {
  constexpr double kRounding = 1e-5;  // of the diagonal of the set's box
  std::map<uint32_t, Bounds> boxes;
  const auto at = [&](uint32_t place) { return scene.vertices.position[place]; };
  for (const Edge& e : edges) {
    Bounds& box = boxes[sets.find(e.triangle)];
    box.include(at(e.low));
    box.include(at(e.high));
  }
  using Cell = std::array<int64_t, 4>;
  std::map<Cell, uint32_t> cells;  // the place that stands for all of the cell
  const auto standIn = [&](uint32_t place, uint32_t set) {
    const Bounds& box = boxes[set];
    const double size = kRounding * glm::length(glm::dvec3(box.extent()));
    if (!(size > 0.0)) return place;
    const glm::dvec3 middle = (glm::dvec3(at(place)) - glm::dvec3(box.minimum)) / size;
    const auto cellAt = [&](const glm::dvec3& p) {
      return Cell{int64_t(set), int64_t(std::floor(p.x)), int64_t(std::floor(p.y)), int64_t(std::floor(p.z))};
    };
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 aside(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
      if (const auto found = cells.find(cellAt(middle + aside)); found != cells.end()) return found->second;
    }
    return cells[cellAt(middle)] = place;
  };
  std::vector<Edge> joined;
  for (const Edge& e : edges) {
    const uint32_t set = sets.find(e.triangle);
    const uint32_t from = standIn(e.forward ? e.low : e.high, set);
    const uint32_t to = standIn(e.forward ? e.high : e.low, set);
    if (from != to)
      joined.push_back({std::min(from, to), std::max(from, to), e.material, e.triangle, from < to});
  }
  return joined;
}

/// Triangles of the scene, `count` from `first` on, that bound solids.
std::vector<uint32_t> boundaries(const Scene& scene, size_t first, size_t count) {
  std::vector<uint32_t> found;
  for (size_t i = first; i < first + count; ++i)
    if (boundsSolids(scene.materials[scene.triangles[i].material])) found.push_back(uint32_t(i));
  return found;
}

/// Appends the closed parts of triangles of one space, and notes the materials of open ones.
void appendParts(const Scene& scene, size_t first, size_t count, Solids& solids) {
  for (const SolidPart& part : solidParts(scene, first, count)) {
    if (!part.open.empty()) solids.closed[part.material] = false;
    if (!part.open.empty()) continue;
    ClosedPart closed{part.material, {}, uint32_t(solids.triangles.size()), uint32_t(part.triangles.size())};
    for (const uint32_t i : part.triangles) {
      solids.triangles.push_back(cornersOf(scene, scene.triangles[i]));
      for (const glm::vec3& corner : solids.triangles.back()) closed.box.include(corner);
    }
    solids.parts.push_back(closed);
  }
}

/// The box of each material's solids in local space; empty where it has none.
std::vector<Bounds> boxesOf(const Scene& scene) {
  std::vector<Bounds> boxes(scene.materials.size());
  for (const uint32_t i : boundaries(scene, 0, flatTriangleCount(scene))) {
    for (const glm::vec3& corner : cornersOf(scene, scene.triangles[i]))
      boxes[scene.triangles[i].material].include(corner);
  }
  for (const Instance& instance : scene.instances) {
    const SharedMesh& mesh = scene.sharedMeshes[instance.mesh];
    for (const uint32_t i : boundaries(scene, mesh.firstTriangle, mesh.triangleCount)) {
      for (const glm::dvec3& corner : cornersOf<glm::dvec3>(scene, scene.triangles[i]))
        boxes[scene.triangles[i].material].include(glm::vec3(instance.toLocal * glm::dvec4(corner, 1.0)));
    }
  }
  for (const Sphere& s : scene.spheres) {
    if (!boundsSolids(scene.materials[s.material])) continue;
    boxes[s.material].include(s.center - s.radius);
    boxes[s.material].include(s.center + s.radius);
  }
  return boxes;
}

bool anyOverlap(const std::vector<Bounds>& boxes) {
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (size_t j = i + 1; j < boxes.size(); ++j)
      if (boxes[i].overlaps(boxes[j])) return true;
  }
  return false;
}

/// The solid angle of a triangle as seen from the origin, in sr; positive as seen from behind (van Oosterom
/// and Strackee, The Solid Angle of a Plane Triangle, 1983).
double solidAngle(const std::array<glm::dvec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const double x = glm::length(a);
  const double y = glm::length(b);
  const double z = glm::length(c);
  const double below = x * y * z + glm::dot(a, b) * z + glm::dot(a, c) * y + glm::dot(b, c) * x;
  return 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), below);
}

/// Returns how often the boundary of the part winds around a point of its space.
double windingNumber(const Solids& solids, const ClosedPart& part, const glm::dvec3& point) {
  const glm::dvec3 low(part.box.minimum);
  const glm::dvec3 high(part.box.maximum);
  if (glm::any(glm::lessThan(point, low)) || glm::any(glm::greaterThan(point, high))) return 0.0;
  if (part.count == 0) {
    const glm::dvec3 away = point - 0.5 * (low + high);
    const double radius = 0.5 * (high.x - low.x);
    return glm::dot(away, away) < radius * radius ? 1.0 : 0.0;
  }
  double sum = 0.0;
  for (uint32_t i = part.first; i < part.first + part.count; ++i) {
    const Corners& t = solids.triangles[i];
    sum += solidAngle({glm::dvec3(t[0]) - point, glm::dvec3(t[1]) - point, glm::dvec3(t[2]) - point});
  }
  return sum / (4.0 * glm::pi<double>());
}

/// Returns true if a part of the line between two points lies in the square -1..1.
bool crossesSquare(const glm::dvec2& a, const glm::dvec2& b) {
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double step = b[axis] - a[axis];
    if (step == 0.0 && std::abs(a[axis]) > 1.0) return false;
    if (step == 0.0) continue;
    const double low = (-1.0 - a[axis]) / step;
    const double high = (1.0 - a[axis]) / step;
    from = std::max(from, std::min(low, high));
    to = std::min(to, std::max(low, high));
  }
  return from <= to;
}

/// Returns true if the square -1..1 of the plane z = 0 crosses a triangle.
bool crossesTriangle(const std::array<glm::dvec3, 3>& corners) {
  std::vector<glm::dvec2> cut;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3& a = corners[i];
    const glm::dvec3& b = corners[(i + 1) % 3];
    if ((a.z < 0.0) != (b.z < 0.0)) cut.emplace_back(glm::mix(a, b, a.z / (a.z - b.z)));
  }
  return cut.size() == 2 && crossesSquare(cut[0], cut[1]);
}

bool crossesBall(const ClosedPart& ball, const Rectangle& rectangle) {
  const glm::dvec3 half(0.5f * ball.box.extent());
  const glm::dvec3 away = glm::dvec3(ball.box.center()) - rectangle.middle;
  const glm::dvec2 size(glm::length(rectangle.right), glm::length(rectangle.up));
  const glm::dvec2 place(glm::dot(away, rectangle.right) / size.x, glm::dot(away, rectangle.up) / size.y);
  const glm::dvec2 near = glm::max(glm::abs(place) - size, 0.0);
  const glm::dvec2 far = glm::abs(place) + size;
  const double above = glm::dot(away, away) - glm::dot(place, place);
  const double radius = half.x * half.x;
  return above + glm::dot(near, near) < radius && above + glm::dot(far, far) > radius;
}

}  // namespace

std::vector<SolidPart> solidParts(const Scene& scene, size_t first, size_t count) {
  const std::vector<uint32_t> triangles = boundaries(scene, first, count);
  if (triangles.empty()) return {};
  std::vector<Edge> edges = edgesOf(scene, triangles);
  std::ranges::sort(edges, {}, &Edge::key);
  Sets sets(triangles.size());
  for (size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].key() == edges[i - 1].key()) sets.join(edges[i].triangle, edges[i - 1].triangle);
  }
  std::vector<SolidPart> parts;
  std::vector<uint32_t> partOf(triangles.size(), kMissIndex);  // by set
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    uint32_t& part = partOf[sets.find(i)];
    if (part == kMissIndex) {
      part = uint32_t(parts.size());
      parts.push_back({scene.triangles[triangles[i]].material, {}, {}});
    }
    parts[part].triangles.push_back(triangles[i]);
  }
  for (const Edge& e : unmatched(withoutSeams(scene, unmatched(std::move(edges)), sets)))
    parts[partOf[sets.find(e.triangle)]].open.push_back({e.low, e.high});
  return parts;
}

Solids solidsOf(const Scene& scene) {
  Solids solids;
  if (std::ranges::none_of(scene.materials, boundsSolids)) return solids;
  for (const Material& m : scene.materials) solids.closed.push_back(boundsSolids(m));
  appendParts(scene, 0, flatTriangleCount(scene), solids);
  for (const Sphere& s : scene.spheres) {
    if (boundsSolids(scene.materials[s.material]))
      solids.parts.push_back({s.material, {s.center - s.radius, s.center + s.radius}, 0, 0});
  }
  solids.placed.push_back({glm::dmat4(1.0), 0, uint32_t(solids.parts.size())});
  std::vector<PlacedParts> meshes;
  for (const SharedMesh& mesh : scene.sharedMeshes) {
    const auto first = uint32_t(solids.parts.size());
    appendParts(scene, mesh.firstTriangle, mesh.triangleCount, solids);
    meshes.push_back({glm::dmat4(1.0), first, uint32_t(solids.parts.size()) - first});
  }
  for (const Instance& instance : scene.instances) {
    PlacedParts parts = meshes[instance.mesh];
    parts.toMesh = glm::inverse(instance.toLocal);
    if (parts.count > 0) solids.placed.push_back(parts);
  }
  constexpr size_t kMostNested = 0xffff;  // shaders/media/solids.glsl
  solids.boxes = boxesOf(scene);
  solids.nested = scene.materials.size() < kMostNested && anyOverlap(solids.boxes);
  return solids;
}

bool crossesSolid(const Solids& solids, const Rectangle& rectangle) {
  const auto& [middle, right, up] = rectangle;
  const glm::dmat4 fromPlane(glm::dvec4(right, 0.0), glm::dvec4(up, 0.0),
                             glm::dvec4(glm::normalize(glm::cross(right, up)), 0.0), glm::dvec4(middle, 1.0));
  for (const PlacedParts& placed : solids.placed) {
    const glm::dmat4 toPlane = glm::inverse(placed.toMesh * fromPlane);
    const auto inPlane = [&](const glm::vec3& corner) {
      return glm::dvec3(toPlane * glm::dvec4(corner, 1.0));
    };
    for (uint32_t i = placed.first; i < placed.first + placed.count; ++i) {
      const ClosedPart& part = solids.parts[i];
      if (part.count == 0 && crossesBall(part, rectangle)) return true;
      for (uint32_t k = part.first; k < part.first + part.count; ++k) {
        const Corners& t = solids.triangles[k];
        if (crossesTriangle({inPlane(t[0]), inPlane(t[1]), inPlane(t[2])})) return true;
      }
    }
  }
  return false;
}

std::vector<uint32_t> solidsAround(const Solids& solids, const glm::dvec3& point) {
  struct Around {
    uint32_t material;
    double winding;
    double size;  // volume of the smallest box around the point, local space
  };
  std::vector<Around> found;
  for (const PlacedParts& placed : solids.placed) {
    const glm::dvec3 there(placed.toMesh * glm::dvec4(point, 1.0));
    const double scale = std::abs(glm::determinant(glm::dmat3(placed.toMesh)));
    for (uint32_t i = placed.first; i < placed.first + placed.count; ++i) {
      const ClosedPart& part = solids.parts[i];
      const double winding = std::round(windingNumber(solids, part, there));
      if (winding == 0.0) continue;
      const glm::dvec3 extent(part.box.extent());
      const double size = winding > 0.0 ? extent.x * extent.y * extent.z / scale : INFINITY;
      const auto known = std::ranges::find(found, part.material, &Around::material);
      if (known == found.end()) {
        found.push_back({part.material, winding, size});
      } else {
        known->winding += winding;
        known->size = std::min(known->size, size);
      }
    }
  }
  std::erase_if(found, [](const Around& a) { return a.winding < 1.0; });
  std::ranges::sort(found, {}, &Around::size);
  std::vector<uint32_t> materials;
  materials.reserve(found.size());
  for (const Around& a : found) materials.push_back(a.material);
  return materials;
}

}  // namespace fragtrace
