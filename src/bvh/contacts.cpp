// SPDX-License-Identifier: MIT
#include "bvh/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/coincidence.h"
#include "scene/hit_error.h"

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

namespace {

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
