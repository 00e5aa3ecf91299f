// SPDX-License-Identifier: MIT
#include "bvh/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "bvh/bvh.h"
#include "bvh/overlaps.h"
#include "scene/coincidence.h"
#include "scene/hit_error.h"
#include "scene/solids.h"

namespace fragtrace {

namespace {

using glm::dvec3;

/// The distance that such faces get, in units of the bound on a hit point's rounding error. An offset is 1 to
/// 1.25 units, and from either face the other one must still lie in front.
constexpr double kGap = 4.0;

/// Faces whose normals are less parallel meet at most in a line.
constexpr double kParallel = 0.99;

struct Face {
  std::array<dvec3, 3> corners;
  dvec3 normal{0.0};  // unit; zero where there is no area
  double error = 0.0;
};

Face faceOf(const std::array<dvec3, 3>& corners) {
  Face face{
      corners, {}, hitPointError({glm::vec3(corners[0]), glm::vec3(corners[1]), glm::vec3(corners[2])})};
  const auto& [a, b, c] = face.corners;
  const dvec3 across = glm::cross(b - a, c - a);
  const double length = glm::length(across);
  if (length > 0.0) face.normal = across / length;
  return face;
}

Face faceOf(const Scene& scene, uint32_t triangle) {
  return faceOf(cornersOf<dvec3>(scene, scene.triangles[triangle]));
}

/// The box of what lies nearer than so many errors.
Bounds boxAround(const Face& face, double errors) {
  Bounds around;
  for (const dvec3& c : face.corners) around.include(glm::vec3(c));
  const auto reach = float(errors * face.error);
  around.minimum -= reach;
  around.maximum += reach;
  return around;
}

/// Returns true if the two overlap as seen along their common normal: no edge separates them by more than
/// `least`.
bool overlap(const Face& a, const Face& b, double least) {
  for (const Face* of : {&a, &b}) {
    for (size_t i = 0; i < 3; ++i) {
      const dvec3 across = glm::cross(of->normal, of->corners[(i + 1) % 3] - of->corners[i]);
      const double length = glm::length(across);
      if (!(length > 0.0)) return false;
      const auto reach = [&](const Face& face) {
        const auto along = [&](size_t corner) { return glm::dot(across, face.corners[corner]) / length; };
        return std::minmax({along(0), along(1), along(2)});
      };
      const auto [lowA, highA] = reach(a);
      const auto [lowB, highB] = reach(b);
      if (!(std::min(highA, highB) - std::max(lowA, lowB) > least)) return false;
    }
  }
  return true;
}

/// The largest distance of corners from a plane.
double apart(const Face& plane, const Face& from) {
  double most = 0.0;
  for (const dvec3& c : from.corners)
    most = std::max(most, std::abs(glm::dot(plane.normal, c - plane.corners[0])));
  return most;
}

/// The direction and distance by which an opaque face is moved.
struct Move {
  dvec3 direction{0.0};
  double by = 0.0;
};

/// Moves the opaque face off the glass where the two touch.
Move moveOff(const Face& glass, bool solid, const Face& opaque) {
  const double gap = kGap * std::max(glass.error, opaque.error);
  if (!(std::abs(glm::dot(glass.normal, opaque.normal)) > kParallel)) return {};
  // If two faces are nearly parallel, the plane of the larger one decides.
  const bool byGlass = apart(glass, opaque) <= gap;
  if (!byGlass && !(apart(opaque, glass) <= gap)) return {};
  if (!overlap(glass, opaque, gap)) return {};
  const dvec3 direction = solid ? glass.normal : -opaque.normal;
  const dvec3 step = opaque.corners[0] - glass.corners[0];
  const dvec3& normal = byGlass ? glass.normal : opaque.normal;
  const double now = glm::dot(normal, step) * glm::dot(normal, direction);
  return {direction, gap - now};
}

/// Moves by place, so that faces that meet stay together.
class Moves {
 public:
  /// Moves the place in the move's direction, by at least its distance.
  void add(const glm::vec3& place, const Move& move) {
    dvec3& sum = moves_[keyOf(place)];
    sum += std::max(0.0, move.by - glm::dot(sum, move.direction)) * move.direction;
  }
  bool empty() const { return moves_.empty(); }
  /// Moves the corners of triangles.
  void apply(Scene& scene, const std::vector<uint32_t>& triangles) const {
    std::vector<bool> done(scene.vertices.position.size(), false);
    for (const uint32_t i : triangles) {
      for (int c = 0; c < 3; ++c) {
        const uint32_t vertex = scene.triangles[i].vertex[c];
        if (done[vertex]) continue;
        done[vertex] = true;
        glm::vec3& place = scene.vertices.position[vertex];
        place = moved(place);
      }
    }
  }

 private:
  glm::vec3 moved(const glm::vec3& place) const {
    const auto found = moves_.find(keyOf(place));
    return found == moves_.end() ? place : glm::vec3(dvec3(place) + found->second);
  }

  using Key = std::array<float, 3>;
  static Key keyOf(const glm::vec3& place) { return {place.x + 0.0f, place.y + 0.0f, place.z + 0.0f}; }
  std::map<Key, dvec3> moves_;
};

/// Triangles of local space whose materials are of a kind, and of all others.
template <typename IsOfKind>
std::array<std::vector<uint32_t>, 2> parted(const Scene& scene, const IsOfKind& isOfKind) {
  std::array<std::vector<uint32_t>, 2> found;
  for (uint32_t i = 0; i < flatTriangleCount(scene); ++i)
    found[isOfKind(scene.materials[scene.triangles[i].material]) ? 0 : 1].push_back(i);
  return found;
}

Bvh treeOf(const Scene& scene, const std::vector<uint32_t>& triangles) {
  std::vector<Bounds> boxes;
  boxes.reserve(triangles.size());
  for (const uint32_t i : triangles) boxes.push_back(triangleBounds(scene, i));
  return buildBvh(std::move(boxes), uint32_t(triangles.size()));
}

/// Returns true if the faces lie in one plane within rounding, and overlap.
bool doCoincide(const Face& a, const Face& b) {
  if (!(std::abs(glm::dot(a.normal, b.normal)) > kParallel)) return false;
  const double gap = kCoincident * std::max(a.error, b.error);
  return (apart(a, b) <= gap || apart(b, a) <= gap) && overlap(a, b, gap);
}

/// Marks the lamps with which a face coincides.
void markAround(Scene& scene, const Bvh& bvh, const std::vector<uint32_t>& lamps, const Face& face) {
  meetAll(bvh, boxAround(face, kCoincident), [&](uint32_t primitive) {
    const Face lamp = faceOf(scene, lamps[primitive]);
    if (doCoincide(lamp, face)) coincide(scene.triangles[lamps[primitive]], std::max(lamp.error, face.error));
  });
}

}  // namespace

size_t partFromGlass(Scene& scene) {
  if (std::ranges::none_of(scene.materials, &Material::passesLight)) return 0;
  const auto both = parted(scene, [](const Material& m) { return m.passesLight(); });
  const std::vector<uint32_t>& glass = both[0];
  const std::vector<uint32_t>& opaque = both[1];
  if (glass.empty() || opaque.empty()) return 0;
  const Bvh bvh = treeOf(scene, glass);
  Moves moves;
  size_t count = 0;
  for (const uint32_t i : opaque) {
    const Face face = faceOf(scene, i);
    bool touches = false;
    meetAll(bvh, boxAround(face, kGap), [&](uint32_t primitive) {
      const uint32_t other = glass[primitive];
      const Material& material = scene.materials[scene.triangles[other].material];
      const Move move = moveOff(faceOf(scene, other), material.thicknessFactor > 0.0f, face);
      if (!(move.by > 0.0)) return;
      touches = true;
      for (int c = 0; c < 3; ++c) moves.add(scene.vertices.position[scene.triangles[i].vertex[c]], move);
    });
    count += touches ? 1 : 0;
  }
  if (moves.empty()) return 0;
  moves.apply(scene, opaque);
  return count;
}

void partSolids(Scene& scene, const std::vector<SolidPart>& parts) {
  if (parts.size() < 2) return;
  std::vector<uint32_t> glass;
  std::vector<uint32_t> partOf;
  std::vector<double> sizes;
  for (uint32_t part = 0; part < parts.size(); ++part) {
    Bounds box;
    for (const uint32_t i : parts[part].triangles) box.include(triangleBounds(scene, i));
    sizes.push_back(glm::length(dvec3(box.extent())));
    glass.insert(glass.end(), parts[part].triangles.begin(), parts[part].triangles.end());
    partOf.resize(glass.size(), part);
  }
  const Bvh bvh = treeOf(scene, glass);
  Moves moves;
  std::vector<bool> moved(parts.size(), false);
  for (uint32_t k = 0; k < glass.size(); ++k) {
    const uint32_t part = partOf[k];
    const Face face = faceOf(scene, glass[k]);
    meetAll(bvh, boxAround(face, kGap), [&](uint32_t primitive) {
      const uint32_t other = partOf[primitive];
      const bool isSmaller = std::pair(sizes[part], part) < std::pair(sizes[other], other);
      if (part == other || !isSmaller) return;
      const Move move = moveOff(faceOf(scene, glass[primitive]), false, face);
      if (!(move.by > 0.0)) return;
      moved[part] = true;
      for (int c = 0; c < 3; ++c)
        moves.add(scene.vertices.position[scene.triangles[glass[k]].vertex[c]], move);
    });
  }
  std::vector<uint32_t> ofMoved;
  for (uint32_t part = 0; part < parts.size(); ++part) {
    const std::vector<uint32_t>& triangles = parts[part].triangles;
    if (moved[part]) ofMoved.insert(ofMoved.end(), triangles.begin(), triangles.end());
  }
  moves.apply(scene, ofMoved);
}

void markLampsInSurfaces(Scene& scene) {
  const auto [lamps, others] = parted(scene, [](const Material& m) { return m.emissive(); });
  if (lamps.empty()) return;
  const Bvh bvh = treeOf(scene, lamps);
  for (const uint32_t i : others) markAround(scene, bvh, lamps, faceOf(scene, i));
  for (const Instance& instance : scene.instances) {
    const SharedMesh& mesh = scene.sharedMeshes[instance.mesh];
    for (uint32_t i = mesh.firstTriangle; i < mesh.firstTriangle + mesh.triangleCount; ++i) {
      auto corners = cornersOf<dvec3>(scene, scene.triangles[i]);
      for (dvec3& c : corners) c = dvec3(instance.toLocal * glm::dvec4(c, 1.0));
      markAround(scene, bvh, lamps, faceOf(corners));
    }
  }
}

}  // namespace fragtrace
