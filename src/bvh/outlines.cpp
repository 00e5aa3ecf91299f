// SPDX-License-Identifier: MIT
#include "bvh/outlines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/gtc/constants.hpp>

namespace fragtrace {

namespace {

/// Metres in front of the camera (of a perspective) where lines begin.
constexpr double kNearest = 1e-6;

glm::dvec2 placeOf(const glm::dvec3& p) { return glm::dvec2(p.x, p.y) / p.z; }

using Corners = std::array<glm::dvec3, 3>;

constexpr size_t kMostOutlined = 500'000;  // triangles
constexpr size_t kMostOutlineEdges = 40'000;
constexpr double kNearestOutlined = 1e-9;  // metres before the camera
constexpr int kSphereRings = 16;

bool isIn(const NodeSet& nodes, uint32_t node) { return node < nodes.size() && nodes[node]; }

/// Triangles that a node draws; through a matrix, if they are shared.
struct Part {
  size_t firstTriangle = 0;
  size_t triangleCount = 0;
  const glm::dmat4* toLocal = nullptr;
};

std::vector<Part> partsOf(const Scene& scene, const NodeSet& nodes) {
  std::vector<Part> parts;
  const uint32_t flat = flatTriangleCount(scene);
  for (const PrimitiveOrigin& origin : scene.origins) {
    if (origin.firstTriangle < flat && isIn(nodes, origin.nodeIndex))
      parts.push_back({origin.firstTriangle, origin.triangleCount, nullptr});
  }
  for (const Instance& instance : scene.instances) {
    const SharedMesh& mesh = scene.sharedMeshes[instance.mesh];
    if (isIn(nodes, instance.nodeIndex))
      parts.push_back({mesh.firstTriangle, mesh.triangleCount, &instance.toLocal});
  }
  return parts;
}

/// Calls `use` for each triangle in world space.
template <typename Use>
void useTriangles(const Scene& scene, const Part& part, const Use& use) {
  const size_t end = std::min(part.firstTriangle + part.triangleCount, scene.triangles.size());
  for (size_t i = part.firstTriangle; i < end; ++i) {
    Corners corners = cornersOf<glm::dvec3>(scene, scene.triangles[i]);
    for (glm::dvec3& corner : corners) {
      if (part.toLocal != nullptr) corner = glm::dvec3(*part.toLocal * glm::dvec4(corner, 1.0));
      corner = scene.space.worldOf(corner);
    }
    use(corners);
  }
}

/// Calls `use` for the triangles of a sphere, between rings around its poles.
template <typename Use>
void useSphere(const Scene& scene, const Sphere& sphere, const Use& use) {
  const auto at = [&](int ring, int step) {
    const double down = glm::pi<double>() * ring / kSphereRings;
    const double around = glm::pi<double>() * step / kSphereRings;
    const glm::dvec3 direction(std::sin(down) * std::cos(around), std::cos(down),
                               std::sin(down) * std::sin(around));
    return scene.space.worldOf(glm::dvec3(sphere.center) + double(sphere.radius) * direction);
  };
  for (int ring = 0; ring < kSphereRings; ++ring) {
    for (int step = 0; step < 2 * kSphereRings; ++step) {
      use(Corners{at(ring, step), at(ring + 1, step), at(ring + 1, step + 1)});
      use(Corners{at(ring, step), at(ring + 1, step + 1), at(ring, step + 1)});
    }
  }
}

template <typename Use>
void useAll(const Scene& scene, const NodeSet& nodes, std::span<const Part> parts, const Use& use) {
  for (const Part& part : parts) useTriangles(scene, part, use);
  for (const Sphere& sphere : scene.spheres) {
    if (isIn(nodes, sphere.nodeIndex)) useSphere(scene, sphere, use);
  }
}

/// The set of pixels whose middles are covered.
class Coverage {
 public:
  explicit Coverage(glm::ivec2 size) : size_(size), covered_(size_t(size.x) * size_t(size.y)) {}

  bool at(int x, int y) const { return covered_[size_t(y) * size_t(size_.x) + size_t(x)]; }

  /// Covers a convex polygon, in pixels from the top left.
  void fill(const std::vector<glm::dvec2>& corners) {
    double top = size_.y;
    double bottom = 0.0;
    for (const glm::dvec2& corner : corners) {
      top = std::min(top, corner.y);
      bottom = std::max(bottom, corner.y);
    }
    const int first = int(std::ceil(std::max(top, 0.0) - 0.5));
    const int end = int(std::ceil(std::min(bottom, double(size_.y)) - 0.5));
    for (int y = std::max(first, 0); y < std::min(end, size_.y); ++y) fillRow(corners, y);
  }

 private:
  void fillRow(const std::vector<glm::dvec2>& corners, int y) {
    const double middle = y + 0.5;
    double left = size_.x;
    double right = 0.0;
    for (size_t i = 0; i < corners.size(); ++i) {
      const glm::dvec2& a = corners[i];
      const glm::dvec2& b = corners[(i + 1) % corners.size()];
      if ((a.y <= middle) == (b.y <= middle)) continue;
      // From the upper end, so that polygons on both sides of an edge find the same place: no pixel is
      // between them.
      const auto& [upper, lower] = std::minmax(a, b, [](const auto& p, const auto& q) { return p.y < q.y; });
      const double x = upper.x + (lower.x - upper.x) * (middle - upper.y) / (lower.y - upper.y);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    const int begin = int(std::ceil(std::max(left, 0.0) - 0.5));
    const int end = int(std::ceil(std::min(right, double(size_.x)) - 0.5));
    for (int x = std::max(begin, 0); x < end; ++x) covered_[size_t(y) * size_t(size_.x) + size_t(x)] = true;
  }

  glm::ivec2 size_;
  std::vector<bool> covered_;
};

/// The triangle as its place in the picture, in pixels from the top left, cut off at the camera.
void placeTriangle(const Corners& corners, const Projection& projection, glm::ivec2 size,
                   std::vector<glm::dvec2>& polygon) {
  std::array<glm::dvec3, 3> points;
  for (size_t i = 0; i < 3; ++i) points[i] = projected(projection, corners[i]);
  polygon.clear();
  const auto add = [&](const glm::dvec3& p) {
    polygon.emplace_back(glm::dvec2(0.5 + 0.5 * p.x / p.z, 0.5 - 0.5 * p.y / p.z) * glm::dvec2(size));
  };
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3& a = points[i];
    const glm::dvec3& b = points[(i + 1) % 3];
    const bool before = a.z >= kNearestOutlined;
    if (before) add(a);
    if (before != (b.z >= kNearestOutlined)) add(glm::mix(a, b, (kNearestOutlined - a.z) / (b.z - a.z)));
  }
}

/// Runs of edges between covered and other pixels: along x where `across` is 0, along y where it is 1.
void addEdges(const Coverage& coverage, glm::ivec2 size, int across, std::vector<PictureLine>& lines) {
  const int along = 1 - across;
  const auto at = [&](int u, int v) { return across == 0 ? coverage.at(u, v) : coverage.at(v, u); };
  const int length = across == 0 ? size.x : size.y;
  const auto place = [&](int u, int v) {
    glm::dvec2 pixel;
    pixel[across] = u;
    pixel[along] = v;
    return glm::dvec2(2.0 * pixel.x / size.x - 1.0, 1.0 - 2.0 * pixel.y / size.y);
  };
  const int rows = across == 0 ? size.y : size.x;
  for (int v = 1; v < rows; ++v) {
    for (int u = 0; u < length; ++u) {
      const bool inside = at(u, v);
      if (inside == at(u, v - 1)) continue;
      const int begin = u;
      while (u + 1 < length && at(u + 1, v) == inside && at(u + 1, v - 1) != inside) ++u;
      lines.push_back({place(begin, v), place(u + 1, v)});
    }
  }
}

}  // namespace

std::vector<Bounds> boxesAtLevel(const Bvh& bvh, uint32_t level) {
  if (bvh.wide.empty()) return {};
  Bounds root = bvh.nodes[0].bounds[0];
  root.include(bvh.nodes[0].bounds[1]);
  std::vector<Bounds> boxes{root};
  std::vector<uint32_t> nodes{0};
  for (uint32_t l = 0; l < level; ++l) {
    std::vector<uint32_t> next;
    boxes.clear();
    for (const uint32_t index : nodes) {
      const WideNode& node = bvh.wide[index];
      if (showsInstance(bvh, node)) continue;
      for (uint32_t i = 0; i < node.count; ++i) {
        boxes.push_back(boxAt(bvh, node.place[i]));
        if (i < node.innerCount) next.push_back(node.firstInner + i);
      }
    }
    nodes = std::move(next);
  }
  return boxes;
}

std::vector<PictureLine> boxEdges(std::span<const Bounds> boxes, const Projection& projection,
                                  const LocalSpace& space) {
  std::vector<PictureLine> lines;
  lines.reserve(12 * boxes.size());
  for (const Bounds& box : boxes) {
    std::array<glm::dvec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
      const glm::dvec3 corner((i & 1u) != 0 ? box.maximum.x : box.minimum.x,
                              (i & 2u) != 0 ? box.maximum.y : box.minimum.y,
                              (i & 4u) != 0 ? box.maximum.z : box.minimum.z);
      corners[i] = projected(projection, space.worldOf(corner));
    }
    for (unsigned i = 0; i < 8; ++i) {
      for (const unsigned axis : {1u, 2u, 4u}) {
        if ((i & axis) != 0) continue;
        glm::dvec3 a = corners[i];
        glm::dvec3 b = corners[i | axis];
        if (a.z < b.z) std::swap(a, b);
        if (!(a.z > kNearest)) continue;
        // Before the division all is linear, so the part behind the camera is cut off here.
        if (b.z < kNearest) b = glm::mix(a, b, (a.z - kNearest) / (a.z - b.z));
        lines.push_back({placeOf(a), placeOf(b)});
      }
    }
  }
  return lines;
}

NodeSet nodesBelow(const Scene& scene, uint32_t node) {
  NodeSet nodes;
  const auto root = std::ranges::find(scene.nodes, node, &SceneNode::index);
  for (auto n = root; n != scene.nodes.end() && (n == root || n->depth > root->depth); ++n) {
    if (nodes.size() <= n->index) nodes.resize(n->index + 1);
    nodes[n->index] = true;
  }
  return nodes;
}

BoundsDouble boundsOfNodes(const Scene& scene, const NodeSet& nodes) {
  BoundsDouble box;
  useAll(scene, nodes, partsOf(scene, nodes), [&](const Corners& corners) {
    for (const glm::dvec3& corner : corners) box.include(corner);
  });
  return box;
}

std::vector<PictureLine> outlineOfNodes(const Scene& scene, const NodeSet& nodes,
                                        const Projection& projection, glm::ivec2 size) {
  const std::vector<Part> parts = partsOf(scene, nodes);
  size_t count = 0;
  for (const Part& part : parts) count += part.triangleCount;
  if (count > kMostOutlined) return {};
  Coverage coverage(size);
  std::vector<glm::dvec2> polygon;
  useAll(scene, nodes, parts, [&](const Corners& corners) {
    placeTriangle(corners, projection, size, polygon);
    coverage.fill(polygon);
  });
  std::vector<PictureLine> lines;
  addEdges(coverage, size, 0, lines);
  addEdges(coverage, size, 1, lines);
  return lines.size() <= kMostOutlineEdges ? lines : std::vector<PictureLine>();
}

}  // namespace fragtrace
