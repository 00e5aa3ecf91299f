// SPDX-License-Identifier: MIT
// Intersects rays with triangles and spheres, and moves origins off the surface on which they start.

/// All triangle tests of one ray share this: its largest axis is rotated to z, and x and y are sheared along it (Woop,
/// Benthin and Wald, Watertight Ray/Triangle Intersection, 2013).
struct RayShear {
  int axis;
  float x;
  float y;
  float z;
};

vec3 rotateToAxis(vec3 v, int axis) {
  vec3 other = mix(v, vec3(v.z, v.x, v.y), bvec3(axis == 1));
  return mix(other, vec3(v.y, v.z, v.x), bvec3(axis == 0));
}

RayShear makeShear(vec3 direction) {
  float ax = abs(direction.x);
  float ay = abs(direction.y);
  float az = abs(direction.z);
  RayShear s;
  s.axis = ax >= ay && ax >= az ? 0 : (ay >= az ? 1 : 2);
  vec3 d = rotateToAxis(direction, s.axis);
  s.z = 1.0f / d.z;
  s.x = d.x * s.z;
  s.y = d.y * s.z;
  return s;
}

/// hit: the line of the ray meets the triangle, in front of the origin where t > 0. front: the ray sees its
/// counter-clockwise side. Meaningless where hit is false.
struct TriangleHit {
  bool hit;
  bool front;
  float t;
  float weight1;  // barycentric weight of v1
  float weight2;  // barycentric weight of v2
};

/// Returns true if all three numbers are above zero or all are below it. A product that underflows counts as zero, and
/// the result is then false.
bool zeroBeyond(float a, float b, float c) { return a * b > 0.0f && b * c > 0.0f; }

/// Watertight: two triangles that share an edge see the same edge function with opposite sign, and zero counts as
/// inside for both. Zero-area triangles are never hit.
TriangleHit intersectTriangle(vec3 origin, RayShear s, vec3 v0, vec3 v1, vec3 v2) {
  vec3 a = rotateToAxis(v0 - origin, s.axis);
  vec3 b = rotateToAxis(v1 - origin, s.axis);
  vec3 c = rotateToAxis(v2 - origin, s.axis);
  precise float ax = a.x - s.x * a.z;
  precise float ay = a.y - s.y * a.z;
  precise float bx = b.x - s.x * b.z;
  precise float by = b.y - s.y * b.z;
  precise float cx = c.x - s.x * c.z;
  precise float cy = c.y - s.y * c.z;
  precise float u = cx * by - cy * bx;
  precise float v = ax * cy - ay * cx;
  precise float w = bx * ay - by * ax;
  float sum = u + v + w;
  bool positive = u >= 0.0f && v >= 0.0f && w >= 0.0f;
  bool negative = u <= 0.0f && v <= 0.0f && w <= 0.0f;
  TriangleHit h;
  float inverse = 1.0f / sum;
  h.t = (u * a.z + v * b.z + w * c.z) * s.z * inverse;
  h.hit = (positive || negative) && sum != 0.0f;
  // The edge functions of a triangle that is small compared with its distance from the ray are only rounding
  // (docs/design/numerics.md, "Zero from far away").
  h.hit = h.hit && !zeroBeyond(ax, bx, cx) && !zeroBeyond(ay, by, cy);
  h.front = (s.z > 0.0f) == (sum > 0.0f);
  h.weight1 = v * inverse;
  h.weight2 = w * inverse;
  return h;
}

/// The plane of a triangle: its unit normal, and its distance from the origin along that.
vec4 planeThrough(vec3 v0, vec3 v1, vec3 v2) {
  vec3 e1 = v1 - v0;
  vec3 e2 = v2 - v0;
  // Scaled, so that no product underflows.
  vec3 largest = max(abs(e1), abs(e2));
  float scale = max(max(largest.x, largest.y), max(largest.z, float(1e-30)));
  vec3 normal = normalize(cross(e1 / scale, e2 / scale));
  return vec4(normal, dot(normal, (v0 + v1 + v2) * float(1.0 / 3.0)));
}

/// The distance along the ray to the plane dot(normal, x) = distance of a triangle, within the depths of its vertices.
/// The weighted depths of a sliver have an error of rounding times its aspect ratio, so a ray that starts next to it
/// could find it behind itself (docs/design/numerics.md, "Distance along the ray"). Farther away than a 64th of those
/// depths, `weighted` is kept where it is the better one: its error is eps L^3 / 4A, that of the plane mostly less than
/// 1.5 eps times the largest coordinate over the cosine to the normal.
float distanceToPlane(vec3 origin, vec3 direction, RayShear s, vec3 v0, vec3 v1, vec3 v2, vec3 normal, float distance,
                      float weighted) {
  float a = rotateToAxis(v0 - origin, s.axis).z * s.z;
  float b = rotateToAxis(v1 - origin, s.axis).z * s.z;
  float c = rotateToAxis(v2 - origin, s.axis).z * s.z;
  float facing = dot(normal, direction);
  float t = (distance - dot(normal, origin)) / facing;
  float nearest = min(min(a, b), c);
  float farthest = max(max(a, b), c);
  vec3 e1 = v1 - v0;
  vec3 e2 = v2 - v0;
  vec3 e3 = v2 - v1;
  float squared = max(max(dot(e1, e1), dot(e2, e2)), dot(e3, e3));
  vec3 corner = max(max(abs(v0), abs(v1)), abs(v2));
  float largest = max(max(corner.x, corner.y), corner.z);
  bool rough = abs(facing) * squared * sqrt(squared) > 3.0f * largest * length(cross(e1, e2));
  return rough || weighted <= 0.015625f * (farthest - nearest) ? max(nearest, min(t, farthest)) : weighted;
}

/// The test of Moller and Trumbore (Fast, Minimum Storage Ray/Triangle Intersection, 1997). Each triangle rounds its
/// edges by itself, so rays can pass between neighbours. The watertight test is compared with it (--disable
/// watertight).
TriangleHit intersectTriangleFast(vec3 origin, vec3 direction, vec3 v0, vec3 v1, vec3 v2) {
  vec3 e1 = v1 - v0;
  vec3 e2 = v2 - v0;
  vec3 p = cross(direction, e2);
  float determinant = dot(e1, p);
  float inverse = 1.0f / determinant;
  vec3 s = origin - v0;
  vec3 q = cross(s, e1);
  TriangleHit h;
  h.weight1 = dot(s, p) * inverse;
  h.weight2 = dot(direction, q) * inverse;
  h.t = dot(e2, q) * inverse;
  h.hit = determinant != 0.0f && h.weight1 >= 0.0f && h.weight2 >= 0.0f && h.weight1 + h.weight2 <= 1.0f;
  h.front = determinant > 0.0f;
  return h;
}

/// Returns true if t is larger than the distance, or equal to it and `at` is true.
bool liesBehind(float t, float distance, bool at) { return t > distance || (at && t == distance); }

/// The distance to the sphere's nearest surface that may be hit and lies behind `tMin` (or at it). `inside`: its inner
/// side counts. A miss is -1. The discriminant uses the distance of the centre from the ray, so that a far sphere keeps
/// its digits (Hearn and Baker's form; Haines et al., Precision Improvements for Ray/Sphere Intersection, 2019).
/// direction is unit length.
float intersectSphere(vec3 origin, vec3 direction, vec3 center, float radius, bool inside, float tMin, bool at) {
  vec3 f = origin - center;
  float b = -dot(f, direction);
  vec3 l = f + b * direction;
  float discriminant = radius * radius - dot(l, l);
  if (discriminant < 0.0f) return -1.0f;
  float q = b + (b >= 0.0f ? 1.0f : -1.0f) * sqrt(discriminant);
  float c = dot(f, f) - radius * radius;
  float t0 = q == 0.0f ? 0.0f : c / q;
  float nearT = min(t0, q);
  float farT = max(t0, q);
  if (liesBehind(nearT, tMin, at)) return nearT;
  return inside && liesBehind(farT, tMin, at) ? farT : -1.0f;
}

/// Moves a point off its surface along the unit geometric normal, to the side of `direction`, by `error`
/// (after Pharr, Jakob and Humphreys, pbrt, 3rd ed. 3.9.5, with one bound for all axes).
vec3 offsetOrigin(vec3 point, float error, vec3 normal, vec3 direction) {
  return point + (dot(direction, normal) < 0.0f ? -error : error) * normal;
}

/// The fraction of the way to a triangle's centroid, where the weight is `middle`, that raises the weight to
/// times * 2^-code, or to a quarter if that is less. A code of 0 asks for nothing.
float insetPart(float weight, float middle, uint code, float times) {
  float least = mix(min(times * uintBitsToFloat((127u - code) << 23), 0.25f), 0.0f, code == 0u);
  return mix(0.0f, (least - weight) / (middle - weight), weight < least);
}

/// The factor of the insets of a point that a ray has reached at distance t, if its offset there is `error`, 2^-19 m:
/// 1 + t / (4 m), where t's factor below is 2^-21. Within the plane, the point is off by roundings of t
/// (docs/design/ray-origins.md, Creases).
float insetTimes(float t, float error) { return (t * float(4.76837158203125e-7) + error) / error; }

/// Moves a point of a triangle, given by its weights, towards the middle until it is as far from edges and vertices as
/// its creases require (creaseInsets of src/scene/creases.h). Otherwise the offset along the normal could lead through
/// the neighbour. `times`: insetTimes(), in an instance times the ray's offset over the triangle's own.
vec3 insetFromCreases(vec3 point, vec2 weights, vec3 middle, uint inset, float times) {
  const float third = 1.0f / 3.0f;
  float w0 = 1.0f - weights.x - weights.y;
  float part = insetPart(w0, third, inset & 31u, times);
  part = max(part, insetPart(weights.x, third, inset >> 5 & 31u, times));
  part = max(part, insetPart(weights.y, third, inset >> 10 & 31u, times));
  part = max(part, insetPart(weights.x + weights.y, 2.0f * third, inset >> 15 & 31u, times));
  part = max(part, insetPart(w0 + weights.y, 2.0f * third, inset >> 20 & 31u, times));
  part = max(part, insetPart(w0 + weights.x, 2.0f * third, inset >> 25 & 31u, times));
  return point + part * (middle - point);
}

/// The point at distance t along a ray, moved onto the plane dot(normal, x) = distance on which it lies except for
/// rounding. So its error off the plane does not grow with the distance from the ray's origin. It is moved along the
/// ray, since the distance to a sliver is its least certain number. Where the ray grazes, it is moved along the normal,
/// since a move along the ray would enlarge the point's own rounding.
vec3 pointOnPlane(vec3 origin, vec3 direction, float t, vec3 normal, float distance) {
  vec3 point = origin + t * direction;
  float facing = dot(normal, direction);
  float height = dot(normal, point) - distance;
  return point - (abs(facing) > 0.25f ? direction * (height / facing) : height * normal);
}
