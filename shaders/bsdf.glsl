// SPDX-License-Identifier: MIT
// The glTF 2.0 material (appendix B, KHR_materials_specular, _transmission, _volume) as one BSDF: metal, dielectric over a
// diffuse base, and glass, mixed by metallic and transmission. Frame: z is the shading normal, outgoing.z > 0.

struct Bsdf {
  vec3 baseColor;
  vec3 dielectricF0;
  float dielectricF90;
  float metal;     // weight of the metal
  float opaque;    // weight of the dielectric over the diffuse base
  float glass;     // weight of the transmissive dielectric
  float alpha;     // GGX width, roughness squared
  bool mirrorLike; // so smooth that its specular lobes are single directions
  bool solid;      // glass bounds a volume, else thin-walled
  float eta;       // index behind the surface over the index before it
  vec3 faceNormal;    // of the flat triangle
  vec3 vertexNormal;  // interpolated, before any map (both kVertexNormals)
  vec3 between;    // colour of light scattered more than once between the facets, over pi (1 - average albedo); see compensate
};

/// A direction drawn from a Bsdf. weight = f |cos| / density; density 0 for a single direction; weight 0 ends the path.
struct BsdfSample {
  vec3 incoming;
  vec3 weight;
  float density;
  bool transmitted;
};

/// f |cos| and the density with which sampleBsdf draws the direction, single directions left out.
struct BsdfValue {
  vec3 value;
  float density;
};

/// Below this width a lobe is taken as a single direction: it is narrower than 0.001 radians.
const float kMirrorAlpha = float(0.001);

/// Between indices that are closer than this a rough boundary bends light by less than kMirrorAlpha, and half vectors lose their digits.
const float kEqualIndices = float(0.001);

/// Whether glass is a single direction each way. A thin wall spreads light by its roughness alone.
bool isSmoothGlass(Bsdf b) { return b.mirrorLike || (b.solid && abs(b.eta - 1.0f) < kEqualIndices); }

vec3 opaqueFresnel(Bsdf b, float cosine) {
  if (!kSpecular) return vec3(0.0f);
  vec3 result = vec3(0.0f);
  if (kMetals) result = b.metal * fresnelSchlick(b.baseColor, 1.0f, cosine);
  return result + b.opaque * fresnelSchlick(b.dielectricF0, b.dielectricF90, cosine);
}

/// The share of light that the dielectric layer lets through to the diffuse base.
float throughLayer(Bsdf b, float cosine) {
  if (!kSpecular) return 1.0f;
  return 1.0f - maxComponent(fresnelSchlick(b.dielectricF0, b.dielectricF90, cosine));
}

/// Reflectance of the glass at a facet seen at `cosine`.
float glassFresnel(Bsdf b, float cosine) {
  float eta = b.solid ? b.eta : max(b.eta, 1.0f / b.eta);
  float single = kSchlick ? schlickDielectric(cosine, eta) : fresnelDielectric(cosine, eta);
  return b.solid ? single : thinReflectance(single);
}

/// Mean of Schlick's reflectance over cosine-weighted directions.
vec3 averageFresnel(vec3 f0, float f90) { return f0 + (vec3(f90) - f0) / float(21.0); }

/// The colour of what facets with mean reflectance `fresnel` send out after more than one scattering, given their average loss.
vec3 manyScatterings(vec3 fresnel, float averageLoss) {
  float albedo = 1.0f - averageLoss;
  return fresnel * fresnel * albedo / (vec3(1.0f) - fresnel * averageLoss);
}

/// Fills in what single scattering loses (Kulla and Conty, Revisiting Physically Based Shading at Imageworks, 2017): the lobe
/// between (1 - E(o)) (1 - E(i)) cos(i).
Bsdf compensate(Bsdf b) {
  b.between = vec3(0.0f);
  if (!kCompensation || b.mirrorLike) return b;
  float averageLoss = ggxAverageLoss(b.alpha);
  if (averageLoss <= 0.0f) return b;
  vec3 color = b.opaque * manyScatterings(averageFresnel(b.dielectricF0, b.dielectricF90), averageLoss);
  if (kMetals) color = color + b.metal * manyScatterings(averageFresnel(b.baseColor, 1.0f), averageLoss);
  b.between = color * (kInversePi / averageLoss);
  return b;
}

/// Chances of drawing from glass (x), the opaque specular lobe (y) and the diffuse lobe (z); they add up to 1.
vec3 lobeChances(Bsdf b, float cosine) {
  float glass = kTransmission ? b.glass : 0.0f;
  if (!kSpecular) return vec3(glass, 0.0f, 1.0f - glass);
  float specular = maxComponent(opaqueFresnel(b, cosine));
  float diffuse = b.opaque * throughLayer(b, cosine) * maxComponent(b.baseColor);
  if (kCompensation) diffuse = diffuse + maxComponent(b.between) * kPi * ggxLoss(cosine, b.alpha);
  float sum = specular + diffuse;
  float share = sum > 0.0f ? specular / sum : 1.0f;
  share = diffuse > 0.0f && specular > 0.0f ? clamp(share, 0.125f, 0.875f) : share;
  return vec3(glass, (1.0f - glass) * share, (1.0f - glass) * (1.0f - share));
}

/// Value and density of the rough glass in one direction.
BsdfValue evaluateGlass(Bsdf b, vec3 outgoing, vec3 incoming) {
  BsdfValue none;
  none.value = vec3(0.0f);
  none.density = 0.0f;
  bool transmitted = incoming.z < 0.0f;
  // A thin wall transmits the mirror image of what it reflects.
  bool bends = transmitted && b.solid;
  vec3 image = transmitted && !b.solid ? vec3(incoming.x, incoming.y, -incoming.z) : incoming;
  vec3 h = bends ? outgoing + b.eta * incoming : outgoing + image;
  float squared = dot(h, h);
  if (squared <= 0.0f) return none;
  h = h / sqrt(squared);
  h = h.z < 0.0f ? -h : h;
  float oh = dot(outgoing, h);
  float ih = dot(image, h);
  if (oh <= 0.0f || (bends ? ih >= 0.0f : ih <= 0.0f)) return none;
  float fresnel = glassFresnel(b, oh);
  float density = visibleGgxDensity(outgoing, h, b.alpha);
  // The masking ratio turns the density of the visible normals into the value (both have D G1(o) / o.z).
  vec3 mirrored = vec3(image.x, image.y, abs(image.z));
  float ratio = ggxMaskingShadowing(outgoing, mirrored, b.alpha) / ggxMasking(outgoing, b.alpha);
  BsdfValue r;
  float jacobian = 1.0f / (4.0f * oh);
  vec3 tint = vec3(1.0f);
  float share = fresnel;
  if (transmitted) {
    tint = b.baseColor;
    share = 1.0f - fresnel;
    if (bends) {
      // Walter et al., Microfacet Models for Refraction through Rough Surfaces, 2007, equations 17 and 21, times 1 / eta^2 since
      // radiance is compressed by the denser side.
      float denominator = oh + b.eta * ih;
      if (denominator == 0.0f) return none;
      jacobian = b.eta * b.eta * abs(ih) / (denominator * denominator);
      tint = tint / (b.eta * b.eta);
    }
  }
  r.density = share * density * jacobian;
  r.value = tint * (r.density * ratio);
  return r;
}

BsdfValue evaluateBsdf(Bsdf b, vec3 outgoing, vec3 incoming) {
  BsdfValue r;
  r.value = vec3(0.0f);
  r.density = 0.0f;
  vec3 chances = lobeChances(b, outgoing.z);
  if (incoming.z > 0.0f) {
    vec3 h = normalize(outgoing + incoming);
    float oh = max(0.0f, dot(outgoing, h));
    float lit = b.opaque * throughLayer(b, oh) * kInversePi * incoming.z;
    if (kVertexNormals) lit *= terminatorFade(b.faceNormal, b.vertexNormal, incoming);
    r.value = lit * b.baseColor;
    r.density = chances.z * incoming.z * kInversePi;
    if (kSpecular && !b.mirrorLike) {
      float density = visibleGgxDensity(outgoing, h, b.alpha) / max(4.0f * oh, float(1e-12));
      float ratio = ggxMaskingShadowing(outgoing, incoming, b.alpha) / ggxMasking(outgoing, b.alpha);
      r.value = r.value + (density * ratio) * opaqueFresnel(b, oh);
      if (kCompensation) {
        float lost = ggxLoss(outgoing.z, b.alpha) * ggxLoss(incoming.z, b.alpha);
        r.value = r.value + (lost * incoming.z) * b.between;
      }
      r.density = r.density + chances.y * density;
    }
  }
  if (kTransmission && !isSmoothGlass(b)) {
    BsdfValue g = evaluateGlass(b, outgoing, incoming);
    r.value = r.value + b.glass * g.value;
    r.density = r.density + chances.x * g.density;
  }
  return r;
}

/// Draws a single direction of smooth glass: reflected with the chance of its reflectance, else transmitted.
BsdfSample sampleSmoothGlass(Bsdf b, vec3 outgoing, float choice) {
  BsdfSample s;
  float fresnel = glassFresnel(b, outgoing.z);
  s.transmitted = choice >= fresnel;
  s.density = 0.0f;
  s.weight = vec3(1.0f);
  s.incoming = vec3(-outgoing.x, -outgoing.y, outgoing.z);
  if (s.transmitted) {
    s.weight = b.solid ? b.baseColor / (b.eta * b.eta) : b.baseColor;
    s.incoming = b.solid ? refractThrough(outgoing, vec3(0.0f, 0.0f, 1.0f), b.eta) : -outgoing;
  }
  return s;
}

/// (u, v) picks the lobe and the direction, so that each lobe gets its part of points that are stratified together; choice decides between
/// reflection and refraction at glass. Each is uniform in [0, 1).
BsdfSample sampleBsdf(Bsdf b, vec3 outgoing, float choice, float u, float v) {
  BsdfSample s;
  s.weight = vec3(0.0f);
  s.density = 0.0f;
  s.transmitted = false;
  s.incoming = vec3(0.0f, 0.0f, 1.0f);
  vec3 chances = lobeChances(b, outgoing.z);
  bool glass = kTransmission && u < chances.x;
  bool specular = kSpecular && !glass && u < chances.x + chances.y;
  float first = glass ? 0.0f : specular ? chances.x : chances.x + chances.y;
  float width = glass ? chances.x : specular ? chances.y : chances.z;
  if (kSpecular || kTransmission) u = clamp((u - first) / max(width, float(1e-12)), 0.0f, float(0.99999994));
  if (glass && isSmoothGlass(b)) return sampleSmoothGlass(b, outgoing, choice);
  if (specular && b.mirrorLike) {
    s.incoming = vec3(-outgoing.x, -outgoing.y, outgoing.z);
    s.weight = opaqueFresnel(b, outgoing.z) / chances.y;
    return s;
  }
  s.incoming = sampleCosineHemisphere(u, v);
  if (specular || glass) {
    vec3 h = sampleVisibleGgx(outgoing, b.alpha, u, v);
    float oh = dot(outgoing, h);
    s.incoming = mirrorDirection(outgoing, h);
    if (glass && choice >= glassFresnel(b, oh)) {
      s.incoming = b.solid ? refractThrough(outgoing, h, b.eta) : vec3(s.incoming.x, s.incoming.y, -s.incoming.z);
      s.transmitted = true;
    }
    // Facets can send light to the wrong side of the surface; that share is lost (single scattering).
    if (s.transmitted == (s.incoming.z > 0.0f)) return s;
  }
  BsdfValue value = evaluateBsdf(b, outgoing, s.incoming);
  s.density = value.density;
  s.weight = value.density > 0.0f ? value.value / value.density : vec3(0.0f);
  return s;
}
