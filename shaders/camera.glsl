// SPDX-License-Identifier: MIT
// Camera rays.

struct CameraRay {
  vec3 origin;
  vec3 direction;
};

/// The ray through a point of the picture; x and y are in -1..1, with y up. right and up span half of the view.
CameraRay makeCameraRay(vec3 position, vec3 right, vec3 up, vec3 forward, bool orthographic, float x, float y) {
  vec3 offset = x * right + y * up;
  CameraRay r;
  r.origin = orthographic ? position + offset : position;
  r.direction = orthographic ? forward : normalize(forward + offset);
  return r;
}

/// A point of the aperture of radius 1, uniform by area: a disk, or with three blades or more a regular polygon with a
/// corner at the top.
vec2 sampleAperture(float u, float v, int blades) {
  if (blades < 3) return sampleDisk(u, v);
  float turns = u * float(blades);
  float blade = min(floor(turns), float(blades - 1));
  vec2 a = unitCircle(blade / float(blades));
  vec2 b = unitCircle((blade + 1.0f) / float(blades));
  float side = turns - blade;
  float outward = sqrt(v);
  return vec2(outward * (a.y + side * (b.y - a.y)), outward * (a.x + side * (b.x - a.x)));
}

/// Bends the ray of a pinhole camera as a thin lens does: the ray starts at a point of the lens, in units of length
/// along right and up, and passes through the point at which the pinhole's ray meets the plane in focus, at a distance
/// along forward (Cook, Porter and Carpenter, Distributed Ray Tracing, 1984).
CameraRay throughLens(CameraRay ray, vec3 right, vec3 up, vec3 forward, vec2 lens, float focus) {
  vec3 sharp = ray.direction * (focus / dot(ray.direction, forward));
  vec3 offset = lens.x * normalize(right) + lens.y * normalize(up);
  CameraRay r;
  r.origin = ray.origin + offset;
  r.direction = normalize(sharp - offset);
  return r;
}

const uint kTimeDimension = 3u;

/// The time of a path, 0..1 while the shutter is open. Each path has one, so a pixel sees the mean over them (Cook,
/// Porter and Carpenter, Distributed Ray Tracing, 1984).
float timeOf(Sampler s) { return drawFloat(s, kTimeDimension); }

/// A rigid motion: a turn about a unit axis, then a shift.
struct RigidMotion {
  vec3 axis;
  vec2 circle;  // cosine and sine of the angle
  vec3 shift;
};

vec3 turnedBy(RigidMotion m, vec3 v) {
  return m.circle.x * v + m.circle.y * cross(m.axis, v) + (1.0f - m.circle.x) * dot(m.axis, v) * m.axis;
}

/// The motion of a camera over a part of the time that the shutter is open, which may be negative. turn: axis and
/// angle over all of it. slide: the motion of its position over all of it, at the speed that it has in the middle. The
/// position runs along a helix, and so along a circle or a straight line, too (Chasles' theorem).
RigidMotion motionOver(vec4 turn, vec3 slide, float part) {
  RigidMotion m;
  m.axis = vec3(turn);
  float angle = part * turn.w;
  float turns = angle * (0.5f * kInversePi);
  m.circle = unitCircle(turns - floor(turns));
  float squared = angle * angle;
  // sin(a) / a and (1 - cos(a)) / a; of small angles by their series.
  bool small = abs(angle) < 0.1f;
  float sine = small ? 1.0f - squared * (1.0f - 0.05f * squared) / 6.0f : m.circle.y / angle;
  float versine = small ? angle * (0.5f - squared * (1.0f - squared / 30.0f) / 24.0f) : (1.0f - m.circle.x) / angle;
  vec3 along = dot(slide, m.axis) * m.axis;
  m.shift = part * (along + sine * (slide - along) + versine * cross(m.axis, slide));
  return m;
}

// An equirectangular panorama and an equidistant fisheye. Directions are in the camera's own axes: x to the right, y
// up, z forward. Those that are returned are unit vectors; others have any length.

/// The direction through a place of the panorama: x is in half turns to the right of forward, y in quarter turns up.
/// Places beyond the poles continue on the other side.
vec3 panoramaDirection(float x, float y) {
  float turn = 0.5f * x;
  vec2 around = unitCircle(turn - floor(turn));
  turn = 0.25f * y;
  vec2 upward = unitCircle(turn - floor(turn));
  return vec3(upward.x * around.y, upward.y, upward.x * around.x);
}

/// The place of a direction in the panorama, -1..1.
vec2 panoramaPlace(vec3 d) {
  return vec2(atan(d.x, d.z) * kInversePi, atan(d.y, length(vec2(d.x, d.z))) * (2.0f * kInversePi));
}

/// The direction through a place of the fisheye: its length is the angle from forward.
vec3 fisheyeDirection(float x, float y) {
  float angle = length(vec2(x, y));
  float turn = angle * (0.5f * kInversePi);
  vec2 away = unitCircle(turn - floor(turn));
  float aside = away.y / max(angle, float(1e-30));
  return vec3(x * aside, y * aside, away.x);
}

/// The place of a direction in the fisheye.
vec2 fisheyePlace(vec3 d) {
  float aside = length(vec2(d.x, d.y));
  float part = aside > 0.0f ? atan(aside, d.z) / aside : 0.0f;
  return vec2(d.x * part, d.y * part);
}

/// The solid angle of a small part of the panorama over its area, at a unit direction.
float panoramaSpread(vec3 d) { return 0.5f * kPi * kPi * length(vec2(d.x, d.z)); }

/// Returns the same of the fisheye: sin a / a at the angle a.
float fisheyeSpread(vec3 d) {
  float aside = length(vec2(d.x, d.y));
  return aside > float(1e-6) ? aside / atan(aside, d.z) : 1.0f;
}
