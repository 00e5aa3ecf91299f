// SPDX-License-Identifier: MIT
// The lobe of velvet (Estevez and Kulla, Production Friendly Microfacet Sheen BRDF, 2017; KHR_materials_sheen), in a
// frame whose z is the normal. alpha is the square of the extension's sheenRoughness.

/// The fit of the logarithm of Smith's Lambda for cosines up to a half.
float sheenFit(float x, float alpha) {
  float t = (1.0f - alpha) * (1.0f - alpha);
  float a = mix(float(21.5473), float(25.3245), t);
  float b = mix(float(3.82987), float(3.32435), t);
  float c = mix(float(0.19823), float(0.16801), t);
  float d = mix(float(-1.97760), float(-1.27393), t);
  float e = mix(float(-4.32054), float(-4.85967), t);
  return a / (1.0f + b * pow(x, c)) + d * x + e;
}

float sheenLambda(float cosine, float alpha) {
  if (cosine < 0.5f) return exp(sheenFit(cosine, alpha));
  // Rounding makes cosines of 1 and a little more. The power of a negative number would be NaN.
  return exp(2.0f * sheenFit(0.5f, alpha) - sheenFit(max(0.0f, 1.0f - cosine), alpha));
}

/// Value times the cosine of `wi`, for white sheen; both directions are above the surface. Its albedo is
/// sheenAlbedo. At grazing angles of low roughness that is above 1: the lobe would reflect more light than it receives,
/// and is divided by its albedo.
float sheenValue(vec3 wo, vec3 wi, float alpha) {
  vec3 h = normalize(wo + wi);
  float sine2 = max(0.0f, h.x * h.x + h.y * h.y);
  float distribution = (2.0f + 1.0f / alpha) * pow(sine2, 0.5f / alpha) * (0.5f * kInversePi);
  float shadowing = 1.0f + sheenLambda(wo.z, alpha) + sheenLambda(wi.z, alpha);
  float most = max(1.0f, max(sheenAlbedo(wo.z, alpha), sheenAlbedo(wi.z, alpha)));
  return distribution / (shadowing * 4.0f * max(wo.z, float(1e-6)) * most);
}

/// The largest share of light that white sheen sends back, seen at `cosine`.
float sheenShare(float cosine, float alpha) { return min(1.0f, sheenAlbedo(abs(cosine), alpha)); }

/// A direction above the surface with the same pdf everywhere, 1 / (2 pi).
vec3 sampleHemisphere(float u, float v) {
  vec2 around = unitCircle(u);
  float sine = sqrt(max(0.0f, 1.0f - v * v));
  return vec3(sine * around.x, sine * around.y, v);
}
