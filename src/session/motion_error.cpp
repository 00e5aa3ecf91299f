// SPDX-License-Identifier: MIT
#include "session/motion_error.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/vectors.h"
#include "scene/camera.h"
#include "scene/projection.h"

namespace fragtrace {

namespace {

constexpr double kBeside = 1.1;  ///< points within this many times the picture's size still count

/// Places of points in a camera's picture, in pixels.
class PixelMeasure {
 public:
  PixelMeasure(const Camera& camera, glm::ivec2 size)
      : projection_(projectionOf(camera, double(size.x) / size.y)), half_(0.5 * glm::dvec2(size)) {}

  bool isRound() const { return !isRectilinear(projection_.type); }

  /// Negative where a point is beyond the plane: those of the picture's sides, and that of the camera.
  std::array<double, 5> sides(const glm::dvec3& point) const {
    const glm::dvec3 p = projected(projection_, point);
    const double w = kBeside * p.z;
    return {p.z - 1e-9, w - p.x, w + p.x, w - p.y, w + p.y};
  }

  bool sees(const glm::dvec3& point) const {
    if (isRound()) return true;
    return std::ranges::all_of(sides(point), [](double side) { return side >= 0.0; });
  }

  /// The distance between the place of `a` in this picture and that of `b` in another one.
  double between(const glm::dvec3& a, const PixelMeasure& other, const glm::dvec3& b) const {
    if (isRound()) {
      const glm::dvec3 p = along(a);
      const glm::dvec3 q = other.along(b);
      return half_.y / glm::length(projection_.up) *
             std::atan2(glm::length(glm::cross(p, q)), glm::dot(p, q));
    }
    const glm::dvec3 p = projected(projection_, a);
    const glm::dvec3 q = projected(other.projection_, b);
    if (p.z <= 0.0 || q.z <= 0.0) return 2.0 * glm::length(half_);
    return glm::length((glm::dvec2(p) / p.z - glm::dvec2(q) / q.z) * half_);
  }

 private:
  /// The direction to a point in the camera's own axes.
  glm::dvec3 along(const glm::dvec3& point) const {
    const glm::dvec3 view = glm::normalize(point - projection_.position);
    return {glm::dot(view, glm::normalize(projection_.right)), glm::dot(view, glm::normalize(projection_.up)),
            glm::dot(view, projection_.forward)};
  }

  Projection projection_;
  glm::dvec2 half_;
};

/// A moment within its segment, and the poses between which that moves straight.
struct Between {
  const Pose& from;
  const Pose& there;
  const Pose& to;
  double part;
};

/// Calls `check` for each moment that lies within a segment.
template <typename Check>
void forEachWithin(const Moments& moments, uint32_t segments, const Check& check) {
  for (const auto& [time, moment] : moments) {
    const double place = time * segments;
    const double segment = std::min(std::floor(place), double(segments - 1));
    const double part = place - segment;
    if (part == 0.0 || part == 1.0) continue;
    check(Between{moments.at(segment / segments).pose, moment.pose,
                  moments.at((segment + 1.0) / segments).pose, part});
  }
}

/// A point of a triangle by the weights of its corners.
glm::dvec3 pointAt(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& weights) {
  return weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
}

/// Weights of the corners of the part of a triangle that is in the picture (Sutherland and Hodgman, Reentrant
/// Polygon Clipping, 1974).
std::vector<glm::dvec3> visiblePart(const std::array<glm::dvec3, 3>& corners, const PixelMeasure& measure) {
  std::vector<glm::dvec3> part{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  for (size_t side = 0; side < 5 && !part.empty(); ++side) {
    std::vector<glm::dvec3> inside;
    for (size_t i = 0; i < part.size(); ++i) {
      const glm::dvec3& a = part[i];
      const glm::dvec3& b = part[(i + 1) % part.size()];
      const double atA = measure.sides(pointAt(corners, a))[side];
      const double atB = measure.sides(pointAt(corners, b))[side];
      if (atA >= 0.0) inside.push_back(a);
      if ((atA >= 0.0) != (atB >= 0.0)) inside.push_back(glm::mix(a, b, atA / (atA - atB)));
    }
    part = std::move(inside);
  }
  return part;
}

double surfacesOffAt(const Between& b, const Scene& scene, const PixelMeasure& measure) {
  const auto straight = [&](size_t i) {
    return scene.space.worldOf(
        glm::mix(glm::dvec3(b.from.vertices.position[i]), glm::dvec3(b.to.vertices.position[i]), b.part));
  };
  const auto there = [&](size_t i) { return scene.space.worldOf(glm::dvec3(b.there.vertices.position[i])); };
  double most = 0.0;
  std::vector<bool> seen(b.there.vertices.position.size());
  for (size_t i = 0; i < seen.size(); ++i) {
    seen[i] = measure.sees(there(i));
    if (seen[i]) most = std::max(most, measure.between(there(i), measure, straight(i)));
  }
  for (size_t i = 0; i < b.there.spheres.size(); ++i) {
    const auto place = [&](const glm::dvec3& center) { return scene.space.worldOf(center); };
    const glm::dvec3 center =
        glm::mix(glm::dvec3(b.from.spheres[i].center), glm::dvec3(b.to.spheres[i].center), b.part);
    const glm::dvec3 right = place(glm::dvec3(b.there.spheres[i].center));
    if (measure.sees(right)) most = std::max(most, measure.between(right, measure, place(center)));
  }
  if (measure.isRound()) return most;
  for (const Triangle& t : scene.triangles) {
    const glm::uvec3& v = t.vertex;
    if (seen[v.x] && seen[v.y] && seen[v.z]) continue;
    const std::array<glm::dvec3, 3> corners{there(v.x), there(v.y), there(v.z)};
    const std::array<glm::dvec3, 3> ours{straight(v.x), straight(v.y), straight(v.z)};
    for (const glm::dvec3& weights : visiblePart(corners, measure))
      most = std::max(most, measure.between(pointAt(corners, weights), measure, pointAt(ours, weights)));
  }
  return most;
}

}  // namespace

double surfacesOff(const Moments& moments, uint32_t segments, const Scene& scene, const Camera& camera,
                   glm::ivec2 size) {
  const PixelMeasure measure(camera, size);
  double most = 0.0;
  forEachWithin(moments, segments,
                [&](const Between& b) { most = std::max(most, surfacesOffAt(b, scene, measure)); });
  return most;
}

double lampsOff(const Moments& moments, uint32_t segments, const Scene& scene) {
  double most = 0.0;
  forEachWithin(moments, segments, [&](const Between& b) {
    for (const Triangle& t : scene.triangles) {
      if (!scene.materials[t.material].emissive()) continue;
      std::array<glm::dvec3, 3> right;
      std::array<glm::dvec3, 3> ours;
      for (int i = 0; i < 3; ++i) {
        const uint32_t v = t.vertex[i];
        right[size_t(i)] = b.there.vertices.position[v];
        ours[size_t(i)] =
            glm::mix(glm::dvec3(b.from.vertices.position[v]), glm::dvec3(b.to.vertices.position[v]), b.part);
      }
      const double area = areaOf(right);
      if (area > 0.0) most = std::max(most, std::abs(areaOf(ours) / area - 1.0));
    }
  });
  return most;
}

double cameraOff(const Moments& moments, std::span<const CameraSegment> segments, const Scene& scene,
                 glm::ivec2 size) {
  constexpr size_t kMostPoints = 2000;
  constexpr double kFar = 1e6;
  double most = 0.0;
  for (const auto& [time, moment] : moments) {
    const Camera ours = segments.empty() ? moments.begin()->second.camera : cameraAt(segments, time);
    const PixelMeasure right(moment.camera, size);
    const PixelMeasure measure(ours, size);
    const auto check = [&](const glm::dvec3& point) {
      if (right.sees(point)) most = std::max(most, right.between(point, measure, point));
    };
    // Points far away show turns of the camera. Points at the distance of the scene show its other motion.
    const double focal = glm::distance(moment.camera.position, focalPointOf(moment.camera, scene.bounds));
    for (const double distance : {focal, kFar * focal}) {
      check(moment.camera.position + distance * moment.camera.forward);
      check(moment.camera.position + distance * (moment.camera.forward + 0.2 * moment.camera.up));
    }
    const std::vector<glm::vec3>& vertices = moment.pose.vertices.position;
    const size_t step = vertices.size() / kMostPoints + 1;
    for (size_t i = 0; i < vertices.size(); i += step) check(scene.space.worldOf(glm::dvec3(vertices[i])));
  }
  return most;
}

}  // namespace fragtrace
