// SPDX-License-Identifier: MIT
// Directions and points drawn by their pdfs, and frames around a normal.

const float kPi = float(3.14159265358979324);
const float kInversePi = float(0.318309886183790672);

/// The distance of the environment and of directional lights.
const float kFarAway = float(3.0e38);

struct Frame3 {
  vec3 tangent;
  vec3 bitangent;
  vec3 normal;
};

/// A right-handed orthonormal frame around a unit normal (Duff et al., Building an Orthonormal Basis, Revisited, 2017).
Frame3 frameAround(vec3 normal) {
  float signZ = normal.z >= 0.0f ? 1.0f : -1.0f;
  float a = -1.0f / (signZ + normal.z);
  float b = normal.x * normal.y * a;
  Frame3 f;
  f.tangent = vec3(1.0f + signZ * normal.x * normal.x * a, signZ * b, -signZ * normal.x);
  f.bitangent = vec3(b, signZ + normal.y * normal.y * a, -normal.y);
  f.normal = normal;
  return f;
}

vec3 toWorld(Frame3 f, vec3 v) { return v.x * f.tangent + v.y * f.bitangent + v.z * f.normal; }

vec3 toFrame(Frame3 f, vec3 v) { return vec3(dot(v, f.tangent), dot(v, f.bitangent), dot(v, f.normal)); }

/// Cosine and sine of an angle in -pi/4..pi/4 by their Taylor series, within 3e-8 on every driver; GLSL leaves sin()
/// and cos() to each.
vec2 cosSinOctant(float x) {
  float s = x * x;
  float c = 1.0f + s * (-0.5f + s * (float(1.0 / 24.0) + s * (float(-1.0 / 720.0) + s * float(1.0 / 40320.0))));
  float n = x + x * s * (float(-1.0 / 6.0) +
                         s * (float(1.0 / 120.0) + s * (float(-1.0 / 5040.0) + s * float(1.0 / 362880.0))));
  return vec2(c, n);
}

/// Cosine and sine of 2 pi u, for u in 0..1.
vec2 unitCircle(float u) {
  float quarter = floor(4.0f * u + 0.5f);
  vec2 p = cosSinOctant(2.0f * kPi * (u - 0.25f * quarter));
  bool turned = quarter == 1.0f || quarter == 3.0f;
  vec2 q = mix(p, vec2(-p.y, p.x), bvec2(turned));
  bool opposite = quarter == 2.0f || quarter == 3.0f;
  return mix(q, -q, bvec2(opposite));
}

/// A point of the unit disk, uniform by area (Shirley and Chiu, 1997: concentric map).
vec2 sampleDisk(float u, float v) {
  float x = 2.0f * u - 1.0f;
  float y = 2.0f * v - 1.0f;
  bool wide = abs(x) > abs(y);
  float radius = mix(y, x, wide);
  float ratio = mix(mix(x / y, y / x, wide), 0.0f, radius == 0.0f);
  // In the steep half, the angle is pi/2 minus this one.
  vec2 p = cosSinOctant(0.25f * kPi * ratio);
  return radius * mix(vec2(p.y, p.x), p, bvec2(wide));
}

/// A direction about +z with pdf cos(theta) / pi (Malley's method).
vec3 sampleCosineHemisphere(float u, float v) {
  vec2 d = sampleDisk(u, v);
  return vec3(d.x, d.y, sqrt(max(0.0f, 1.0f - d.x * d.x - d.y * d.y)));
}

/// A direction uniform in a cone about z. spread: 1 minus the cosine of half the cone's angle.
vec3 sampleCone(float spread, vec2 uv) {
  float down = uv.x * spread;
  vec2 around = unitCircle(uv.y) * sqrt(max(0.0f, down * (2.0f - down)));
  return vec3(around, 1.0f - down);
}

/// Barycentric weights (of the second and the third vertex) of a point uniform in a triangle.
vec2 sampleTriangle(float u, float v) {
  float root = sqrt(u);
  return vec2(root * (1.0f - v), root * v);
}

/// The MIS weight of a direction that was drawn with pdf `own` and that another strategy draws with pdf `other`, times
/// the number of its samples. A pdf `own` of 0 says that no other strategy can: a delta lobe, a punctual light. By the
/// power heuristic, exponent 2 (Veach and Guibas, 1995); of light of the environment by the balance heuristic, for
/// which its MIS compensation is derived, and which is smooth, so that it preserves stratification.
float misWeight(float own, float other, bool environment) {
  if (own <= 0.0f) return 1.0f;
  if (environment) return own / (own + other);
  float ratio = other / own;
  return 1.0f / (1.0f + ratio * ratio);
}

/// The share of a diffuse reflection that is left towards `wi`. Where an interpolated normal sees light near the
/// horizon of its flat triangle, light fades; otherwise it would end abruptly, triangle by triangle (Chiang, Li and
/// Burley, Taming the Shadow Terminator, 2019). At most 1.
float terminatorFade(vec3 faceNormal, vec3 vertexNormal, vec3 wi) {
  float above = dot(vertexNormal, wi) * dot(vertexNormal, faceNormal);
  float g = above > 0.0f ? clamp(dot(faceNormal, wi) / above, 0.0f, 1.0f) : 1.0f;
  return g * (1.0f + g * (1.0f - g));
}

float maxComponent(vec3 v) { return max(v.x, max(v.y, v.z)); }
