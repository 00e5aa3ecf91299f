// SPDX-License-Identifier: MIT
// How much a boundary reflects, and where light goes through it.

/// Schlick, An Inexpensive BRDF Model for Physically-based Rendering, 1994.
vec3 fresnelSchlick(vec3 f0, float f90, float cosine) {
  float m = clamp(1.0f - cosine, 0.0f, 1.0f);
  float m2 = m * m;
  return f0 + (vec3(f90) - f0) * (m2 * m2 * m);
}

/// Unpolarised reflectance of a smooth dielectric boundary. cosine >= 0 is that of the incident side, eta the index
/// behind the boundary over the index before it. 1 at total internal reflection.
float fresnelDielectric(float cosine, float eta) {
  float sineSquared = (1.0f - cosine * cosine) / (eta * eta);
  if (sineSquared >= 1.0f) return 1.0f;
  float refracted = sqrt(1.0f - sineSquared);
  float parallel = (eta * cosine - refracted) / (eta * cosine + refracted);
  float perpendicular = (cosine - eta * refracted) / (cosine + eta * refracted);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// Schlick's approximation of the same; inside the denser side it takes the refracted cosine, so that it, too, is 1
/// at total internal reflection.
float schlickDielectric(float cosine, float eta) {
  float root = (eta - 1.0f) / (eta + 1.0f);
  float f0 = root * root;
  float used = cosine;
  if (eta < 1.0f) {
    float sineSquared = (1.0f - cosine * cosine) / (eta * eta);
    if (sineSquared >= 1.0f) return 1.0f;
    used = sqrt(1.0f - sineSquared);
  }
  float m = 1.0f - used;
  float m2 = m * m;
  return f0 + (1.0f - f0) * (m2 * m2 * m);
}

/// Snell: the direction behind the boundary. outgoing and normal are unit and on the same side; the zero vector at total
/// internal reflection.
vec3 refractThrough(vec3 outgoing, vec3 normal, float eta) {
  float cosine = dot(outgoing, normal);
  float sineSquared = (1.0f - cosine * cosine) / (eta * eta);
  if (sineSquared >= 1.0f) return vec3(0.0f);
  float refracted = sqrt(1.0f - sineSquared);
  return normalize((cosine / eta - refracted) * normal - outgoing / eta);
}

vec3 mirrorDirection(vec3 outgoing, vec3 normal) { return 2.0f * dot(outgoing, normal) * normal - outgoing; }

/// Reflectance of two parallel interfaces, all reflections between them counted.
float thinReflectance(float single) { return 2.0f * single / (1.0f + single); }
