// SPDX-License-Identifier: MIT
// The camera in a viewer's hand: movements as functions from pose to pose. Distances follow that to the focal
// point, so no scene is too small or too large; a movement beyond 1e9 metres, where scenes end, changes
// nothing.
#pragma once

#include "scene/camera.h"

namespace fragtrace {

/// A camera by what turns and moves it; world space, metres.
struct CameraPose {
  glm::dvec3 position{0.0, 0.0, 1.0};
  glm::dvec3 focalPoint{0.0};
  glm::dvec3 viewUp{0.0, 1.0, 0.0};  ///< unit, orthogonal to the view
  CameraType type = CameraType::Perspective;
  double viewAngleDegrees = 45.0;  ///< vertical, of a perspective; kept while it is none
  double fisheyeDegrees = 180.0;   ///< angle of a fisheye's circle
  double halfHeight = 1.0;         ///< metres, of an orthographic view
  glm::dvec2 lensShift{0.0};       ///< Camera::shift; kept while the view is not rectilinear

  bool operator==(const CameraPose&) const = default;
};

/// The pose of a camera; the bounds say where on its axis the focal point lies (focalPointOf).
CameraPose poseOf(const Camera& camera, const BoundsDouble& bounds);

/// The options that give any camera this pose: all but the angle or the height that its projection does not
/// use. The viewer always draws withOverrides() of these, so `render` draws the same.
CameraOverrides overridesOf(const CameraPose& pose);

/// Turns about the focal point, radians: positive `azimuth` turns the picture to the right about the world's
/// y axis, positive `elevation` lifts the camera. Ends a thousandth of a radian before the poles, so that up
/// stays up.
CameraPose orbit(CameraPose pose, double azimuth, double elevation);

/// Turns about the view's axis, radians; positive: the picture turns clockwise.
CameraPose roll(CameraPose pose, double angle);

/// Moves camera and focal point in the plane of the picture, so that what lies in the focal point's plane
/// moves by `shift` with the pointer: parts of the picture's height, to the right and up.
CameraPose pan(CameraPose pose, const glm::dvec2& shift);

/// Magnifies what lies in the focal point's plane by e^amount: comes nearer, or narrows an orthographic view.
CameraPose zoom(CameraPose pose, double amount);

/// Does the same, so that what lies in the focal point's plane at `place` stays there: from the picture's
/// middle, in halves of its height to the right and up.
CameraPose zoomAt(CameraPose pose, double amount, const glm::dvec2& place);

/// Moves camera and focal point by `amount` times their distance: to the right, up, forwards.
CameraPose fly(CameraPose pose, const glm::dvec3& amount);

/// Moves the camera sideways until it looks straight at a point, which becomes the focal point. A point that
/// is not in front of it changes nothing.
CameraPose centerOn(CameraPose pose, const glm::dvec3& point);

inline constexpr double kLeastStop = 0.001;
inline constexpr double kMostStop = 32.0;
/// Returns an f-number whose blur can be seen, whatever the size of the scene.
double firstStop(const CameraPose& pose);

/// Looks in the same direction at the centre of the bounds, from where their bounding sphere fits a picture
/// of this width / height.
CameraPose frameAll(CameraPose pose, const BoundsDouble& bounds, double aspectRatio);

/// Looks along a direction at the same focal point from the same distance; `viewUp` must not be parallel to
/// it.
CameraPose lookAlong(CameraPose pose, const glm::dvec3& direction, const glm::dvec3& viewUp);

/// The vertical view angle times e^amount, between 1 and 170 degrees, from the same place.
CameraPose widen(CameraPose pose, double amount);

/// Another projection; what lies in the focal point's plane keeps its size in perspective and orthographic
/// views.
CameraPose withProjection(CameraPose pose, CameraType type);

/// Orthographic instead of perspective, and perspective instead of all others.
CameraPose withOtherProjection(const CameraPose& pose);

}  // namespace fragtrace
