// SPDX-License-Identifier: MIT
// The camera that frames a scene, and single properties of a camera replaced by the command line's.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

#include "math/bounds.h"
#include "scene/scene.h"

namespace fragtrace {

/// A place on a sphere round the point that the camera looks at, which is upright.
struct Orbit {
  double azimuthDegrees = 0.0;    ///< 0: in front of it (+Z); to the right of who looks from there
  double elevationDegrees = 0.0;  ///< -90 to 90, up
  double zoom = 1.0;              ///< how many times as large things are in the picture

  bool operator==(const Orbit&) const = default;
};

/// Three quarters to the right of the front, as in photographs of products: where a scene without a camera is
/// seen from.
inline constexpr Orbit kFirstView{.azimuthDegrees = 35.0, .elevationDegrees = 20.0};

/// The unit vector from what is looked at to the camera, world space.
glm::dvec3 outwardsOf(const Orbit& orbit);

/// World space, metres; the view angle is vertical.
struct CameraOverrides {
  std::optional<glm::dvec3> position{};
  std::optional<glm::dvec3> focalPoint{};
  std::optional<glm::dvec3> viewUp{};
  std::optional<double> viewAngleDegrees{};
  std::optional<double> parallelScale{};  ///< half of the picture's height: an orthographic view
  std::optional<Orbit> orbit{};
  bool fit = false;  ///< the camera is moved until the scene fills the picture; left to fitted() of fit.h
  /// A fit holds all that the scene fills while it turns about the vertical axis through what the camera
  /// looks at.
  bool turns = false;

  bool operator==(const CameraOverrides&) const = default;
};

/// Looks at the centre of the bounds, 45 degrees high, far enough for the bounding sphere to fit a picture of
/// that width / height: along -z, or along the axis in which the bounds are flat, where it would else see
/// their edge.
Camera frameScene(const BoundsDouble& bounds, double aspectRatio = 1.0);

/// The point at which the camera looks: on its axis, as deep as the centre of the bounds, or, if that is not
/// in front of it, as far away as the bounds are large.
glm::dvec3 focalPointOf(const Camera& camera, const BoundsDouble& bounds);

/// The point on which geometry is best recentred for a picture from `camera`: the nearest point of the
/// scene's box if the camera stands in it or no farther from it than an eighth of its diagonal, so that
/// rounding stays small for what is near the camera; else, and without a camera, the centre, which keeps
/// rounding small everywhere.
glm::dvec3 recentringPoint(const std::optional<glm::dvec3>& camera, const BoundsDouble& bounds);

/// Replaces what is given: the position alone keeps the focal point, as in VTK; a view-up is made orthogonal
/// to the view, and one parallel to it gives way to another axis; a view angle makes an orthographic camera
/// perspective, a parallel scale the other way round. Throws UsageError if the position is the focal point,
/// the angle is not between 0 and 180 degrees, the scale is not above 0, or both are given.
Camera withOverrides(Camera camera, const CameraOverrides& overrides, const BoundsDouble& bounds = {});

/// The focal length of a lens that sees a vertical angle (radians) on a sensor of 35 mm film, 24 mm high;
/// metres.
double focalLengthOf(double viewAngle);

/// A camera with a narrower lens, so that what is in the middle of its picture is so many times as large.
Camera zoomed(Camera camera, double zoom);

/// A point on the axis about which a turntable turns: the focal point asked for, else that of the camera,
/// else, where the scene's bounds placed the camera (orbit, fit), their centre.
glm::dvec3 turningPoint(const Camera& camera, const CameraOverrides& overrides, const BoundsDouble& bounds);

/// The index asked for, or that of the camera asked for by name (indexOfPart()); none where neither is.
/// Throws UsageError.
std::optional<int> cameraIndexOf(std::optional<int> index, const std::string& name,
                                 std::span<const Camera> cameras);

/// The camera of that index, or without one the first, with its overrides but the fit. Without any, the scene
/// is seen from kFirstView unless an orbit or a position is given. An orbit takes only the lens of the
/// camera, stands as far away as one that frames the scene in a picture of that width / height, and is zoomed
/// unless it is to be fitted. Throws UsageError if there is none of that index.
Camera chooseCamera(std::span<const Camera> cameras, std::optional<int> index,
                    const CameraOverrides& overrides, const BoundsDouble& bounds, double aspectRatio = 1.0);

}  // namespace fragtrace
