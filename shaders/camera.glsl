// SPDX-License-Identifier: MIT
// Camera rays.

struct CameraRay {
  vec3 origin;
  vec3 direction;
};

/// The ray through a point of the picture; x and y in -1..1, y up. right and up span half of the view.
CameraRay makeCameraRay(vec3 position, vec3 right, vec3 up, vec3 forward, bool orthographic, float x, float y) {
  vec3 offset = x * right + y * up;
  CameraRay r;
  r.origin = orthographic ? position + offset : position;
  r.direction = orthographic ? forward : normalize(forward + offset);
  return r;
}
