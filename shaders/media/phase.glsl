// SPDX-License-Identifier: MIT
// The phase function of participating media (Henyey and Greenstein, Diffuse radiation in the galaxy, 1941). The
// anisotropy g is the mean cosine of a scattering: above 0 light continues forward.

/// The pdf over solid angle of the cosine between the directions of travel before and after. It is the value, too.
float phasePdf(float g, float cosine) {
  float strength = abs(g);
  float c = g < 0.0f ? -cosine : cosine;
  // 1 + g^2 - 2 g c without its cancellation.
  float base = (1.0f - strength) * (1.0f - strength) + 2.0f * strength * (1.0f - c);
  return (1.0f - g * g) * 0.25f * kInversePi / (base * sqrt(base));
}

/// The cosine that u draws: the inverted cumulative distribution, as a ratio that holds for g = 0, too.
float samplePhaseCosine(float g, float u) {
  float a = abs(g);
  float s = 2.0f * u - 1.0f;
  float d = 1.0f + a * s;
  float c = (2.0f * s + a * (s * s + 3.0f) + 2.0f * a * a * s + a * a * a * (s * s - 1.0f)) / (2.0f * d * d);
  return clamp(g < 0.0f ? -c : c, -1.0f, 1.0f);
}

/// A direction of travel after a scattering, of the one before; (u, v) uniform in the unit square.
vec3 samplePhase(float g, vec3 direction, float u, float v) {
  float cosine = samplePhaseCosine(g, u);
  float sine = sqrt(max(0.0f, 1.0f - cosine * cosine));
  vec2 around = unitCircle(v);
  return toWorld(frameAround(direction), vec3(sine * around.x, sine * around.y, cosine));
}
