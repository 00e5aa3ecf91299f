// SPDX-License-Identifier: MIT
// The reflection model of the stages before global illumination (docs/design/surfaces.md).

/// Normal-incidence reflectance of a material: dielectric and metal mixed.
vec3 phongF0(vec3 baseColor, float metallic, vec3 dielectricF0) {
  return mix(dielectricF0, baseColor, vec3(metallic));
}

/// Blinn-Phong exponent of a roughness.
float phongExponent(float roughness) {
  float r2 = roughness * roughness;
  return 2.0f / max(r2 * r2, float(0.001)) - 2.0f;
}

/// The albedo of the highlight of f0 = 1 under even light, seen at a cosine: exact at normal incidence, within 0.7 %
/// elsewhere (fitted to numerical integrals).
float phongAlbedo(float exponent, float cosine) {
  float n = exponent;
  float facing = (n + 8.0f) * (n + pow(float(0.5), 0.5f * n)) / ((n + 2.0f) * (n + 4.0f));
  float even = (1.0f + float(1.1951) * n) / (1.0f + float(1.7597) * n + float(1.0185) * n * n);
  float linear = float(0.8543) * n / (1.0f + float(0.2964) * n + float(0.2769) * n * n);
  return facing * (cosine * cosine + (1.0f - cosine) * ((1.0f + cosine) * even + cosine * linear));
}

/// Lambert plus normalised Blinn-Phong (Blinn, Models of Light Reflection, 1977), times the cosine.
vec3 phongValue(vec3 diffuse, vec3 f0, float exponent, vec3 normal, vec3 wo, vec3 wi) {
  float cosine = dot(normal, wi);
  if (cosine <= 0.0f) return vec3(0.0f);
  vec3 h = wo + wi;
  float squared = dot(h, h);
  float nh = squared > 0.0f ? max(0.0f, dot(normal, h) / sqrt(squared)) : 0.0f;
  float highlight = nh > 0.0f ? pow(nh, exponent) : 0.0f;
  return cosine * (kInversePi * diffuse + (0.125f * (exponent + 8.0f) * kInversePi * highlight) * f0);
}
