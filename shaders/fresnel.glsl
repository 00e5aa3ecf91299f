// SPDX-License-Identifier: MIT
// Fresnel reflectances, and directions of reflection and refraction.

/// Schlick, An Inexpensive BRDF Model for Physically-based Rendering, 1994.
vec3 fresnelSchlick(vec3 f0, float f90, float cosine) {
  float m = clamp(1.0f - cosine, 0.0f, 1.0f);
  float m2 = m * m;
  return f0 + (vec3(f90) - f0) * (m2 * m2 * m);
}

/// The square of eta times the cosine behind the boundary; negative at total internal reflection. As a product it keeps
/// its digits where index and angle bring it near zero, and an index of 1 refracts at every angle.
float refractedSquared(float cosine, float eta) { return (eta - 1.0f) * (eta + 1.0f) + cosine * cosine; }

/// Unpolarised reflectance of a smooth dielectric boundary. cosine >= 0 is that of the incident side, eta the index
/// behind the boundary over the index before it. 1 at total internal reflection.
float fresnelDielectric(float cosine, float eta) {
  float squared = refractedSquared(cosine, eta);
  if (squared < 0.0f) return 1.0f;
  float refracted = sqrt(squared);
  // Both are zero in the plane of a boundary between equal indices, which reflects nothing. Below 1e-19, drivers flush
  // the square of the cosine to zero.
  const float tiny = float(1e-15);
  float parallel = (eta * eta * cosine - refracted) / max(eta * eta * cosine + refracted, tiny);
  float perpendicular = (cosine - refracted) / max(cosine + refracted, tiny);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// Schlick's approximation of the same. Inside the denser side it uses the refracted cosine, so that it, too, is 1 at
/// total internal reflection.
float schlickDielectric(float cosine, float eta) {
  float root = (eta - 1.0f) / (eta + 1.0f);
  float f0 = root * root;
  float squared = refractedSquared(cosine, eta);
  if (squared < 0.0f) return 1.0f;
  float used = eta < 1.0f ? sqrt(squared) / eta : cosine;
  float m = 1.0f - used;
  float m2 = m * m;
  return f0 + (1.0f - f0) * (m2 * m2 * m);
}

/// Snell's law: the direction behind the boundary. wo and normal are unit and on the same side. The caller has
/// excluded total internal reflection; where rounding still leads there, the direction runs along the boundary.
vec3 refractThrough(vec3 wo, vec3 normal, float eta) {
  float cosine = dot(wo, normal);
  float refracted = sqrt(max(refractedSquared(cosine, eta), 0.0f));
  return normalize((cosine - refracted) * normal - wo);
}

vec3 mirrorDirection(vec3 wo, vec3 normal) { return 2.0f * dot(wo, normal) * normal - wo; }

/// Reflectance of two parallel interfaces, all reflections between them counted.
float thinReflectance(float single) { return 2.0f * single / (1.0f + single); }

/// The chance that glass which shares its paths reflects one. By two reflections of 4 %, one of 600 paths would meet a
/// lamp, as a bright dot.
float sharedChance(float reflectance) {
  const float least = float(0.2);
  bool both = reflectance > 0.0f && reflectance < 1.0f;
  return both ? clamp(reflectance, least, 1.0f - least) : reflectance;
}

/// The weight of such a path.
float sharedWeight(float reflectance, float chance, bool transmitted) {
  if (chance == reflectance) return 1.0f;
  return transmitted ? (1.0f - reflectance) / (1.0f - chance) : reflectance / chance;
}

/// Mean of Schlick's reflectance over cosine-weighted directions.
vec3 averageFresnel(vec3 f0, float f90) { return f0 + (vec3(f90) - f0) / float(21.0); }

/// Mean reflectance of a boundary over cosine-weighted directions, by the fits of Kulla and Conty (Revisiting
/// Physically Based Shading at Imageworks, 2017).
float averageDielectric(float eta) {
  if (eta >= 1.0f) return (eta - 1.0f) / (float(4.08567) + float(1.00071) * eta);
  return float(0.997118) + eta * (float(0.1014) - eta * (float(0.965241) + float(0.130607) * eta));
}
