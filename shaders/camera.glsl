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
