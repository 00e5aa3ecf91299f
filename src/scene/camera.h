// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/glm.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "base/vectors.h"
#include "scene/local_space.h"
#include "scene/scene.h"

namespace fragtrace {

// The direction of a file that points up, and the turn that makes it +Y.

/// Directions that have a name, in the order of the names.
inline constexpr std::array<std::string_view, 6> kUpAxisNames{"x", "y", "z", "-x", "-y", "-z"};
inline constexpr std::array<glm::dvec3, 6> kUpAxes{glm::dvec3{1, 0, 0},  glm::dvec3{0, 1, 0},
                                                   glm::dvec3{0, 0, 1},  glm::dvec3{-1, 0, 0},
                                                   glm::dvec3{0, -1, 0}, glm::dvec3{0, 0, -1}};

/// The shortest rotation that turns a direction of any length but 0 to +Y; of -Y it is half a turn about Z.
/// It is exact for axes, and moves no bit of a number then.
glm::dmat3 turnToY(const glm::dvec3& up);

/// The direction that points up in a file where three points are level, which are in the space that `up` of
/// the file is turned to +Y in: of the two that are possible the one that is nearer to `up`. It is rounded to
/// a millionth. None if the points lie on a line.
std::optional<glm::dvec3> levelUp(const std::array<glm::dvec3, 3>& points, const glm::dvec3& up);

// Maps between places in a camera's picture and rays and points of the scene. A place is -1..1 from left to
// right and from the bottom to the top.

/// World space, metres.
struct Projection {
  glm::dvec3 position{0.0};
  /// Half of the view's width: at distance 1 of a perspective, in metres of an orthographic view, in radians
  /// of a panorama and a fisheye.
  glm::dvec3 right{1.0, 0.0, 0.0};
  glm::dvec3 up{0.0, 1.0, 0.0};  ///< half of its height
  glm::dvec3 forward{0.0, 0.0, -1.0};
  glm::dvec2 shift{0.0};  ///< the place that would be the middle without the lens's shift is at -shift
  CameraType type = CameraType::Perspective;

  bool operator==(const Projection&) const = default;
};

/// Half of a picture's width and height as in Projection, in `unit` metres where these are metres. Only the
/// ratio of `width` to `height` counts.
glm::dvec2 halfExtents(const Camera& camera, double width, double height, double unit = 1.0);

/// The projection of a picture of that width / height.
Projection projectionOf(const Camera& camera, double aspectRatio);

/// The ray through a place, without a limit, in local space. Outside of a fisheye's circle there is none.
std::optional<Ray> rayThrough(const Projection& projection, const LocalSpace& space, const glm::dvec2& place);

/// A point as x, y, w of a rectilinear camera: its place is (x, y) / w where w > 0. For a perspective, w is
/// metres along the view's axis; an orthographic view has w = 1 everywhere, also behind the camera.
glm::dvec3 projected(const Projection& projection, const glm::dvec3& point);

// The camera that frames a scene, and single properties of a camera replaced by the command line's.

/// A place on a sphere around the point at which an upright camera looks.
struct Orbit {
  /// 0 is in front of the point (towards +Z); positive angles are to the right of a viewer in front
  double azimuthDegrees = 0.0;
  double elevationDegrees = 0.0;  ///< -90 to 90, up
  double zoom = 1.0;              ///< factor by which things are larger in the picture

  bool operator==(const Orbit&) const = default;
};

/// Three quarters to the right of the front, as in photographs of products. Scenes without a camera are seen
/// from there.
inline constexpr Orbit kFirstView{.azimuthDegrees = 35.0, .elevationDegrees = 20.0};

/// World space, metres; the view angle is vertical, or of a fisheye's circle.
struct CameraOverrides {
  std::optional<CameraType> type{};
  std::optional<glm::dvec3> position{};
  std::optional<glm::dvec3> focalPoint{};
  std::optional<glm::dvec3> viewUp{};
  std::optional<double> viewAngleDegrees{};
  std::optional<double> parallelScale{};  ///< half of the picture's height: an orthographic view
  /// Shift to the right and up, in parts of the picture's width and height.
  std::optional<glm::dvec2> lensShift{};
  std::optional<Orbit> orbit{};
  bool fit = false;  ///< the camera is moved until the scene fills the picture; left to fitted() of fit.h
  bool fitShadow = false;        ///< the same, and the shadow on the catcher counts
  std::string fitTo{};           ///< the same, for a part of the scene: outlineOf()
  std::optional<double> fill{};  ///< the same: the share of the picture that is filled; none: kFitted
  bool leavesStrays = false;     ///< the view is the default one, so that strays do not decide it
  /// A fit holds all of the space that the scene fills while it turns about the vertical axis through the
  /// point looked at.
  bool turns = false;

  /// Returns true if any of the members asks for a fit.
  bool asksForFit() const { return fit || fitShadow || !fitTo.empty() || fill; }

  bool operator==(const CameraOverrides&) const = default;
};

/// A camera that looks at the centre of the bounds with an angle of 45 degrees, from far enough that the
/// bounding sphere fits a picture of that width / height. It looks along -z, or along the axis in which the
/// bounds are flat, which it would otherwise see from the edge.
Camera frameScene(const BoundsDouble& bounds, double aspectRatio = 1.0);

/// The point at which the camera looks: on its axis, as deep as the centre of the bounds, or, if that is not
/// in front of it, as far away as the bounds are large.
glm::dvec3 focalPointOf(const Camera& camera, const BoundsDouble& bounds);

/// The point at which geometry is best recentred for a picture from `camera`: the nearest point of the
/// scene's box if the camera is inside it or at most an eighth of its diagonal away, so that rounding stays
/// small near the camera; else, and without a camera, the centre, which keeps rounding small everywhere.
glm::dvec3 recentringPoint(const std::optional<glm::dvec3>& camera, const BoundsDouble& bounds);

/// Replaces the properties that are given. A position alone keeps the focal point, as in VTK, but of a
/// panorama and a fisheye the direction. A view-up is made orthogonal to the view; one parallel to it is
/// replaced by another axis. A position and a focal point without a view-up make a level camera. Without a
/// type, a view angle makes an orthographic camera perspective, and a parallel scale makes a perspective one
/// orthographic. A type alone keeps the size of what lies in the focal point's plane. A panorama is level:
/// the view-up, or +Y, is its up, and its middle is what lies level below or above the view. It is twice as
/// wide as high, and a fisheye square, unless the picture's size is given. Throws UsageError if the position
/// is the focal point, or the angle or the scale is out of range.
Camera withOverrides(Camera camera, const CameraOverrides& overrides, const BoundsDouble& bounds = {});

constexpr double kSensorHeight = 0.024;  ///< of 35 mm film; metres

/// The focal length (metres) of a lens that sees a vertical angle (radians) on a sensor of that height.
double focalLengthOf(double viewAngle);

/// The vertical angle (radians) that a lens sees on a sensor; both lengths in the same unit.
double viewAngleOf(double focalLength, double sensorHeight);

/// Returns a camera with a narrower lens, so that the middle of its picture is `zoom` times as large.
Camera zoomed(Camera camera, double zoom);

/// A point on the axis about which a turntable turns: the focal point asked for, else that of the camera,
/// else, where the scene's bounds placed the camera (orbit, fit), their centre. A panorama and a fisheye that
/// no orbit places turn where they stand.
glm::dvec3 turningPoint(const Camera& camera, const CameraOverrides& overrides, const BoundsDouble& bounds);

/// The index asked for, or that of the camera asked for by name (indexOfPart()); none if neither is given.
/// Throws UsageError.
std::optional<int> cameraIndexOf(std::optional<int> index, const std::string& name,
                                 std::span<const Camera> cameras);

/// The camera of that index, or without an index the first one, with its overrides except the fit. Without a
/// camera, the scene is seen from kFirstView unless an orbit or a position is given. An orbit keeps only the
/// lens of the camera. It stands as far away as a camera that frames the scene in a picture of that width /
/// height, and is zoomed unless it is to be fitted. Throws UsageError if there is no camera of that index.
Camera chooseCamera(std::span<const Camera> cameras, std::optional<int> index,
                    const CameraOverrides& overrides, const BoundsDouble& bounds, double aspectRatio = 1.0);

/// The overrides that are asked for, with `fit` where any member asks for one. firstView() is added if the
/// scene has no camera, and neither a position nor an orbit is asked for. The scene then fills the picture,
/// unless a focal point, a scale or a fisheye is asked for. A panorama is seen from the middle of the scene.
CameraOverrides settledOverrides(CameraOverrides asked, const Scene& scene);

}  // namespace fragtrace
