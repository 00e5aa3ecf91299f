// SPDX-License-Identifier: MIT
// Takes one of several candidates as the light sample: resampled importance sampling (Talbot, Cline and Egbert,
// Importance Resampling for Global Illumination, 2005).

/// The largest number of additional loop iterations of a scattering. Neighbours add the way from a leaf of the light
/// tree to its root.
const int kCandidateIterations = (kCandidates ? int(kLightCandidates) * (kLightTree ? 16 : 8) : 0) +
                                 (kNeighbours ? int(kReuseNeighbours) + (kLightTree ? 24 : 0) : 0);

/// The random numbers of candidate `index`: those of the first one, shifted. Each dimension has its own shift, so that
/// all candidates of a point form one lattice (the plastic number's, Roberts 2018). Each alone is as random as the
/// first, and the estimate needs no more.
LightNumbers shifted(LightNumbers n, int index) {
  n.choice += uint(index) * (0xffffffffu / kLightCandidates);
  n.bits += uint(index) * uvec2(0xc13fa9a9u, 0x91e10da5u);
  return n;
}

/// Estimates the light that a sample brings to a surface of this normal, which may be a rounded one (unpackNormal). The
/// estimate is never zero where the BSDF is not. through: the surface also takes light from behind.
float candidateWeight(LightSample s, vec3 normal, bool through) {
  float cosine = dot(s.direction, normal);
  if (through) cosine = abs(cosine);
  // A shading normal may see more of a light than the surface does.
  return cosine > float(-0.01) ? luminance(s.irradiance) * (max(cosine, 0.0f) + float(0.1)) : 0.0f;
}

/// Rescales a number in [0, 1) after it has chosen between a part of this share and the rest, so that it can choose
/// again.
float numberLeft(float number, float share) {
  float left = number < share ? number / share : (number - share) / (1.0f - share);
  return min(left, float(0.99999994));
}

/// One of the candidates of a surface, chosen by their target.
struct Candidate {
  LightChoice light;
  LightSample lit;  // the same
  float own;        // target of the chosen candidate; 0: no candidate brings light
  float sum;        // sum of all targets
};

/// normal: of the surface, packedNormal as lightFrom takes it. Uses four dimensions from `dimension` on.
Candidate chooseCandidate(vec3 point, vec3 normal, bool through, uint packedNormal, Sampler sampler, uint dimension) {
  LightNumbers first = lightNumbers(sampler, dimension);
  float left = drawFloat(sampler, dimension + 3u);
  Candidate c;
  c.light = makeChoice(kFromEnvironment, 0.0f, uvec2(0u), 0.0f, 0.0f);
  c.lit = noLight();
  c.own = 0.0f;
  c.sum = 0.0f;
  for (int i = 0; i < int(kLightCandidates); ++i) {
    LightChoice light = chooseLight(shifted(first, i), point, packedNormal);
    if (kStoresReservoirs) light.bits &= uvec2(~(kReservoirUnit - 1u));
    LightSample s = lightOfChoice(light, point);
    float weight = candidateWeight(s, normal, through);
    if (!(weight > 0.0f)) continue;
    c.sum += weight;
    float share = weight / c.sum;
    if (left < share) {
      c.light = light;
      c.lit = s;
      c.own = weight;
    }
    left = numberLeft(left, share);
  }
  return c;
}

/// The light sample of the chosen candidate, weighted by the mean target of all over its own.
LightSample lightOfCandidates(vec3 point, vec3 normal, bool through, uint packedNormal, Sampler sampler,
                              uint dimension) {
  Candidate c = chooseCandidate(point, normal, through, packedNormal, sampler, dimension);
  if (c.own > 0.0f) c.lit.irradiance *= c.sum / (float(kLightCandidates) * c.own);
  return c.lit;
}
