// SPDX-License-Identifier: MIT
// Spatial reuse keeps the light sample of a surface as a reservoir, and lets the surfaces of nearby pixels take it:
// ReSTIR (Bitterli et al., Spatiotemporal Reservoir Resampling for Real-Time Ray Tracing with Dynamic Direct Lighting,
// 2020) without reuse in time, unbiased by pairwise multiple importance sampling (Bitterli, Correlations and Reuse for
// Fast and Accurate Physically Based Light Transport, 2022).

/// A surface, as far as the weights of light samples depend on it.
struct LitSurface {
  vec3 point;
  uint normal;   // packNormal of its geometric normal, on the side of the camera
  bool through;  // takes light from behind, too
};

/// A light sample of a surface.
struct Reservoir {
  LitSurface surface;
  bool known;         // a camera ray has met a surface that is lit
  LightChoice light;  // its chance is of no use
  float weight;       // an estimate of 1 / the pdf of the choice; 0: no light reaches the surface
};

Reservoir makeReservoir(LitSurface on, uint packedNormal, Sampler sampler, uint dimension) {
  Candidate c = chooseCandidate(on.point, unpackNormal(on.normal), on.through, packedNormal, sampler, dimension);
  Reservoir r;
  r.surface = on;
  r.known = true;
  r.light = c.light;
  r.weight = c.own > 0.0f ? c.sum / (float(kLightCandidates) * c.own * c.light.chance) : 0.0f;
  return r;
}

/// A reservoir takes two texels; all zero means not known.
vec4 firstTexel(Reservoir r) { return vec4(r.surface.point, r.weight); }

vec4 secondTexel(Reservoir r) {
  float normal = float(r.surface.normal);
  bool environment = r.light.emitter == kFromEnvironment;
  vec2 place = environment ? vec2(r.light.bits / kReservoirUnit) : vec2(r.light.u, r.light.v);
  return vec4(r.surface.through ? -1.0f - normal : normal, float(r.light.emitter + 2), place.x, place.y);
}

Reservoir reservoirOf(vec4 first, vec4 second) {
  Reservoir r;
  r.surface.point = vec3(first);
  r.surface.through = second.x < 0.0f;
  r.surface.normal = uint(second.x < 0.0f ? -1.0f - second.x : second.x);
  r.known = second.y > 0.0f;
  r.light = makeChoice(int(second.y) - 2, 1.0f, uvec2(0u), second.z, second.w);
  if (r.light.emitter == kFromEnvironment) r.light.bits = uvec2(uint(second.z), uint(second.w)) * kReservoirUnit;
  r.weight = first.w;
  return r;
}

/// The target function of resampling: an estimate of the light that a sample brings to a surface, per unit of the
/// random numbers that draw the sample.
float targetOf(LightChoice light, LitSurface on) {
  light.chance = 1.0f;
  return candidateWeight(lightOfChoice(light, on.point), unpackNormal(on.normal), on.through);
}

/// The state of resampling: the light that is chosen of those so far.
struct Reuse {
  LightChoice light;
  float target;  // on the pixel's own surface
  float sum;     // sum of the weights so far
  float share;   // sum over the neighbours of the own sample's MIS weight against each
  float left;    // random number that chooses; rescaled after each choice
};

Reuse beginReuse(float left) {
  Reuse r;
  r.light = makeChoice(kFromEnvironment, 1.0f, uvec2(0u), 0.0f, 0.0f);
  r.target = 0.0f;
  r.sum = 0.0f;
  r.share = 0.0f;
  r.left = left;
  return r;
}

Reuse addWeight(Reuse r, LightChoice light, float target, float weight) {
  if (!(weight > 0.0f)) return r;
  r.sum += weight;
  float part = weight / r.sum;
  if (r.left < part) {
    r.light = light;
    r.target = target;
  }
  r.left = numberLeft(r.left, part);
  return r;
}

/// Adds the sample of a neighbour. ownTarget: the target of the own sample on its own surface. A reservoir that is not
/// known counts as one whose samples neither surface could use.
Reuse addNeighbour(Reuse r, Reservoir own, float ownTarget, Reservoir near) {
  const float count = float(kReuseNeighbours);
  float there = near.known && ownTarget > 0.0f ? targetOf(own.light, near.surface) : 0.0f;
  r.share += ownTarget > 0.0f ? ownTarget / (ownTarget + count * there) : 0.0f;
  if (!near.known || !(near.weight > 0.0f)) return r;
  float here = targetOf(near.light, own.surface);
  there = targetOf(near.light, near.surface);
  float share = count / (count + 1.0f) * there / (here + count * there);
  return addWeight(r, near.light, here, share * here * near.weight);
}

/// The light sample of the choice, once the own sample has been added as well; normal: as lightFrom takes it.
LightSample endReuse(Reuse r, Reservoir own, float ownTarget, vec3 point, uint normal) {
  const float count = float(kReuseNeighbours);
  r = addWeight(r, own.light, ownTarget, (1.0f + r.share) / (count + 1.0f) * ownTarget * own.weight);
  LightSample s = noLight();
  if (!(r.target > 0.0f)) return s;
  r.light.chance = 1.0f;
  s = lightOfChoice(r.light, point);
  s.irradiance *= r.sum / r.target;
  s.pdf *= chanceOfLight(r.light.emitter, point, normal);
  return s;
}
