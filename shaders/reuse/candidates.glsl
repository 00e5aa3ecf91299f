// SPDX-License-Identifier: MIT
// A light sample that is one of several candidates: resampled importance sampling (Talbot, Cline and Egbert,
// Importance Resampling for Global Illumination, 2005).

/// Loop iterations that a scattering takes more, at most, and steps of the megakernel's budget, which stand for three
/// each.
const int kCandidateIterations = kCandidates ? int(kLightCandidates) * (kLightTree ? 16 : 8) : 0;
const int kCandidateSteps = kCandidateIterations / 3;

/// The numbers of candidate `index`: those of the first one shifted, each dimension by its own part of the whole, so
/// that all candidates of a point are one lattice (the plastic number's, Roberts 2018). Each alone is as random as the
/// first, which is all that the estimate needs.
LightNumbers shifted(LightNumbers n, int index) {
  n.choice += uint(index) * (0xffffffffu / kLightCandidates);
  n.bits += uint(index) * uvec2(0xc13fa9a9u, 0x91e10da5u);
  return n;
}

/// What a light sample may bring to a surface of this normal: a guess that is never zero where the BSDF is not.
/// through: the surface takes light from behind, too.
float candidateWeight(LightSample s, vec3 normal, bool through) {
  float cosine = dot(s.direction, normal);
  if (through) cosine = abs(cosine);
  // A shading normal may see more of a light than the surface does.
  return cosine > 0.0f ? luminance(s.irradiance) * (cosine + 0.1f) : 0.0f;
}

/// One of the candidates, chosen by what they may bring, and weighted by the mean of these over its own; normal: of the
/// surface, packedNormal as lightFrom takes it. Uses four dimensions from `dimension` on.
LightSample lightOfCandidates(vec3 point, vec3 normal, bool through, uint packedNormal, Sampler numbers,
                              uint dimension) {
  LightNumbers first = lightNumbers(numbers, dimension);
  float left = drawFloat(numbers, dimension + 3u);
  LightSample chosen = noLight();
  float own = 0.0f;
  float sum = 0.0f;
  for (int i = 0; i < int(kLightCandidates); ++i) {
    LightSample s = lightFrom(shifted(first, i), point, packedNormal);
    float weight = candidateWeight(s, normal, through);
    if (!(weight > 0.0f)) continue;
    sum += weight;
    // The number that is left chooses again, within the part that its last choice left of it.
    float share = weight / sum;
    bool taken = left < share;
    left = taken ? left / share : (left - share) / (1.0f - share);
    left = min(left, float(0.99999994));
    if (taken) {
      chosen = s;
      own = weight;
    }
  }
  if (own > 0.0f) chosen.irradiance *= sum / (float(kLightCandidates) * own);
  return chosen;
}
