// SPDX-License-Identifier: MIT
// Cameras whose pictures are no perspective: an equirectangular panorama and an equidistant fisheye. Directions are in
// the camera's own axes: x to the right, y up, z forward; none has a length of its own but those that are returned.

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

/// The same of the fisheye: sin a / a at the angle a.
float fisheyeSpread(vec3 d) {
  float aside = length(vec2(d.x, d.y));
  return aside > float(1e-6) ? aside / atan(aside, d.z) : 1.0f;
}
