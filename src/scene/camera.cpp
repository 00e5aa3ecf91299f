// SPDX-License-Identifier: MIT
#include "scene/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "scene/parts.h"

namespace fragtrace {

namespace {

/// The smallest sine of the angle between two sides of a triangle that has a plane of its own.
constexpr double kLeastUpSine = 1e-3;
constexpr double kUnitsOfUp = 1e6;

}  // namespace

glm::dmat3 turnToY(const glm::dvec3& up) {
  // The largest part is 1 first, since squares of large numbers overflow.
  const glm::dvec3 size = glm::abs(up);
  const glm::dvec3 unit = glm::normalize(up / std::max({size.x, size.y, size.z}));
  const double across = std::hypot(unit.x, unit.z);
  if (unit.y < 0.0 && across == 0.0) return {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  // Rodrigues' formula with the part of the direction across Y, which is of length 1 for the lower half: 1 +
  // y would be cancelled there.
  const double length = unit.y < 0.0 ? across : 1.0;
  const double k = unit.y < 0.0 ? 1.0 - unit.y : 1.0 / (1.0 + unit.y);
  const double x = unit.x / length;
  const double z = unit.z / length;
  // A difference from 0 is never -0.
  const double xz = 0.0 - k * x * z;
  return {{unit.y + k * z * z, unit.x, xz},
          {0.0 - unit.x, unit.y, 0.0 - unit.z},
          {xz, unit.z, unit.y + k * x * x}};
}

std::optional<glm::dvec3> levelUp(const std::array<glm::dvec3, 3>& points, const glm::dvec3& up) {
  const glm::dvec3 a = points[1] - points[0];
  const glm::dvec3 b = points[2] - points[0];
  const glm::dvec3 c = points[2] - points[1];
  const glm::dvec3 normal = glm::cross(a, b);
  const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
  if (!(glm::length(normal) > kLeastUpSine * longest)) return std::nullopt;
  const glm::dvec3 unit = glm::normalize(normal.y < 0.0 ? -normal : normal);
  // The rotation's transpose turns back to the file's space.
  return glm::round(kUnitsOfUp * (unit * turnToY(up))) / kUnitsOfUp + 0.0;
}

glm::dvec2 halfExtents(const Camera& camera, double width, double height, double unit) {
  if (camera.type == CameraType::Panorama) return {glm::pi<double>(), glm::half_pi<double>()};
  if (camera.type == CameraType::Fisheye) {
    const double nearer = std::min(width, height);
    return 0.5 * camera.fovY * glm::dvec2(width / nearer, height / nearer);
  }
  const bool perspective = camera.type == CameraType::Perspective;
  const double half = perspective ? std::tan(0.5 * camera.fovY) : camera.halfHeight / unit;
  return {half * width / height, half};
}

Projection projectionOf(const Camera& camera, double aspectRatio) {
  const glm::dvec2 half = halfExtents(camera, aspectRatio, 1.0);
  const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
  const glm::dvec3 up = glm::cross(right, camera.forward);
  return {camera.position, half.x * right, half.y * up, camera.forward, 2.0 * camera.shift, camera.type};
}

std::optional<Ray> rayThrough(const Projection& projection, const LocalSpace& space,
                              const glm::dvec2& place) {
  constexpr float kFar = 1e30f;
  const glm::dvec3 position = space.localOf(projection.position);
  const glm::dvec2 shifted = place + projection.shift;
  const glm::dvec3 offset = shifted.x * projection.right + shifted.y * projection.up;
  if (projection.type == CameraType::Orthographic)
    return Ray{glm::vec3(position + offset / space.unit), glm::vec3(projection.forward), kFar};
  glm::dvec3 direction = projection.forward + offset;
  // Shaders/camera.glsl computes the same.
  if (projection.type == CameraType::Panorama) {
    const glm::dvec2 angles = glm::dvec2(glm::pi<double>(), glm::half_pi<double>()) * shifted;
    direction = std::cos(angles.y) * (std::cos(angles.x) * projection.forward +
                                      std::sin(angles.x) * glm::normalize(projection.right)) +
                std::sin(angles.y) * glm::normalize(projection.up);
  } else if (projection.type == CameraType::Fisheye) {
    const double angle = glm::length(offset);
    if (angle > std::min(glm::length(projection.right), glm::length(projection.up))) return std::nullopt;
    const double aside = angle > 0.0 ? std::sin(angle) / angle : 1.0;
    direction = std::cos(angle) * projection.forward + aside * offset;
  }
  return Ray{glm::vec3(position), glm::vec3(glm::normalize(direction)), kFar};
}

glm::dvec3 projected(const Projection& projection, const glm::dvec3& point) {
  const glm::dvec3 view = point - projection.position;
  const double x = glm::dot(view, projection.right) / glm::dot(projection.right, projection.right);
  const double y = glm::dot(view, projection.up) / glm::dot(projection.up, projection.up);
  const double w = projection.type == CameraType::Perspective ? glm::dot(view, projection.forward) : 1.0;
  return {x - w * projection.shift.x, y - w * projection.shift.y, w};
}

namespace {

double radiusOf(const BoundsDouble& bounds) {
  const double radius = 0.5 * glm::length(bounds.extent());
  return radius > 0.0 && std::isfinite(radius) ? radius : 1.0;
}

/// Below this sine of their angle, two directions count as parallel: what would be left is mostly rounding.
constexpr double kParallelSine = 1e-9;

/// The part of `up` that is orthogonal to a unit `forward`. If `up` is parallel to it, the first of the axes
/// y, z, x that is not takes its place.
glm::dvec3 orthogonalUp(const glm::dvec3& up, const glm::dvec3& forward) {
  const std::array<glm::dvec3, 4> candidates = {up, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  for (const glm::dvec3& candidate : candidates) {
    const glm::dvec3 rejected = candidate - glm::dot(candidate, forward) * forward;
    const double length = glm::length(rejected);
    if (length > kParallelSine * glm::length(candidate)) return rejected / length;
  }
  return {0, 1, 0};
}

/// The distance from which a view of that angle, in a picture of that width / height, holds the sphere about
/// the bounds.
double framingDistance(double fovY, double aspectRatio, const BoundsDouble& bounds) {
  // The narrower side of the picture decides. A narrow view of a sphere shows it up to its middle, so wide
  // scenes would touch the picture's edge: a tenth stays free.
  const double narrow = std::min(1.0, aspectRatio);
  const double filled = 1.0 - 0.1 * std::min(1.0, 2.0 * (1.0 - narrow));
  return radiusOf(bounds) / std::sin(std::atan(std::tan(0.5 * fovY) * narrow * filled));
}

glm::dvec3 centerOf(const BoundsDouble& bounds) { return bounds.empty() ? glm::dvec3(0.0) : bounds.center(); }

constexpr glm::dvec3 kVertical{0.0, 1.0, 0.0};

glm::dvec3 levelOutwards(const Orbit& orbit) {
  const double azimuth = glm::radians(orbit.azimuthDegrees);
  return {std::sin(azimuth), 0.0, std::cos(azimuth)};
}

/// The camera with the lens that is asked for, whose view keeps its size at `distance`, in metres.
Camera withLens(Camera camera, const CameraOverrides& overrides, double distance) {
  const double halfHeight = distance * std::tan(0.5 * camera.fovY);
  const CameraType before = camera.type;
  if (overrides.viewAngleDegrees) camera.type = CameraType::Perspective;
  if (overrides.parallelScale) camera.type = CameraType::Orthographic;
  if (overrides.viewAngleDegrees && overrides.parallelScale)
    throw UsageError(
        "--camera-parallel-scale: is of an orthographic view, --camera-view-angle of a perspective");
  camera.type = overrides.type.value_or(camera.type);
  const bool fisheye = camera.type == CameraType::Fisheye;
  if (fisheye) camera.fovY = glm::pi<double>();
  if (fisheye) camera.aspectRatio = 1.0;
  if (camera.type == CameraType::Panorama) {
    camera.aspectRatio = 2.0;
    const glm::dvec3 up = glm::normalize(overrides.viewUp.value_or(kVertical));
    const bool level = glm::length(glm::cross(camera.forward, up)) > kParallelSine;
    camera.forward = orthogonalUp(level ? camera.forward : camera.up, up);
    camera.up = up;
  }
  if (overrides.viewAngleDegrees) {
    const double degrees = *overrides.viewAngleDegrees;
    if (!(degrees > 0.0 && (fisheye ? degrees <= 360.0 : degrees < 180.0)))
      throw UsageError("--camera-view-angle: is not between 0 and " + std::string(fisheye ? "360" : "180") +
                       " degrees");
    camera.fovY = glm::radians(degrees);
  }
  if (camera.type == CameraType::Orthographic && before != camera.type) camera.halfHeight = halfHeight;
  if (overrides.parallelScale) {
    camera.halfHeight = *overrides.parallelScale;
    if (!(camera.halfHeight > 0.0 && std::isfinite(camera.halfHeight)))
      throw UsageError("--camera-parallel-scale: is not above 0");
  }
  camera.shift = overrides.lensShift.value_or(camera.shift);
  return camera;
}

/// The unit vector from the point looked at to the camera, world space.
glm::dvec3 outwardsOf(const Orbit& orbit) {
  const double elevation = glm::radians(orbit.elevationDegrees);
  return std::cos(elevation) * levelOutwards(orbit) + std::sin(elevation) * kVertical;
}

/// Puts the camera's lens on the sphere about the point at which it looks.
Camera orbiting(const Camera& lens, const Orbit& orbit, const CameraOverrides& overrides,
                const BoundsDouble& bounds, double aspectRatio) {
  // A round view is as far away as the perspective that it takes the place of.
  const bool round = overrides.type && !isRectilinear(*overrides.type);
  const double distanceOfLens = glm::distance(focalPointOf(lens, bounds), lens.position);
  Camera camera = round ? lens : withLens(lens, overrides, distanceOfLens);
  const double elevation = glm::radians(orbit.elevationDegrees);
  camera.forward = -outwardsOf(orbit);
  camera.up = std::cos(elevation) * kVertical - std::sin(elevation) * levelOutwards(orbit);
  if (overrides.viewUp) camera.up = orthogonalUp(*overrides.viewUp, camera.forward);
  double distance = 2.0 * radiusOf(bounds);
  if (camera.type == CameraType::Perspective)
    distance = framingDistance(camera.fovY, aspectRatio, bounds);
  else if (!overrides.parallelScale)
    camera.halfHeight = radiusOf(bounds) / std::min(1.0, aspectRatio);
  camera.position = overrides.focalPoint.value_or(centerOf(bounds)) - camera.forward * distance;
  if (round) camera = withLens(camera, overrides, distance);
  return overrides.fit ? camera : zoomed(camera, orbit.zoom);
}

}  // namespace

Camera frameScene(const BoundsDouble& bounds, double aspectRatio) {
  Camera camera;
  camera.name = "framing camera";
  camera.fovY = glm::quarter_pi<double>();
  const glm::dvec3 center = centerOf(bounds);
  const glm::dvec3 extent = bounds.empty() ? glm::dvec3(1.0) : bounds.extent();
  constexpr double kFlat = 1e-3;  // share of the largest extent
  const double thin = kFlat * std::max({extent.x, extent.y, extent.z});
  if (extent.z > thin && extent.y <= thin) {
    camera.forward = {0, -1, 0};
    camera.up = {0, 0, -1};
  } else if (extent.z > thin && extent.x <= thin) {
    camera.forward = {-1, 0, 0};
  }
  camera.position = center - camera.forward * framingDistance(camera.fovY, aspectRatio, bounds);
  return camera;
}

glm::dvec3 focalPointOf(const Camera& camera, const BoundsDouble& bounds) {
  const double depth = bounds.empty() ? 0.0 : glm::dot(bounds.center() - camera.position, camera.forward);
  return camera.position + camera.forward * (depth > 0.0 ? depth : radiusOf(bounds));
}

glm::dvec3 recentringPoint(const std::optional<glm::dvec3>& camera, const BoundsDouble& bounds) {
  if (bounds.empty()) return camera.value_or(glm::dvec3(0.0));
  if (!camera) return bounds.center();
  const glm::dvec3 nearest = glm::clamp(*camera, bounds.minimum, bounds.maximum);
  const bool close = glm::distance(*camera, nearest) <= 0.125 * glm::length(bounds.extent());
  return close ? nearest : bounds.center();
}

Camera withOverrides(Camera camera, const CameraOverrides& overrides, const BoundsDouble& bounds) {
  const glm::dvec3 focalPoint = overrides.focalPoint.value_or(focalPointOf(camera, bounds));
  const glm::dvec3 position = overrides.position.value_or(camera.position);
  const bool level = overrides.position && overrides.focalPoint;
  const glm::dvec3 up = overrides.viewUp.value_or(level ? kVertical : camera.up);
  if (!isFinite(focalPoint) || !isFinite(position) || !isFinite(up)) {
    throw UsageError("--camera-position, --camera-focal-point and --camera-view-up: are not all finite");
  }
  const bool round = overrides.type && !isRectilinear(*overrides.type);
  if (round && overrides.position && !overrides.focalPoint) {
    camera.position = position;
  } else if (overrides.position || overrides.focalPoint) {
    const glm::dvec3 view = focalPoint - position;
    const double distance = glm::length(view);
    if (!(distance > 0.0)) throw UsageError("--camera-position: is the focal point, too");
    camera.forward = view / distance;
    camera.position = position;
  }
  if (overrides.position || overrides.focalPoint || overrides.viewUp)
    camera.up = orthogonalUp(up, camera.forward);
  return withLens(camera, overrides, glm::distance(focalPoint, camera.position));
}

double focalLengthOf(double viewAngle) { return 0.5 * kSensorHeight / std::tan(0.5 * viewAngle); }

double viewAngleOf(double focalLength, double sensorHeight) {
  return 2.0 * std::atan(0.5 * sensorHeight / focalLength);
}

Camera zoomed(Camera camera, double zoom) {
  if (zoom == 1.0) return camera;  // keeps every bit
  const bool fisheye = camera.type == CameraType::Fisheye;
  camera.fovY = fisheye ? camera.fovY / zoom : 2.0 * std::atan(std::tan(0.5 * camera.fovY) / zoom);
  camera.halfHeight /= zoom;
  return camera;
}

glm::dvec3 turningPoint(const Camera& camera, const CameraOverrides& overrides, const BoundsDouble& bounds) {
  if (overrides.focalPoint) return *overrides.focalPoint;
  if (!isRectilinear(camera.type) && !overrides.orbit) return camera.position;
  const bool placed = overrides.orbit || overrides.fit;
  return placed ? centerOf(bounds) : focalPointOf(camera, bounds);
}

std::optional<int> cameraIndexOf(std::optional<int> index, const std::string& name,
                                 std::span<const Camera> cameras) {
  if (index || name.empty()) return index;
  std::vector<std::string> names;
  for (const Camera& camera : cameras) names.push_back(camera.name);
  return int(indexOfPart("--camera", name, names));
}

Camera chooseCamera(std::span<const Camera> cameras, std::optional<int> index,
                    const CameraOverrides& overrides, const BoundsDouble& bounds, double aspectRatio) {
  if (index && (*index < 0 || size_t(*index) >= cameras.size())) {
    throw UsageError("--camera-index: " + std::to_string(*index) + ", but the scene has " +
                     countText(cameras.size(), "camera") + " (counted from 0)");
  }
  const Camera camera = index             ? cameras[size_t(*index)]
                        : cameras.empty() ? frameScene(bounds, aspectRatio)
                                          : cameras.front();
  const bool first = cameras.empty() && !overrides.position;
  if (overrides.orbit || first)
    return orbiting(camera, overrides.orbit.value_or(kFirstView), overrides, bounds, aspectRatio);
  return withOverrides(camera, overrides, bounds);
}

namespace {

/// The sum of area * n * n^T over the triangles, n being the unit normal. Seen along d, the mean squared
/// cosine of the surfaces is d^T * sum * d / trace(sum).
struct Facing {
  glm::dmat3 sum{0.0};

  /// Adds a surface whose `normal` is as long as its area.
  void add(const glm::dvec3& normal) {
    const double area = glm::length(normal);
    if (area > 0.0) sum += glm::outerProduct(normal, normal) / area;
  }
};

Facing facingOf(const Scene& scene, size_t first, size_t count) {
  Facing facing;
  for (size_t i = first; i < first + count; ++i) {
    const auto& corner = scene.triangles[i].vertex;
    const glm::dvec3 a(scene.vertices.position[corner[0]]);
    facing.add(0.5 * glm::cross(glm::dvec3(scene.vertices.position[corner[1]]) - a,
                                glm::dvec3(scene.vertices.position[corner[2]]) - a));
  }
  return facing;
}

/// Sums up the scene without strokes, which face the camera anyway. The space is local, its axes are the
/// world's.
Facing facingOf(const Scene& scene) {
  Facing facing = facingOf(scene, 0, flatTriangleCount(scene) - scene.strokeTriangles);
  std::vector<Facing> meshes;
  for (const SharedMesh& mesh : scene.sharedMeshes)
    meshes.push_back(facingOf(scene, mesh.firstTriangle, mesh.triangleCount));
  for (const Instance& instance : scene.instances) {
    const glm::dmat3 linear(instance.toLocal);
    // The cofactors transform areas, exactly if the scale is the same along all axes.
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const double scale = std::cbrt(std::abs(glm::determinant(cofactors)));
    if (scale > 0.0) facing.sum += cofactors * meshes[instance.mesh].sum * glm::transpose(cofactors) / scale;
  }
  for (const Sphere& sphere : scene.spheres)
    facing.sum += glm::dmat3(double(sphere.radius) * sphere.radius);  // alike from all sides
  return facing;
}

/// 0 if all surfaces are seen along their edges, 1 if they face the camera.
double meanSquaredCosine(const Facing& facing, const Orbit& orbit) {
  const glm::dvec3 d = outwardsOf(orbit);
  const double trace = facing.sum[0][0] + facing.sum[1][1] + facing.sum[2][2];
  return trace > 0.0 ? glm::dot(d, facing.sum * d) / trace : 1.0;
}

/// The direction from which the scene's surfaces are visible: kFirstView, or another one if most of them
/// would be seen along their edges there.
Orbit firstView(const Scene& scene) {
  // The limit for a view along the edge: 14 degrees or less to the surface. A level floor is seen at 20.
  constexpr double kEdge = 0.06;
  constexpr std::array<Orbit, 3> kOthers{
      {{.azimuthDegrees = -kFirstView.azimuthDegrees, .elevationDegrees = kFirstView.elevationDegrees},
       {.azimuthDegrees = kFirstView.azimuthDegrees, .elevationDegrees = 55.0},
       {.azimuthDegrees = 180.0 + kFirstView.azimuthDegrees,
        .elevationDegrees = kFirstView.elevationDegrees}}};
  const Facing facing = facingOf(scene);
  const auto seen = [&](const Orbit& orbit) { return meanSquaredCosine(facing, orbit); };
  return seen(kFirstView) >= kEdge ? kFirstView : *std::ranges::max_element(kOthers, {}, seen);
}

}  // namespace

CameraOverrides settledOverrides(CameraOverrides asked, const Scene& scene) {
  const bool fits = asked.asksForFit();
  const bool isChosen = asked.fit || asked.fitShadow || !asked.fitTo.empty();
  asked.fit = fits;
  if (!scene.cameras.empty() || asked.position || asked.orbit) return asked;
  if (asked.type == CameraType::Panorama) {
    asked.position = scene.bounds.empty() ? glm::dvec3(0.0) : scene.bounds.center();
    return asked;
  }
  asked.orbit = firstView(scene);
  if (asked.type == CameraType::Fisheye) return asked;
  asked.fit = fits || (!asked.focalPoint && !asked.parallelScale);
  asked.leavesStrays = asked.fit && !isChosen;
  return asked;
}

}  // namespace fragtrace
