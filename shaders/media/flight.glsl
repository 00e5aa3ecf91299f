// SPDX-License-Identifier: MIT
// Free flights through homogeneous media. Distances are drawn for one channel, chosen by the throughput; all three
// share the pdf of the choice (one-sample MIS: Wilkie et al., Hero Wavelength Spectral Sampling, 2014; Pharr, Jakob
// and Humphreys, Physically Based Rendering, 2023, chapter 14).

struct Medium {
  vec3 extinction;  // 1 / local space
  vec3 albedo;      // albedo of one scattering
  float g;          // anisotropy (phase.glsl)
};

/// A medium that only absorbs is no matter of chance.
bool scattersLight(Medium m) { return maxComponent(m.albedo * m.extinction) > 0.0f; }

/// Chances of the three channels.
vec3 channelChances(vec3 throughput) {
  float sum = throughput.x + throughput.y + throughput.z;
  return sum > 0.0f ? throughput / sum : vec3(float(1.0 / 3.0));
}

/// The distance that u draws, up to the first meeting with the medium.
float flightDistance(Medium m, vec3 chances, float u) {
  bool red = u < chances.x;
  bool green = !red && u < chances.x + chances.y;
  float first = mix(mix(chances.x + chances.y, chances.x, green), 0.0f, red);
  float chance = mix(mix(chances.z, chances.y, green), chances.x, red);
  float extinction = mix(mix(m.extinction.z, m.extinction.y, green), m.extinction.x, red);
  float rest = 1.0f - clamp((u - first) / max(chance, float(1e-12)), 0.0f, float(0.99999994));
  return extinction > 0.0f ? -log(rest) / extinction : kFarAway;
}

/// Transmittance up to a factor that all channels share, so that it does not underflow: 1 in the clearest channel that
/// has a chance.
vec3 scaledTransmittance(Medium m, vec3 chances, float distance) {
  float clearest = min(min(chances.x > 0.0f ? m.extinction.x : kFarAway, chances.y > 0.0f ? m.extinction.y : kFarAway),
                       chances.z > 0.0f ? m.extinction.z : kFarAway);
  return exp(-distance * max(m.extinction - vec3(clearest), vec3(0.0f)));
}

/// The factor of the throughput where a flight passes `distance`: transmittance / chance to pass.
vec3 passWeight(Medium m, vec3 chances, float distance) {
  if (!scattersLight(m)) return exp(-distance * m.extinction);
  vec3 t = scaledTransmittance(m, chances, distance);
  return t / dot(chances, t);
}

/// The factor where the flight ends at `distance`: scattering coefficient x transmittance / pdf.
vec3 scatterWeight(Medium m, vec3 chances, float distance) {
  vec3 t = m.extinction * scaledTransmittance(m, chances, distance);
  return m.albedo * t / max(dot(chances, t), float(1e-37));
}
