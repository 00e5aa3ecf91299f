// SPDX-License-Identifier: MIT
// The GGX microfacet distribution in a frame whose z is the normal (glTF 2.0, appendix B): isotropic, or stretched
// along x (kAnisotropy), with facets of width alpha x stretch along x and alpha / stretch along y. In a space that is
// stretched the other way, stretched facets are isotropic.

/// The Trowbridge-Reitz distribution D(h) of half vectors, in the form that keeps its digits at small alpha.
float ggxD(vec3 h, float alpha) {
  float a2 = alpha * alpha;
  float d = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
  return kInversePi / (a2 * d * d);
}

/// Smith's Lambda for GGX.
float ggxLambda(vec3 v, float alpha) {
  float z2 = v.z * v.z;
  float tangentSquared = (v.x * v.x + v.y * v.y) / max(z2, float(1e-30));
  return 0.5f * (sqrt(1.0f + alpha * alpha * tangentSquared) - 1.0f);
}

float ggxMasking(vec3 v, float alpha) { return 1.0f / (1.0f + ggxLambda(v, alpha)); }

/// Height-correlated masking and shadowing (Heitz, Understanding the Masking-Shadowing Function, 2014).
float ggxMaskingShadowing(vec3 wo, vec3 wi, float alpha) {
  return 1.0f / (1.0f + ggxLambda(wo, alpha) + ggxLambda(wi, alpha));
}

/// A half vector visible from `wo` (z > 0), with pdf D(h) G1(o) max(0, o.h) / o.z (Dupuy and Benyoub,
/// Sampling Visible GGX Normals with Spherical Caps, 2023).
vec3 sampleVisibleGgx(vec3 wo, float alpha, float u, float v) {
  vec3 stretched = normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
  vec2 around = unitCircle(u);
  float z = (1.0f - v) * (1.0f + stretched.z) - stretched.z;
  float sine = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
  vec3 cap = vec3(sine * around.x, sine * around.y, z) + stretched;
  return normalize(vec3(alpha * cap.x, alpha * cap.y, max(cap.z, float(1e-12))));
}

float visibleGgxPdf(vec3 wo, vec3 h, float alpha) {
  return ggxD(h, alpha) * ggxMasking(wo, alpha) * max(0.0f, dot(wo, h)) /
         max(wo.z, float(1e-12));
}

/// The direction in the space where facets are isotropic, alpha wide, for masking.
vec3 alongMicrofacets(vec3 v, float stretch) { return kAnisotropy ? vec3(v.x * stretch, v.y / stretch, v.z) : v; }

/// The half vector in the space where facets are isotropic, for their pdf.
vec3 acrossMicrofacets(vec3 h, float stretch) { return kAnisotropy ? vec3(h.x / stretch, h.y * stretch, h.z) : h; }

/// The pdf of the half vectors visible from `wo` (z > 0).
float microfacetPdf(vec3 wo, vec3 h, float alpha, float stretch) {
  float masked = ggxD(acrossMicrofacets(h, stretch), alpha) * ggxMasking(alongMicrofacets(wo, stretch), alpha);
  return masked * max(0.0f, dot(wo, h)) / max(wo.z, float(1e-12));
}

vec3 sampleMicrofacet(vec3 wo, float alpha, float stretch, float u, float v) {
  vec3 h = sampleVisibleGgx(alongMicrofacets(wo, stretch), alpha, u, v);
  return kAnisotropy ? normalize(alongMicrofacets(h, stretch)) : h;
}

/// The quotient of masking and shadowing together over masking alone.
float microfacetShadowing(vec3 wo, vec3 wi, float alpha, float stretch) {
  vec3 o = alongMicrofacets(wo, stretch);
  return ggxMaskingShadowing(o, alongMicrofacets(wi, stretch), alpha) / ggxMasking(o, alpha);
}

/// Root mean square of the widths of stretched facets, as a factor of alpha. Isotropic facets of that width lose as
/// much light on average: within 5 % (of the loss) for all stretches.
float microfacetMean(float stretch) {
  return kAnisotropy ? sqrt(0.5f * (stretch * stretch + 1.0f / (stretch * stretch))) : 1.0f;
}

/// Compensation returns this share of the lost light (stretch >= 1), so that no direction gains more than 1 %.
float microfacetsGiveBack(float stretch) {
  float fourth = stretch * stretch * stretch * stretch;
  return 1.0f - float(0.1) * (fourth - 1.0f) / (fourth + 1.0f);
}
