// SPDX-License-Identifier: MIT
#include "scene/creases.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "scene/coincidence.h"
#include "scene/hit_error.h"

namespace fragtrace {

namespace {

/// The height over a plane that the rounding of the next ray needs, in offsets: 22 of 32
/// (docs/design/ray-origins.md).
constexpr double kClearance = 22.0 / 32.0;
/// The uncertainty of a point within its plane when the ray grazes, in offsets: 16 of 32, for the floats of
/// the ray's point and a sine of 1/16 (pointOnPlane of shaders/intersect.glsl). For slivers the error of the
/// weighted distance is added (isSliver).
constexpr double kGrazing = 0.5;
/// Offsets are packed with a few bits, rounded up by at most this factor.
constexpr double kPackedOffset = 1.25;
/// Neighbours whose unit normals have at least this dot product need no inset: the offset lifts points off
/// both.
constexpr float kGentle = float(kClearance);
/// All normals within half of that angle of one normal: cos(acos(kGentle) / 2).
constexpr float kGentleCone = 0.9186f;
/// Nothing can be seen within wedges below half a degree, and cards with two faces have an angle of 0.
constexpr double kLeastSine = 0x1p-7;
/// The largest distance by which a point is moved, in offsets.
constexpr double kMostInset = 256.0;
constexpr size_t kMostFaces = 512;
constexpr uint32_t kNone = 0xffffffffu;

/// The triangles around each place: vertices at the same place count as one.
struct Fans {
  std::vector<uint32_t> place;   ///< the place of each corner, three per triangle
  std::vector<uint32_t> first;   ///< the start of each place in `corner`; one more at the end
  std::vector<uint32_t> corner;  ///< triangle * 3 + corner
};

size_t hashOf(const glm::vec3& p) {
  // -0 + 0 is 0, so both zeros hash alike.
  uint64_t h = 0;
  for (int axis = 0; axis < 3; ++axis)
    h = (h ^ std::bit_cast<uint32_t>(p[axis] + 0.0f)) * 0x9e3779b97f4a7c15u;
  return size_t(h ^ (h >> 29));
}

/// The space of each vertex: 0 is local space, that of a shared mesh is its index + 1. Empty without shared
/// meshes.
std::vector<uint32_t> spacesOf(const Scene& scene) {
  std::vector<uint32_t> spaces;
  if (scene.sharedMeshes.empty()) return spaces;
  spaces.resize(scene.vertices.position.size(), 0);
  for (uint32_t mesh = 0; mesh < scene.sharedMeshes.size(); ++mesh) {
    const SharedMesh& shared = scene.sharedMeshes[mesh];
    for (uint32_t i = 0; i < shared.triangleCount; ++i) {
      const glm::uvec3& v = scene.triangles[shared.firstTriangle + i].vertex;
      for (int c = 0; c < 3; ++c) spaces[v[c]] = mesh + 1;
    }
  }
  return spaces;
}

Fans fansOf(const Scene& scene) {
  Fans fans;
  const std::vector<uint32_t> places = placesOf(scene);
  fans.first.assign(places.size() + 1, 0);
  fans.place.resize(scene.triangles.size() * 3);
  for (size_t c = 0; c < fans.place.size(); ++c) {
    fans.place[c] = places[scene.triangles[c / 3].vertex[int(c % 3)]];
    ++fans.first[fans.place[c] + 1];
  }
  for (size_t p = 1; p < fans.first.size(); ++p) fans.first[p] += fans.first[p - 1];
  fans.corner.resize(fans.place.size());
  std::vector<uint32_t> next = fans.first;
  for (uint32_t c = 0; c < fans.corner.size(); ++c) fans.corner[next[fans.place[c]]++] = c;
  return fans;
}

/// The angle of a triangle at one of its corners.
struct Sector {
  glm::dvec3 normal, toSecond, toThird;  // unit; (0, 0, 0) for the normal of a triangle without area
  std::array<double, 3> altitude;        // over the edge opposite to the corner, the second, the third vertex
  std::array<double, 2> length;          // lengths of the edges to the second and third vertex
  double offset;
  double grazing;          // the uncertainty of a point within the plane for a grazing ray
  uint32_t second, third;  // places
  uint32_t triangle, corner;
};

Sector sectorAt(const Scene& scene, const Fans& fans, uint32_t corner) {
  Sector s{};
  s.triangle = corner / 3;
  s.corner = corner % 3;
  const uint32_t second = (s.corner + 1) % 3;
  const uint32_t third = (s.corner + 2) % 3;
  s.second = fans.place[s.triangle * 3 + second];
  s.third = fans.place[s.triangle * 3 + third];
  const auto v = cornersOf(scene, scene.triangles[s.triangle]);
  const glm::dvec3 a = glm::dvec3(v[second]) - glm::dvec3(v[s.corner]);
  const glm::dvec3 b = glm::dvec3(v[third]) - glm::dvec3(v[s.corner]);
  const glm::dvec3 n = glm::cross(a, b);
  const double area = glm::length(n);
  if (area <= 0.0) return s;
  s.normal = n / area;
  s.toSecond = glm::normalize(a);
  s.toThird = glm::normalize(b);
  s.length = {glm::length(a), glm::length(b)};
  s.altitude = {area / glm::length(b - a), area / s.length[1], area / s.length[0]};
  s.offset = kPackedOffset * hitPointError(v);
  s.grazing = kGrazing * s.offset;
  if (isSliver(v)) s.grazing += 0x1p-25 * sliverLength(v);
  return s;
}

/// The largest cosine between a unit direction and the directions of a sector.
double nearest(const glm::dvec3& direction, const Sector& s) {
  const glm::dvec3 flat = direction - s.normal * glm::dot(s.normal, direction);
  const bool between = glm::dot(glm::cross(s.toSecond, flat), s.normal) > 0.0 &&
                       glm::dot(glm::cross(flat, s.toThird), s.normal) > 0.0;
  if (between) return glm::length(flat);
  return std::max(glm::dot(direction, s.toSecond), glm::dot(direction, s.toThird));
}

/// The distance from the edge at which the face and its neighbour meet, given the directions along the edge
/// and to the third vertices. The height over the neighbour's plane, distance * sine - offset * cosine, must
/// be the clearance.
double besideEdge(const Sector& face, const Sector& other, const glm::dvec3& edge, const glm::dvec3& inFace,
                  const glm::dvec3& inOther) {
  const glm::dvec3 a = inFace - edge * glm::dot(edge, inFace);
  const glm::dvec3 b = inOther - edge * glm::dot(edge, inOther);
  const double lengths = glm::length(a) * glm::length(b);
  if (lengths <= 0.0) return 0.0;
  const double cosine = glm::dot(a, b) / lengths;
  const double sine = glm::length(glm::cross(a, b)) / lengths;
  const double height = kClearance * std::max(face.offset, other.offset) + face.offset * cosine;
  if (sine < kLeastSine || height <= 0.0) return 0.0;
  return std::min(height / sine + face.grazing, kMostInset * face.offset);
}

/// The distance from a vertex at which two triangles without a common edge meet. A point at distance r is r
/// times the sine of the angle between them away from the other.
double besideVertex(const Sector& face, const Sector& other) {
  const double cosine = std::max({nearest(face.toSecond, other), nearest(face.toThird, other),
                                  nearest(other.toSecond, face), nearest(other.toThird, face)});
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  if (cosine <= 0.0 || sine < kLeastSine) return 0.0;
  const double height = kClearance * std::max(face.offset, other.offset) + face.offset;
  return std::min(height / sine + face.grazing, kMostInset * face.offset);
}

/// Does the same for triangles that run along each other, where no distance from the vertex is enough: the
/// distance from the line in which their planes meet. It is at least `altitude` times the share of the way
/// from the vertex to the edge opposite; 0 if the line leads through the face.
double besideLine(const Sector& face, const Sector& other, double& altitude) {
  const glm::dvec3 across = glm::cross(face.normal, other.normal);
  const double sine = glm::length(across);
  if (sine < kLeastSine) return 0.0;
  const glm::dvec3 line = across / sine;
  const auto beside = [&](const glm::dvec3& direction, const Sector& s) {
    return glm::dot(glm::cross(line, direction), s.normal);
  };
  const std::array<double, 2> away{beside(face.toSecond, face) * face.length[0],
                                   beside(face.toThird, face) * face.length[1]};
  if (!(away[0] * away[1] > 0.0)) return 0.0;
  altitude = std::min(std::abs(away[0]), std::abs(away[1]));
  return besideEdge(face, other, line, face.toSecond + face.toThird, other.toSecond + other.toThird);
}

/// The code of the next power of two, at most a quarter.
uint8_t codeOf(double part) {
  if (!(part > 0.0)) return 0;
  return uint8_t(std::clamp(std::floor(-std::log2(part)), 2.0, 31.0));
}

/// The codes of all triangles. Each is written by the place of its vertex, or of the lower end of its edge.
struct Codes {
  std::vector<std::array<uint8_t, 6>> of;
  std::atomic<bool> any{false};

  void ask(const Sector& face, uint32_t code, double altitude, double distance) {
    const uint8_t wanted = codeOf(distance / altitude);
    if (wanted == 0) return;
    uint8_t& kept = of[face.triangle][code];
    if (kept == 0 || wanted < kept) kept = wanted;
    any.store(true, std::memory_order_relaxed);
  }
};

void askBeside(const Sector& face, const Sector& other, uint32_t place, Codes& codes) {
  // The edges to the second and to the third vertex, opposite to the third and to the second.
  bool adjacent = false;
  for (const bool toSecond : {true, false}) {
    const uint32_t end = toSecond ? face.second : face.third;
    if (end != other.second && end != other.third) continue;
    adjacent = true;
    if (end < place) continue;  // asked there
    const uint32_t code = (face.corner + (toSecond ? 2 : 1)) % 3;
    codes.ask(face, code, face.altitude[toSecond ? 2 : 1],
              besideEdge(face, other, toSecond ? face.toSecond : face.toThird,
                         toSecond ? face.toThird : face.toSecond,
                         end == other.second ? other.toThird : other.toSecond));
  }
  if (adjacent) return;
  double distance = besideVertex(face, other);
  double altitude = face.altitude[0];
  if (distance <= 0.0 || distance >= kMostInset * face.offset) distance = besideLine(face, other, altitude);
  codes.ask(face, 3 + face.corner, altitude, distance);
}

/// Returns true if no two triangles around a place run along an edge in the same direction. If two do,
/// normals do not tell how they bend.
bool areWoundAlike(const Fans& fans, uint32_t place) {
  const auto nextOf = [&](uint32_t i, uint32_t steps) {
    const uint32_t corner = fans.corner[i];
    return fans.place[corner - corner % 3 + (corner + steps) % 3];
  };
  for (uint32_t i = fans.first[place]; i < fans.first[place + 1]; ++i) {
    for (uint32_t j = fans.first[place]; j < i; ++j) {
      if (nextOf(i, 1) == nextOf(j, 1) || nextOf(i, 2) == nextOf(j, 2)) return false;
    }
  }
  return true;
}

bool isGentle(const Fans& fans, uint32_t place, const std::vector<glm::vec3>& normals) {
  const glm::vec3 first = normals[fans.corner[fans.first[place]] / 3];
  for (uint32_t i = fans.first[place]; i < fans.first[place + 1]; ++i) {
    if (glm::dot(normals[fans.corner[i] / 3], first) < kGentleCone) return false;
  }
  return true;
}

/// Returns true if the triangles lie back to back, within rounding, and overlap near their corner.
bool areTwins(const Sector& a, const Sector& b) {
  if (glm::dot(a.normal, b.normal) > -0.9999) return false;
  const double gap = kCoincident / kPackedOffset * std::max(a.offset, b.offset);
  const auto liesIn = [&](const Sector& plane, const Sector& s) {
    return std::abs(glm::dot(plane.normal, s.toSecond)) * s.length[0] <= gap &&
           std::abs(glm::dot(plane.normal, s.toThird)) * s.length[1] <= gap;
  };
  const auto holdsMiddle = [](const Sector& s, const Sector& of) {
    const glm::dvec3 middle = of.toSecond + of.toThird;
    return glm::dot(glm::cross(s.toSecond, middle), s.normal) > 0.0 &&
           glm::dot(glm::cross(middle, s.toThird), s.normal) > 0.0;
  };
  return (liesIn(a, b) || liesIn(b, a)) && (holdsMiddle(a, b) || holdsMiddle(b, a));
}

void askAround(const Scene& scene, const Fans& fans, uint32_t place, bool woundAlike,
               std::vector<Sector>& sectors, Codes& codes, std::vector<uint32_t>& twins) {
  sectors.clear();
  for (uint32_t i = fans.first[place]; i < fans.first[place + 1]; ++i) {
    sectors.push_back(sectorAt(scene, fans, fans.corner[i]));
    if (sectors.back().altitude[0] <= 0.0) sectors.pop_back();
  }
  for (const Sector& face : sectors) {
    for (const Sector& other : sectors) {
      if (&face == &other) continue;
      if (&face < &other && areTwins(face, other)) twins.insert(twins.end(), {face.triangle, other.triangle});
      if (!woundAlike || glm::dot(face.normal, other.normal) < double(kGentle))
        askBeside(face, other, place, codes);
    }
  }
}

std::vector<glm::vec3> normalsOf(const Scene& scene) {
  std::vector<glm::vec3> normals(scene.triangles.size());
  for (size_t i = 0; i < normals.size(); ++i) {
    const auto [a, b, c] = cornersOf<glm::dvec3>(scene, scene.triangles[i]);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    normals[i] = length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f);
  }
  return normals;
}

}  // namespace

std::vector<uint32_t> placesOf(const Scene& scene) {
  const std::vector<glm::vec3>& positions = scene.vertices.position;
  const std::vector<uint32_t> spaces = spacesOf(scene);
  const auto same = [&](uint32_t a, uint32_t b) {
    return positions[a] == positions[b] && (spaces.empty() || spaces[a] == spaces[b]);
  };
  std::vector<uint32_t> places(positions.size());
  const size_t mask = std::bit_ceil(positions.size() * 2) - 1;
  std::vector<uint32_t> table(mask + 1, kNone);
  for (uint32_t i = 0; i < positions.size(); ++i) {
    size_t slot =
        (hashOf(positions[i]) + (spaces.empty() ? 0 : spaces[i] * size_t{0x9e3779b97f4a7c15u})) & mask;
    while (table[slot] != kNone && !same(table[slot], i)) slot = (slot + 1) & mask;
    if (table[slot] == kNone) table[slot] = i;
    places[i] = table[slot];
  }
  return places;
}

std::vector<uint32_t> creaseInsets(const Scene& scene, std::vector<uint32_t>* twins) {
  if (scene.triangles.empty()) return {};
  const Fans fans = fansOf(scene);
  const std::vector<glm::vec3> normals = normalsOf(scene);
  Codes codes;
  codes.of.resize(scene.triangles.size());
  constexpr uint32_t kWorthAThread = 1024;  // places
  const auto places = uint32_t(fans.first.size() - 1);
  const uint32_t threads = std::clamp(places / kWorthAThread, 1u, processorCount());
  std::vector<std::vector<uint32_t>> found(threads);
  runOnThreads(threads, [&](uint32_t thread) {
    std::vector<Sector> sectors;
    for (uint32_t place = thread; place < places; place += threads) {
      const size_t faces = fans.first[place + 1] - fans.first[place];
      if (faces < 2 || faces > kMostFaces) continue;
      const bool woundAlike = areWoundAlike(fans, place);
      if (woundAlike && isGentle(fans, place, normals)) continue;
      askAround(scene, fans, place, woundAlike, sectors, codes, found[thread]);
    }
  });
  for (const std::vector<uint32_t>& some : found)
    if (twins != nullptr) twins->insert(twins->end(), some.begin(), some.end());
  if (!codes.any) return {};
  std::vector<uint32_t> insets(scene.triangles.size(), 0u);
  for (size_t i = 0; i < insets.size(); ++i) {
    for (uint32_t c = 0; c < 6; ++c) insets[i] |= uint32_t(codes.of[i][c]) << (5 * c);
  }
  return insets;
}

void settleCreases(Scene& scene) {
  std::vector<uint32_t> twins;
  scene.insets = creaseInsets(scene, &twins);
  for (size_t i = 0; i < twins.size(); i += 2) {
    Triangle& a = scene.triangles[twins[i]];
    Triangle& b = scene.triangles[twins[i + 1]];
    if (scene.materials[a.material].culled() && scene.materials[b.material].culled()) continue;
    const double error = std::max(hitPointError(cornersOf(scene, a)), hitPointError(cornersOf(scene, b)));
    for (Triangle* t : {&a, &b}) coincide(*t, error);
  }
}

}  // namespace fragtrace
