// SPDX-License-Identifier: MIT
#include "scene/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include <glm/gtc/constants.hpp>
#include <glm/gtx/norm.hpp>

#include "base/errors.h"
#include "base/vectors.h"
#include "scene/camera.h"
#include "scene/parts.h"

namespace fragtrace {

namespace {

/// Appends points around the sphere, a little outside, so that their hull holds it.
void appendSphere(const glm::dvec3& center, double radius, std::vector<glm::dvec3>& points) {
  constexpr double kOutside = 1.01;
  for (const glm::dvec3& direction : directionsAllAround())
    points.push_back(center + kOutside * radius * direction);
}

/// What is framed of a scene: by default all, else nodes, or else materials.
struct FramedPart {
  std::vector<bool> nodes{};      ///< by their place in the file
  std::vector<bool> materials{};  ///< by index

  bool hasNode(uint32_t index) const { return nodes.empty() || (index < nodes.size() && nodes[index]); }
  bool hasMaterial(uint32_t index) const { return materials.empty() || materials[index]; }
};

/// Marks the nodes that are called so, with all below them. Returns none if there is no such node.
std::vector<bool> nodesCalled(const Scene& scene, const auto& isIt) {
  std::vector<bool> marked;
  int depth = -1;  // of the node called so that the next nodes may be below
  for (const SceneNode& node : scene.nodes) {
    if (depth >= 0 && node.depth <= depth) depth = -1;
    if (depth < 0 && isIt(node.name)) depth = node.depth;
    if (depth < 0) continue;
    if (marked.size() <= node.index) marked.resize(node.index + 1, false);
    marked[node.index] = true;
  }
  return marked;
}

/// Throws UsageError.
FramedPart partCalled(const Scene& scene, const std::string& name) {
  FramedPart part;
  if (name.empty()) return part;
  const auto isSame = [&](const std::string& other) { return other == name; };
  const auto isAlike = [&](const std::string& other) { return isSameButForCase(other, name); };
  const auto find = [&](const auto& isIt) {
    part.nodes = nodesCalled(scene, isIt);
    if (!part.nodes.empty()) return true;
    std::vector<bool> marked;
    for (const Material& material : scene.materials) marked.push_back(isIt(material.name));
    if (std::ranges::find(marked, true) == marked.end()) return false;
    part.materials = std::move(marked);
    return true;
  };
  if (find(isSame) || find(isAlike)) return part;
  std::vector<std::string> names;
  for (const SceneNode& node : scene.nodes) names.push_back(node.name);
  for (const Material& material : scene.materials) names.push_back(material.name);
  throw UsageError("--fit-to: " + inQuotes(name) + " is no node and no material of the scene, which has " +
                   nearestInQuotes(names, name) + "; `fragtrace info --nodes` lists all");
}

/// The vertices of those of these triangles that are framed, each once.
std::vector<glm::dvec3> verticesOf(const Scene& scene, size_t first, size_t count,
                                   const FramedPart& part = {}) {
  std::vector<uint32_t> used;
  used.reserve(3 * count);
  for (size_t i = first; i < first + count; ++i) {
    if (!part.hasMaterial(scene.triangles[i].material)) continue;
    for (int c = 0; c < 3; ++c) used.push_back(scene.triangles[i].vertex[c]);
  }
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<glm::dvec3> points;
  points.reserve(used.size());
  for (const uint32_t vertex : used) points.emplace_back(scene.vertices.position[vertex]);
  return points;
}

std::vector<glm::dvec3> cornersOfBox(std::span<const glm::dvec3> points) {
  BoundsDouble box;
  for (const glm::dvec3& point : points) box.include(point);
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < 8 && !box.empty(); ++i) {
    corners.emplace_back((i & 1) != 0 ? box.maximum.x : box.minimum.x,
                         (i & 2) != 0 ? box.maximum.y : box.minimum.y,
                         (i & 4) != 0 ? box.maximum.z : box.minimum.z);
  }
  return corners;
}

/// The vertices of all triangles that no instance shows, as far as they are framed.
std::vector<glm::dvec3> flatVertices(const Scene& scene, const FramedPart& part) {
  const size_t count = flatTriangleCount(scene) - scene.strokeTriangles;
  if (part.nodes.empty()) return verticesOf(scene, 0, count, part);
  std::vector<glm::dvec3> points;
  for (const PrimitiveOrigin& origin : scene.origins) {
    const bool isFlat = size_t(origin.firstTriangle) + origin.triangleCount <= count;
    if (isFlat && part.hasNode(origin.nodeIndex))
      std::ranges::copy(verticesOf(scene, origin.firstTriangle, origin.triangleCount),
                        std::back_inserter(points));
  }
  return points;
}

void appendInstances(const Scene& scene, const FramedPart& part, std::vector<glm::dvec3>& points) {
  constexpr size_t kMostPoints = 5'000'000;
  std::vector<std::vector<glm::dvec3>> meshes;
  for (const SharedMesh& mesh : scene.sharedMeshes)
    meshes.push_back(verticesOf(scene, mesh.firstTriangle, mesh.triangleCount, part));
  size_t count = 0;
  for (const Instance& instance : scene.instances) count += meshes[instance.mesh].size();
  if (count > kMostPoints) {
    for (std::vector<glm::dvec3>& mesh : meshes) mesh = cornersOfBox(mesh);
  }
  for (const Instance& instance : scene.instances) {
    if (!part.hasNode(instance.nodeIndex)) continue;
    for (const glm::dvec3& point : meshes[instance.mesh])
      points.push_back(scene.space.worldOf(glm::dvec3(instance.toLocal * glm::dvec4(point, 1.0))));
  }
}

/// The axes of the view, right, up and depth, from the camera.
struct ViewAxes {
  glm::dvec3 right;
  glm::dvec3 up;
  glm::dvec3 forward;

  explicit ViewAxes(const Camera& camera)
      : right(glm::normalize(glm::cross(camera.forward, camera.up))),
        up(glm::cross(right, camera.forward)),
        forward(camera.forward) {}

  glm::dvec3 of(const glm::dvec3& v) const {
    return {glm::dot(v, right), glm::dot(v, up), glm::dot(v, forward)};
  }
  glm::dvec3 worldOf(const glm::dvec3& v) const { return v.x * right + v.y * up + v.z * forward; }
};

/// The place of a perspective camera that puts all points between two planes through it, of slope `slope` to
/// both sides: the depth of the place nearest to the points, and its position across.
struct Wedge {
  double depth = 0.0;
  double across = 0.0;
};

Wedge wedgeAbout(std::span<const glm::dvec3> points, int axis, double slope) {
  double right = -std::numeric_limits<double>::infinity();
  double left = right;
  for (const glm::dvec3& p : points) {
    right = std::max(right, p[axis] - slope * p.z);
    left = std::max(left, -p[axis] - slope * p.z);
  }
  return {-(right + left) / (2.0 * slope), (right - left) / 2.0};
}

/// The place across, at that depth, from which the points reach equally far to both sides (Newton's method on
/// the difference of the two).
double middleAcross(std::span<const glm::dvec3> points, int axis, double depth, double across) {
  constexpr int kRounds = 12;
  for (int i = 0; i < kRounds; ++i) {
    double most = -std::numeric_limits<double>::infinity();
    double least = -most;
    double slope = 0.0;
    double inverseOfMost = 0.0;
    double inverseOfLeast = 0.0;
    for (const glm::dvec3& p : points) {
      const double inverse = 1.0 / (p.z - depth);
      slope = (p[axis] - across) * inverse;
      if (slope > most) {
        most = slope;
        inverseOfMost = inverse;
      }
      if (slope < least) {
        least = slope;
        inverseOfLeast = inverse;
      }
    }
    across += (most + least) / (inverseOfMost + inverseOfLeast);
  }
  return across;
}

/// The place of the camera, not beyond `mostDepth`.
glm::dvec3 perspectivePlace(std::span<const glm::dvec3> points, const glm::dvec2& slope, double mostDepth) {
  glm::dvec3 place(0.0);
  const std::array<Wedge, 2> wedges{wedgeAbout(points, 0, slope.x), wedgeAbout(points, 1, slope.y)};
  place.z = std::min({wedges[0].depth, wedges[1].depth, mostDepth});
  for (int axis = 0; axis < 2; ++axis) {
    const Wedge& wedge = wedges[size_t(axis)];
    // From farther away than necessary, the points are between the planes too, but not in the middle.
    place[axis] = wedge.depth > place.z ? middleAcross(points, axis, place.z, wedge.across) : wedge.across;
  }
  return place;
}

}  // namespace

std::vector<glm::dvec3> directionsAllAround() {
  constexpr int kDirections = 512;
  const double goldenAngle = glm::pi<double>() * (3.0 - std::sqrt(5.0));
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < kDirections; ++i) {
    const double y = 1.0 - 2.0 * (i + 0.5) / kDirections;
    const double r = std::sqrt(1.0 - y * y);
    directions.emplace_back(r * std::cos(goldenAngle * i), y, r * std::sin(goldenAngle * i));
  }
  return directions;
}

std::vector<glm::dvec3> outlineOf(const Scene& scene, const std::string& name) {
  const FramedPart part = partCalled(scene, name);
  const auto isFramed = [&](const auto& item) {
    return part.hasNode(item.nodeIndex) && part.hasMaterial(item.material);
  };
  std::vector<glm::dvec3> points = flatVertices(scene, part);
  for (const Strokes& strokes : scene.strokes) {
    if (!isFramed(strokes)) continue;
    for (const glm::uvec2& ends : strokes.ends) {
      points.emplace_back(scene.vertices.position[ends.x]);
      points.emplace_back(scene.vertices.position[ends.y]);
    }
  }
  for (glm::dvec3& point : points) point = scene.space.worldOf(point);
  appendInstances(scene, part, points);
  for (const Sphere& sphere : scene.spheres) {
    if (isFramed(sphere))
      appendSphere(scene.space.worldOf(glm::dvec3(sphere.center)), scene.space.unit * sphere.radius, points);
  }
  if (!name.empty() && points.empty())
    throw UsageError("--fit-to: " + inQuotes(name) + " has nothing that is shown");
  if (scene.volume.grid && name.empty())
    std::ranges::copy(scene.volume.corners(), std::back_inserter(points));
  return points;
}

std::vector<glm::dvec3> withoutStrays(std::vector<glm::dvec3> points) {
  constexpr size_t kShare = 100;
  constexpr double kDot = 1.0 / 16.0;  // share of the size
  const size_t strays = points.size() / kShare;
  if (strays == 0) return points;
  glm::dvec3 middle(0.0);
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(points, values.begin(), [&](const glm::dvec3& p) { return p[axis]; });
    const auto half = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::ranges::nth_element(values, half);
    middle[axis] = *half;
  }
  const auto nearer = [&](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::distance2(a, middle) < glm::distance2(b, middle);
  };
  std::vector<glm::dvec3> kept = points;
  const auto last = kept.end() - std::ptrdiff_t(strays);
  std::ranges::nth_element(kept, last, nearer);
  kept.erase(last, kept.end());
  const auto sizeOf = [](std::span<const glm::dvec3> some) {
    BoundsDouble bounds;
    for (const glm::dvec3& p : some) bounds.include(p);
    return glm::length(bounds.extent());
  };
  return sizeOf(kept) < kDot * sizeOf(points) ? kept : points;
}

std::vector<glm::dvec3> farthest(std::vector<glm::dvec3> points) {
  constexpr size_t kFew = 4096;
  if (points.size() <= kFew) return points;
  constexpr size_t kBlock = 64;  // points that follow each other, and are near each other in most meshes
  std::vector<BoundsDouble> blocks((points.size() + kBlock - 1) / kBlock);
  for (size_t i = 0; i < points.size(); ++i) blocks[i / kBlock].include(points[i]);
  std::vector<glm::dvec3> hull;
  for (const glm::dvec3& direction : directionsAllAround()) {
    const auto along = [&](const glm::dvec3& point) { return glm::dot(point, direction); };
    size_t best = 0;
    for (size_t block = 0; block < blocks.size(); ++block) {
      const BoundsDouble& box = blocks[block];
      const glm::dvec3 corner =
          glm::mix(box.minimum, box.maximum, glm::greaterThan(direction, glm::dvec3(0)));
      // Rounding keeps the order of products and sums, so no point of the box is farther than its corner.
      if (along(corner) <= along(points[best])) continue;
      for (size_t i = block * kBlock; i < std::min((block + 1) * kBlock, points.size()); ++i)
        if (along(points[i]) > along(points[best])) best = i;
    }
    hull.push_back(points[best]);
  }
  return hull;
}

std::vector<glm::dvec3> sweptAbout(const glm::dvec3& point, std::span<const glm::dvec3> points) {
  // Only the hull of the profile, distance from the axis over height, counts (Andrew's monotone chain).
  std::vector<glm::dvec2> profile;  // height, distance
  profile.reserve(points.size());
  for (const glm::dvec3& p : points) profile.emplace_back(p.y, std::hypot(p.x - point.x, p.z - point.z));
  std::ranges::sort(profile, [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  std::vector<glm::dvec2> hull;
  for (const glm::dvec2& p : profile) {
    const auto turnsLeft = [&] {
      const glm::dvec2 a = hull[hull.size() - 1] - hull[hull.size() - 2];
      const glm::dvec2 b = p - hull[hull.size() - 1];
      return a.x * b.y - a.y * b.x >= 0.0;
    };
    while (hull.size() >= 2 && turnsLeft()) hull.pop_back();
    hull.push_back(p);
  }
  constexpr int kSteps = 256;
  const double outside = 1.0 / std::cos(glm::pi<double>() / kSteps);
  std::vector<glm::dvec3> swept;
  swept.reserve(hull.size() * kSteps);
  for (const glm::dvec2& p : hull) {
    for (int i = 0; i < kSteps; ++i) {
      const double angle = 2.0 * glm::pi<double>() * i / kSteps;
      swept.emplace_back(point.x + outside * p.y * std::sin(angle), p.x,
                         point.z + outside * p.y * std::cos(angle));
    }
  }
  return swept;
}

Camera fitted(Camera camera, std::span<const glm::dvec3> points, double aspectRatio, double share) {
  BoundsDouble bounds;
  const ViewAxes axes(camera);
  std::vector<glm::dvec3> seen;
  seen.reserve(points.size());
  const bool perspective = camera.type == CameraType::Perspective;
  // A shifted lens sees a pyramid that is sheared: so are the points, and the place is sheared back.
  const glm::dvec2 shift = 2.0 * camera.shift;
  const glm::dvec2 shear = perspective ? shift * halfExtents(camera, aspectRatio, 1.0) : glm::dvec2(0.0);
  for (const glm::dvec3& point : points) {
    const glm::dvec3 view = axes.of(point - camera.position);
    seen.emplace_back(glm::dvec2(view) - shear * view.z, view.z);
    bounds.include(seen.back());
  }
  const double size = glm::length(bounds.extent());
  if (!(size > 0.0)) return camera;
  glm::dvec3 place = bounds.center();
  if (perspective) {
    // A flat scene that is seen from its edge has neither width nor height, and a tip may reach up to the
    // lens.
    constexpr double kNearest = 0.01;  // share of the size
    const double slope = std::tan(0.5 * camera.fovY) * share;
    place = perspectivePlace(seen, {slope * aspectRatio, slope}, bounds.minimum.z - kNearest * size);
    place += glm::dvec3(shear * place.z, 0.0);
  } else {
    const glm::dvec3 half = 0.5 * bounds.extent();
    camera.halfHeight = std::max({half.y, half.x / aspectRatio, 1e-6 * size}) / share;
    place.z = bounds.minimum.z - size;
    place -= glm::dvec3(shift * halfExtents(camera, aspectRatio, 1.0), 0.0);
  }
  camera.position += axes.worldOf(place);
  return camera;
}

namespace {

using Polygon = std::vector<glm::dvec2>;

double turnOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The convex hull, counter-clockwise (Andrew's monotone chain).
Polygon hullOf(Polygon points) {
  std::ranges::sort(points, [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  Polygon hull;
  const auto append = [&](const glm::dvec2& p, size_t begin) {
    while (hull.size() >= begin + 2 && turnOf(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
    hull.push_back(p);
  };
  for (const glm::dvec2& p : points) append(p, 0);
  const size_t lower = hull.empty() ? 0 : hull.size() - 1;
  for (size_t i = points.size(); i-- > 0;) append(points[i], lower);
  if (hull.size() > 1) hull.pop_back();
  return hull;
}

bool holds(const Polygon& hull, const glm::dvec2& p) {
  for (size_t i = 0; i < hull.size(); ++i) {
    if (turnOf(hull[i], hull[(i + 1) % hull.size()], p) < 0.0) return false;
  }
  return hull.size() > 2;
}

/// One light's shadow, X and Z.
struct Shadow {
  Polygon hull;
  double share = 0.0;  ///< share of all light
};

/// Points below the plane cast no shadow on it, nor do points at or above the height of a lamp.
Polygon thrown(std::span<const glm::dvec3> points, double height, const PlaneLight& light) {
  Polygon places;
  for (const glm::dvec3& p : points) {
    const glm::dvec3 towards = light.isPlace ? light.from - p : light.from;
    if (p.y < height || !(towards.y > 0.0)) continue;
    const glm::dvec3 place = p - towards * ((p.y - height) / towards.y);
    places.emplace_back(place.x, place.z);
  }
  return hullOf(std::move(places));
}

}  // namespace

std::vector<glm::dvec3> shadowOutline(std::span<const glm::dvec3> points, double height,
                                      std::span<const PlaneLight> lights) {
  constexpr double kSeen = 0.1;  // share of the light that is missing
  constexpr int kAngles = 32;
  constexpr int kSteps = 24;
  double all = 0.0;
  for (const PlaneLight& light : lights) all += light.irradiance;
  std::vector<Shadow> shadows;
  for (const PlaneLight& light : lights) {
    if (light.irradiance > 0.0) shadows.push_back({thrown(points, height, light), light.irradiance / all});
  }
  const auto missing = [&](const glm::dvec2& place) {
    double sum = 0.0;
    for (const Shadow& shadow : shadows) sum += holds(shadow.hull, place) ? shadow.share : 0.0;
    return sum;
  };
  glm::dvec3 lowest(std::numeric_limits<double>::infinity());
  glm::dvec3 highest = -lowest;
  for (const glm::dvec3& p : points) {
    lowest = glm::min(lowest, p);
    highest = glm::max(highest, p);
  }
  const glm::dvec3 middle = 0.5 * (lowest + highest);
  const double step = kShadowReach * glm::length(highest - lowest) / kSteps;
  std::vector<glm::dvec3> outline;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2.0 * glm::pi<double>() * i / kAngles;
    const glm::dvec2 direction(std::cos(angle), std::sin(angle));
    for (int k = kSteps; k >= 0; --k) {
      if (missing(glm::dvec2(middle.x, middle.z) + direction * (k * step)) <= kSeen) continue;
      const glm::dvec2 beyond = glm::dvec2(middle.x, middle.z) + direction * ((k + 1) * step);
      outline.emplace_back(beyond.x, height, beyond.y);
      break;
    }
  }
  return outline;
}

}  // namespace fragtrace
