// SPDX-License-Identifier: MIT
#include "scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "base/vectors.h"
#include "scene/parts.h"

namespace fragtrace {
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

glm::dvec3 outwardsOf(const Orbit& orbit) {
  const double elevation = glm::radians(orbit.elevationDegrees);
  return std::cos(elevation) * levelOutwards(orbit) + std::sin(elevation) * kVertical;
}

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

double focalLengthOf(double viewAngle) {
  constexpr double kSensorHeight = 0.024;
  return 0.5 * kSensorHeight / std::tan(0.5 * viewAngle);
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

}  // namespace fragtrace
