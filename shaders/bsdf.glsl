// SPDX-License-Identifier: MIT
// The glTF 2.0 material (appendix B, KHR_materials_specular, _transmission, _volume) as one BSDF: metal, dielectric
// over a diffuse base, and glass, mixed by metallic and transmission; and what extensions change of these: facets, a
// film on them, diffuse light through the surface. layers.glsl adds more. z is the shading normal, wo.z > 0.

struct Bsdf {
  vec3 baseColor;
  vec3 dielectricF0;
  float dielectricF90;
  float metal;     // weight of the metal
  float opaque;    // weight of the dielectric over the diffuse base
  float glass;     // weight of the transmissive dielectric
  float alpha;     // GGX width, roughness squared
  bool mirrorLike; // so smooth that its specular lobes are delta lobes
  bool solid;      // glass bounds a volume, else thin-walled
  float glassLost;  // share of the light on rough glass that facets lose and scatteredGlass() returns
  float eta;       // index behind the surface over the index before it
  vec3 faceNormal;    // normal of the flat triangle
  vec3 vertexNormal;  // interpolated, before any map (both kVertexNormals)
  float stretch;      // stretch of the facets along x (kAnisotropy); see ggx.glsl
  float film, filmIndex, filmThickness;  // weight, index and thickness (nm) of the thin film (kIridescence)
  float diffuseThrough;  // share of the diffuse light that is transmitted; then its colour (kDiffuseTransmission)
  vec3 throughColor;
  vec3 diffuseColor;  // colour of reflected diffuse light (kThinScattering); without it, baseColor
  vec3 sheenColor;    // kSheen; see layers.glsl
  float sheenAlpha;
  float coat, coatAlpha;  // weight, GGX width and normal of the clearcoat (kClearcoat)
  vec3 coatNormal;
  vec3 between;  // colour of light scattered again between the facets, over pi (1 - average albedo); see compensate
  bool sharesGlass;  // glass draws both its delta lobes often (kCaustics)
};

/// A direction drawn from a Bsdf. weight = f |cos| / pdf; pdf 0 for a delta lobe; weight 0 ends the path.
struct BsdfSample {
  vec3 wi;
  vec3 weight;
  float pdf;
  bool transmitted;
};

/// f |cos| and the pdf with which sampleBsdf draws the direction, delta lobes left out.
struct BsdfValue {
  vec3 value;
  float pdf;
};

vec3 diffuseColor(Bsdf b) { return kThinScattering ? b.diffuseColor : b.baseColor; }

/// Below this width a lobe is taken as a delta lobe: it is narrower than 0.001 radians.
const float kMirrorAlpha = float(0.001);

/// Between indices that are closer than this a rough boundary bends light by less than kMirrorAlpha, and half vectors
/// lose their digits.
const float kEqualIndices = float(0.001);

/// Returns true if glass has a delta lobe each way. A thin wall spreads light by its roughness alone.
bool isSmoothGlass(Bsdf b) { return b.mirrorLike || (b.solid && abs(b.eta - 1.0f) < kEqualIndices); }

/// A film of no thickness is none.
bool hasFilm(Bsdf b) { return kIridescence && b.film > 0.0f && b.filmThickness > 0.0f; }

/// Reflectance of facets that are seen at `cosine`, under the film if there is one.
vec3 microfacetFresnel(Bsdf b, vec3 f0, float f90, float cosine) {
  vec3 bare = fresnelSchlick(f0, f90, cosine);
  if (!hasFilm(b)) return bare;
  return mix(bare, filmReflectance(f0, b.filmIndex, b.filmThickness, cosine), b.film);
}

vec3 opaqueFresnel(Bsdf b, float cosine) {
  if (!kSpecular) return vec3(0.0f);
  vec3 result = vec3(0.0f);
  if (kMetals) result = b.metal * microfacetFresnel(b, b.baseColor, 1.0f, cosine);
  return result + b.opaque * microfacetFresnel(b, b.dielectricF0, b.dielectricF90, cosine);
}

/// The share of light that the dielectric layer lets through to the diffuse base.
float throughLayer(Bsdf b, float cosine) {
  if (!kSpecular) return 1.0f;
  return 1.0f - maxComponent(microfacetFresnel(b, b.dielectricF0, b.dielectricF90, cosine));
}

/// Reflectance of one interface of the glass whose exact reflectance is `bare`, as KHR_materials_specular scales it: f0
/// and f90 are those of the dielectric layer, and between them it grows as the exact one does. Light that cannot leave
/// stays.
vec3 scaledGlass(Bsdf b, float bare) {
  float root = (b.eta - 1.0f) / (b.eta + 1.0f);
  float f0 = root * root;
  if (bare >= 1.0f || f0 >= 1.0f) return vec3(bare);
  return mix(b.dielectricF0, vec3(b.dielectricF90), max(0.0f, bare - f0) / (1.0f - f0));
}

/// Reflectance of one interface of the glass under its film, on whichever side it is. What the film lies on is that of
/// the dielectric layer where KHR_materials_specular scales it.
vec3 filmedGlass(Bsdf b, float cosine, float eta, vec3 bare) {
  float squared = refractedSquared(cosine, eta);
  if (squared <= 0.0f) return bare;
  float outside = eta >= 1.0f ? cosine : sqrt(squared) / eta;
  float root = (eta - 1.0f) / (eta + 1.0f);
  vec3 f0 = kGlassSpecular ? b.dielectricF0 : vec3(root * root);
  return mix(bare, filmReflectance(f0, b.filmIndex, b.filmThickness, outside), b.film);
}

/// Reflectance of the glass at a facet seen at `cosine`; what it transmits is 1 less the largest channel
/// (KHR_materials_iridescence, rgb_mix).
vec3 glassReflectance(Bsdf b, float cosine) {
  float eta = b.solid ? b.eta : max(b.eta, 1.0f / b.eta);
  float single = kSchlick ? schlickDielectric(cosine, eta) : fresnelDielectric(cosine, eta);
  if (!kGlassSpecular && !kIridescence) return vec3(b.solid ? single : thinReflectance(single));
  vec3 r = vec3(single);
  if (kGlassSpecular) r = scaledGlass(b, single);
  if (hasFilm(b)) r = filmedGlass(b, cosine, eta, r);
  return b.solid ? r : vec3(thinReflectance(r.x), thinReflectance(r.y), thinReflectance(r.z));
}

/// The largest channel of glassReflectance(): the probability of a reflection.
float glassFresnel(Bsdf b, float cosine) {
  return maxComponent(glassReflectance(b, cosine));
}

/// The colour of what is reflected, its largest channel 1.
vec3 glassTint(Bsdf b, float cosine) {
  if (!kGlassSpecular && !kIridescence) return vec3(1.0f);
  vec3 r = glassReflectance(b, cosine);
  return r / max(maxComponent(r), float(1e-12));
}

/// The colour of what facets of mean reflectance `fresnel` and such a loss send out after more than one scattering.
vec3 manyScatterings(vec3 fresnel, float averageLoss) {
  float albedo = 1.0f - averageLoss;
  return fresnel * fresnel * albedo / (vec3(1.0f) - fresnel * averageLoss);
}

/// 1 - albedo of facets that reflect all: that of isotropic facets of the mean width, seen at the angle at which these
/// mask as much (Heitz 2014, section 5.3: masking is that of a stretched direction). Within 0.04.
float microfacetLoss(vec3 v, float alpha, float stretch) {
  if (!kAnisotropy) return ggxLoss(v.z, alpha);
  float mean = microfacetMean(stretch);
  vec3 along = alongMicrofacets(v, stretch) / mean;
  float cosine = v.z / sqrt(along.x * along.x + along.y * along.y + v.z * v.z);
  return ggxLoss(cosine, alpha * mean);
}

/// Fills in what single scattering loses (Kulla and Conty, Revisiting Physically Based Shading at Imageworks, 2017):
/// the lobe between (1 - E(o)) (1 - E(i)) cos(i).
Bsdf compensate(Bsdf b) {
  b.between = vec3(0.0f);
  if (!kCompensation || b.mirrorLike) return b;
  float averageLoss = ggxAverageLoss(b.alpha * microfacetMean(b.stretch));
  if (averageLoss <= 0.0f) return b;
  vec3 color = b.opaque * manyScatterings(averageFresnel(b.dielectricF0, b.dielectricF90), averageLoss);
  if (kMetals) color = color + b.metal * manyScatterings(averageFresnel(b.baseColor, 1.0f), averageLoss);
  b.between = color * (kInversePi / averageLoss);
  if (kAnisotropy) b.between = b.between * microfacetsGiveBack(b.stretch);
  return b;
}

/// The share of the samples of diffuse lobes that goes through the surface.
float throughChance(Bsdf b, float reflected, float through) {
  if (!kDiffuseTransmission || b.diffuseThrough <= 0.0f) return 0.0f;
  return reflected > 0.0f ? through / (reflected + through) : 1.0f;
}

/// Chances of drawing from glass (x), the opaque specular lobe (y), the diffuse lobe (z) and what goes through
/// diffusely (w); they add up to 1.
vec4 lobeChances(Bsdf b, float cosine) {
  float reflected = maxComponent(diffuseColor(b));
  float through = 0.0f;
  if (kDiffuseTransmission) {
    through = b.diffuseThrough * maxComponent(b.throughColor);
    reflected *= 1.0f - b.diffuseThrough;
  }
  if (!kSpecular) {
    float below = throughChance(b, reflected, through);
    return vec4(b.glass, 0.0f, (1.0f - b.glass) * (1.0f - below), (1.0f - b.glass) * below);
  }
  float specular = maxComponent(opaqueFresnel(b, cosine));
  // A layer that reflects all at this angle lets light through at those of other facets.
  float layer = b.opaque * max(throughLayer(b, cosine), float(0.001));
  float diffuse = layer * reflected;
  if (kCompensation) {
    diffuse = diffuse + maxComponent(b.between) * kPi * ggxLoss(cosine, b.alpha * microfacetMean(b.stretch));
  }
  float below = 0.0f;
  if (kDiffuseTransmission) {
    through *= layer;
    below = throughChance(b, diffuse, through);
    diffuse = diffuse + through;
  }
  float sum = specular + diffuse;
  float share = sum > 0.0f ? specular / sum : 1.0f;
  // A black surface seen straight on reflects nothing there, but next to it.
  bool glossy = specular > 0.0f || (kMetals && b.metal > 0.0f) || b.opaque * b.dielectricF90 > 0.0f;
  share = diffuse > 0.0f && glossy ? clamp(share, 0.125f, 0.875f) : share;
  float rest = (1.0f - b.glass) * (1.0f - share);
  return vec4(b.glass, (1.0f - b.glass) * share, rest * (1.0f - below), rest * below);
}

/// The share of the light that facets of the glass lose that comes back on the side of `wo`.
float scatteredBack(Bsdf b) {
  float eta = b.solid ? b.eta : max(b.eta, 1.0f / b.eta);
  float single = clamp(averageDielectric(eta), 0.0f, 1.0f);
  return b.solid ? single : thinReflectance(single);
}

/// Light that is scattered more than once between the facets of rough glass: as diffuse light, back and through as much
/// as a boundary reflects and transmits on average.
BsdfValue scatteredGlass(Bsdf b, vec3 wo, vec3 wi) {
  bool transmitted = wi.z < 0.0f;
  float back = scatteredBack(b);
  vec3 tint = transmitted ? b.baseColor : glassTint(b, wo.z);
  BsdfValue r;
  r.pdf = b.glassLost * (transmitted ? 1.0f - back : back) * abs(wi.z) * kInversePi;
  r.value = tint * (transmitted && b.solid ? r.pdf / (b.eta * b.eta) : r.pdf);
  return r;
}

/// Value and pdf of the facets of rough glass in one direction.
BsdfValue evaluateMicrofacets(Bsdf b, vec3 wo, vec3 wi) {
  BsdfValue none;
  none.value = vec3(0.0f);
  none.pdf = 0.0f;
  bool transmitted = wi.z < 0.0f;
  // A thin wall transmits the mirror image of what it reflects.
  bool bends = transmitted && b.solid;
  vec3 image = transmitted && !b.solid ? vec3(wi.x, wi.y, -wi.z) : wi;
  vec3 h = bends ? wo + b.eta * wi : wo + image;
  float squared = dot(h, h);
  if (squared <= 0.0f) return none;
  h = h / sqrt(squared);
  h = h.z < 0.0f ? -h : h;
  float oh = dot(wo, h);
  float ih = dot(image, h);
  float denominator = oh + b.eta * ih;
  if (oh <= 0.0f || (bends ? ih >= 0.0f || denominator == 0.0f : ih <= 0.0f)) return none;
  float fresnel = glassFresnel(b, oh);
  float pdf = microfacetPdf(wo, h, b.alpha, b.stretch);
  // The masking ratio turns the pdf of the visible normals into the value (both have D G1(o) / o.z).
  vec3 mirrored = vec3(image.x, image.y, abs(image.z));
  float ratio = microfacetShadowing(wo, mirrored, b.alpha, b.stretch);
  BsdfValue r;
  float jacobian = 1.0f / (4.0f * oh);
  vec3 tint = glassTint(b, oh);
  float share = fresnel;
  if (transmitted) {
    tint = b.baseColor;
    share = 1.0f - fresnel;
    if (bends) {
      // Walter et al., Microfacet Models for Refraction through Rough Surfaces, 2007, equations 17 and 21, times 1 /
      // eta^2 since radiance is compressed by the denser side.
      jacobian = b.eta * b.eta * abs(ih) / (denominator * denominator);
      tint = tint / (b.eta * b.eta);
    }
  }
  r.pdf = share * pdf * jacobian;
  r.value = tint * (r.pdf * ratio);
  // Masked samples are drawn elsewhere then (drawBase).
  if (b.glassLost > 0.0f) r.pdf *= ratio;
  return r;
}

/// Value and pdf of rough glass, multiple scattering included.
BsdfValue evaluateGlass(Bsdf b, vec3 wo, vec3 wi) {
  BsdfValue r = evaluateMicrofacets(b, wo, wi);
  if (b.glassLost <= 0.0f) return r;
  BsdfValue again = scatteredGlass(b, wo, wi);
  r.value = r.value + again.value;
  r.pdf += again.pdf;
  return r;
}

/// Diffuse light through the surface, as much as the reflection's mirror image would let into the base.
BsdfValue evaluateThrough(Bsdf b, vec3 wo, vec3 wi, float chance) {
  vec3 h = normalize(wo + vec3(wi.x, wi.y, -wi.z));
  BsdfValue r;
  float lit = b.opaque * b.diffuseThrough * throughLayer(b, max(0.0f, dot(wo, h))) * kInversePi * -wi.z;
  // Radiance is compressed by the denser side.
  r.value = (b.solid ? lit / (b.eta * b.eta) : lit) * b.throughColor;
  r.pdf = chance * -wi.z * kInversePi;
  return r;
}

/// Diffuse reflection of the base, times the cosine, for `wi` above the surface; oh: cosine between `wo` and
/// the half vector.
vec3 diffuseValue(Bsdf b, vec3 wi, float oh) {
  float lit = b.opaque * throughLayer(b, oh) * kInversePi * wi.z;
  if (kDiffuseTransmission) lit *= 1.0f - b.diffuseThrough;
  if (kVertexNormals) lit *= terminatorFade(b.faceNormal, b.vertexNormal, wi);
  return lit * diffuseColor(b);
}

/// Value and pdf of everything under sheen and clearcoat.
BsdfValue evaluateBase(Bsdf b, vec3 wo, vec3 wi) {
  BsdfValue r;
  r.value = vec3(0.0f);
  r.pdf = 0.0f;
  vec4 chances = lobeChances(b, wo.z);
  if (kDiffuseTransmission && wi.z < 0.0f) r = evaluateThrough(b, wo, wi, chances.w);
  if (wi.z > 0.0f) {
    vec3 h = normalize(wo + wi);
    float oh = max(0.0f, dot(wo, h));
    r.value = diffuseValue(b, wi, oh);
    r.pdf = chances.z * wi.z * kInversePi;
    if (kSpecular && !b.mirrorLike) {
      float pdf = microfacetPdf(wo, h, b.alpha, b.stretch) / max(4.0f * oh, float(1e-12));
      float ratio = microfacetShadowing(wo, wi, b.alpha, b.stretch);
      r.value = r.value + (pdf * ratio) * opaqueFresnel(b, oh);
      if (kCompensation) {
        float lost = microfacetLoss(wo, b.alpha, b.stretch) * microfacetLoss(wi, b.alpha, b.stretch);
        r.value = r.value + (lost * wi.z) * b.between;
      }
      r.pdf = r.pdf + chances.y * pdf;
    }
  }
  if (kRoughGlass && !isSmoothGlass(b)) {
    BsdfValue g = evaluateGlass(b, wo, wi);
    r.value = r.value + b.glass * g.value;
    r.pdf = r.pdf + chances.x * g.pdf;
  }
  return r;
}

/// Draws a delta lobe of smooth glass: reflected with the chance of its reflectance or a larger one, else transmitted.
BsdfSample sampleSmoothGlass(Bsdf b, vec3 wo, float choice) {
  BsdfSample s;
  float fresnel = glassFresnel(b, wo.z);
  float chance = b.sharesGlass ? sharedChance(fresnel) : fresnel;
  s.transmitted = choice >= chance;
  s.pdf = 0.0f;
  s.weight = glassTint(b, wo.z);
  s.wi = vec3(-wo.x, -wo.y, wo.z);
  if (s.transmitted) {
    s.weight = b.solid ? b.baseColor / (b.eta * b.eta) : b.baseColor;
    s.wi = b.solid ? refractThrough(wo, vec3(0.0f, 0.0f, 1.0f), b.eta) : -wo;
  }
  if (b.sharesGlass) s.weight *= sharedWeight(fresnel, chance, s.transmitted);
  return s;
}

/// The pdf of a sample whose direction is drawn, but not weighed yet.
const float kUnweighed = float(-1.0);

/// Draws from scatteredGlass().
BsdfSample drawScattered(Bsdf b, float u, float v) {
  float back = scatteredBack(b);
  BsdfSample s;
  s.transmitted = u >= back;
  u = s.transmitted ? (u - back) / max(1.0f - back, float(1e-12)) : u / max(back, float(1e-12));
  s.wi = sampleCosineHemisphere(clamp(u, 0.0f, float(0.99999994)), v);
  s.wi.z = (s.transmitted ? -1.0f : 1.0f) * max(s.wi.z, float(1e-6));
  s.weight = vec3(0.0f);
  s.pdf = kUnweighed;
  return s;
}

/// Draws from what lies under sheen and clearcoat: a direction to be weighed, a delta lobe with its weight, or a lost
/// one of weight 0.
BsdfSample drawBase(Bsdf b, vec3 wo, float choice, float u, float v) {
  BsdfSample s;
  s.weight = vec3(0.0f);
  s.pdf = 0.0f;
  s.transmitted = false;
  s.wi = vec3(0.0f, 0.0f, 1.0f);
  vec4 chances = lobeChances(b, wo.z);
  bool glass = kTransmission && u < chances.x;
  bool specular = kSpecular && !glass && u < chances.x + chances.y;
  float first = glass ? 0.0f : specular ? chances.x : chances.x + chances.y;
  float width = glass ? chances.x : specular ? chances.y : chances.z + chances.w;
  if (kSpecular || kTransmission) u = clamp((u - first) / max(width, float(1e-12)), 0.0f, float(0.99999994));
  if (glass && (!kRoughGlass || isSmoothGlass(b))) return sampleSmoothGlass(b, wo, choice);
  if (specular && b.mirrorLike) {
    s.wi = vec3(-wo.x, -wo.y, wo.z);
    s.weight = opaqueFresnel(b, wo.z) / chances.y;
    return s;
  }
  s.wi = sampleCosineHemisphere(u, v);
  if (kDiffuseTransmission && !specular && !glass && choice * (chances.z + chances.w) < chances.w) {
    s.wi.z = -s.wi.z;
    s.transmitted = true;
  }
  const float lowBits = float(4096.0);  // times this, a uniform number's fraction is another uniform number
  bool lost = false;
  if (specular || glass) {
    vec3 h = sampleMicrofacet(wo, b.alpha, b.stretch, u, v);
    float oh = dot(wo, h);
    s.wi = mirrorDirection(wo, h);
    if (glass && choice >= glassFresnel(b, oh)) {
      s.wi = b.solid ? refractThrough(wo, h, b.eta) : vec3(s.wi.x, s.wi.y, -s.wi.z);
      s.transmitted = true;
    }
    // Light that a facet sends to the wrong side is lost (single scattering).
    lost = s.transmitted == (s.wi.z > 0.0f);
  }
  // Compensated glass draws it again, and what its facets mask.
  if (kCompensation && glass && b.glassLost > 0.0f) {
    vec3 mirrored = vec3(s.wi.x, s.wi.y, abs(s.wi.z));
    lost = lost || fract(choice * lowBits) >= microfacetShadowing(wo, mirrored, b.alpha, b.stretch);
    if (lost) s = drawScattered(b, fract(u * lowBits), fract(v * lowBits));
    lost = false;
  }
  if (!lost) s.pdf = kUnweighed;
  return s;
}
