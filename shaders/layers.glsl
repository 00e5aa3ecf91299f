// SPDX-License-Identifier: MIT
// The whole surface: clearcoat (KHR_materials_clearcoat) over sheen (KHR_materials_sheen) over the base of bsdf.glsl. A
// clearcoat of weight w and reflectance F, at the angle of the viewer, is w F x its lobe + (1 - w F) x all below. Sheen
// s is s x its lobe + (1 - max(s) E) x the base, where E is the larger of the lobe's albedos in the two directions.
// Its lobe is that of velvet (Estevez and Kulla, Production Friendly Microfacet Sheen BRDF, 2017), in a frame whose z
// is the normal; its alpha is the square of the extension's sheenRoughness.

const float kCoatF0 = float(0.04);  // reflectance at normal incidence of the index 1.5

/// Share of the light that the clearcoat reflects towards `wo`.
float coatShare(Bsdf b, vec3 wo) {
  if (!kClearcoat || b.coat <= 0.0f) return 0.0f;
  return b.coat * fresnelSchlick(vec3(kCoatF0), 1.0f, max(0.0f, dot(wo, b.coatNormal))).x;
}

bool isSmoothCoat(Bsdf b) { return b.coatAlpha < kMirrorAlpha; }

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

/// Albedo of white sheen, seen at `cosine`, from the table that ends where those of energy begin.
float sheenAlbedo(float cosine, float alpha) {
  return kSheen ? energyTableAt(-int(kEnergyCells * kEnergyCells), cosine, alpha) : 0.0f;
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

/// The share of light that sheen lets pass between two directions to and from the base.
float underSheen(Bsdf b, vec3 wo, vec3 wi) {
  if (!kSheen) return 1.0f;
  float strongest = maxComponent(b.sheenColor);
  if (strongest <= 0.0f) return 1.0f;
  return 1.0f - strongest * max(sheenShare(wo.z, b.sheenAlpha), sheenShare(wi.z, b.sheenAlpha));
}

/// Chances of drawing from clearcoat (x), sheen (y) and the base (z); they add up to 1. No layer that is present is
/// drawn too rarely.
vec3 layerChances(Bsdf b, vec3 wo) {
  float coat = coatShare(b, wo);
  float strongest = kSheen ? maxComponent(b.sheenColor) : 0.0f;
  float sheen = strongest * sheenShare(wo.z, b.sheenAlpha);
  float reflected = maxComponent(diffuseColor(b));
  float diffuse = kDiffuseTransmission ? mix(reflected, maxComponent(b.throughColor), b.diffuseThrough) : reflected;
  float base = b.glass + b.opaque * diffuse + maxComponent(opaqueFresnel(b, wo.z));
  float below = sheen + (1.0f - sheen) * min(base, 1.0f);
  float coatChance = coat > 0.0f ? clamp(coat / (coat + (1.0f - coat) * below), 0.125f, 0.875f) : 0.0f;
  float sheenChance = strongest > 0.0f ? clamp(sheen / max(below, float(1e-6)), 0.125f, 0.875f) : 0.0f;
  return vec3(coatChance, (1.0f - coatChance) * sheenChance, (1.0f - coatChance) * (1.0f - sheenChance));
}

/// A direction in the frame of the clearcoat. Without normal maps its normal is that of the base.
vec3 toCoat(Frame3 around, vec3 v) { return kNormalMaps ? toFrame(around, v) : v; }

/// Value (without its share) and pdf of the rough clearcoat, about its own normal.
BsdfValue evaluateCoat(Bsdf b, vec3 wo, vec3 wi) {
  BsdfValue r;
  r.value = vec3(0.0f);
  r.pdf = 0.0f;
  Frame3 around = frameAround(b.coatNormal);
  vec3 o = toCoat(around, wo);
  vec3 i = toCoat(around, wi);
  if (o.z <= 0.0f || i.z <= 0.0f) return r;
  vec3 h = normalize(o + i);
  float pdf = visibleGgxPdf(o, h, b.coatAlpha) / max(4.0f * dot(o, h), float(1e-12));
  r.value = vec3(pdf * ggxMaskingShadowing(o, i, b.coatAlpha) / ggxMasking(o, b.coatAlpha));
  r.pdf = pdf;
  return r;
}

BsdfValue evaluateBsdf(Bsdf b, vec3 wo, vec3 wi) {
  countBsdfEvaluations(1u);
  BsdfValue r = evaluateBase(b, wo, wi);
  if (!kClearcoat && !kSheen) return r;
  vec3 chances = layerChances(b, wo);
  r.pdf *= chances.z;
  if (kSheen && chances.y > 0.0f) {
    r.value = r.value * underSheen(b, wo, wi);
    if (wi.z > 0.0f) {
      r.value = r.value + sheenValue(wo, wi, b.sheenAlpha) * b.sheenColor;
      r.pdf += chances.y * (0.5f * kInversePi);
    }
  }
  if (kClearcoat && chances.x > 0.0f) {
    float share = coatShare(b, wo);
    r.value = r.value * (1.0f - share);
    if (wi.z > 0.0f && !isSmoothCoat(b)) {
      BsdfValue lobe = evaluateCoat(b, wo, wi);
      r.value = r.value + share * lobe.value;
      r.pdf += chances.x * lobe.pdf;
    }
  }
  return r;
}

/// The diffuse part of evaluateBsdf(), reflected and transmitted, as seen under sheen and clearcoat.
vec3 diffuseUnderLayers(Bsdf b, vec3 wo, vec3 wi) {
  vec3 value = vec3(0.0f);
  if (kDiffuseTransmission && wi.z < 0.0f) value = evaluateThrough(b, wo, wi, 1.0f).value;
  if (wi.z > 0.0f) value = diffuseValue(b, wi, max(0.0f, dot(wo, normalize(wo + wi))));
  return value * ((1.0f - coatShare(b, wo)) * underSheen(b, wo, wi));
}

/// Weight of the light that a smooth thin surface, or a boundary between equal indices, lets straight through, as often
/// as sampleBsdf draws that direction.
vec3 straightThrough(Bsdf b, vec3 wo) {
  bool bends = b.solid && !(kMatchedGlass && abs(b.eta - 1.0f) < kEqualIndices);
  if (bends || !isSmoothGlass(b)) return vec3(0.0f);
  vec3 weight = (b.glass * (1.0f - glassFresnel(b, wo.z))) * b.baseColor;
  return weight * ((1.0f - coatShare(b, wo)) * underSheen(b, wo, -wo));
}

/// Draws from the clearcoat, as drawBase does from the base.
BsdfSample drawCoat(Bsdf b, vec3 wo, float chance, float u, float v) {
  BsdfSample s;
  s.transmitted = false;
  s.pdf = 0.0f;
  s.weight = vec3(0.0f);
  Frame3 around = frameAround(b.coatNormal);
  vec3 o = toCoat(around, wo);
  bool smoothCoat = isSmoothCoat(b);
  vec3 h = smoothCoat ? vec3(0.0f, 0.0f, 1.0f) : sampleVisibleGgx(o, b.coatAlpha, u, v);
  vec3 i = mirrorDirection(o, h);
  s.wi = kNormalMaps ? toWorld(around, i) : i;
  if (i.z <= 0.0f) return s;
  if (smoothCoat) {
    s.weight = vec3(coatShare(b, wo) / chance);
    return s;
  }
  // A direction below the base's horizon is lost, too.
  if (s.wi.z > 0.0f) s.pdf = kUnweighed;
  return s;
}

BsdfSample drawLayered(Bsdf b, vec3 wo, float choice, float u, float v) {
  vec3 chances = layerChances(b, wo);
  bool coat = u < chances.x;
  bool sheen = !coat && u < chances.x + chances.y;
  float first = coat ? 0.0f : sheen ? chances.x : chances.x + chances.y;
  float width = coat ? chances.x : sheen ? chances.y : chances.z;
  u = clamp((u - first) / max(width, float(1e-12)), 0.0f, float(0.99999994));
  if (kClearcoat && coat) return drawCoat(b, wo, chances.x, u, v);
  BsdfSample s;
  if (kSheen && sheen) {
    s.wi = sampleHemisphere(u, v);
    s.transmitted = false;
    s.weight = vec3(0.0f);
    s.pdf = s.wi.z > 0.0f ? kUnweighed : 0.0f;
    return s;
  }
  s = drawBase(b, wo, choice, u, v);
  // The direction is of a delta lobe and has its weight already.
  s.weight = s.weight * ((1.0f - coatShare(b, wo)) * underSheen(b, wo, s.wi) / chances.z);
  return s;
}

/// Draws a direction. One of a delta lobe has its weight and a pdf of 0; others wait for weighed(), except those that
/// are lost. (u, v) picks the lobe and the direction, so that each lobe gets its share of points that are stratified
/// together. choice decides between reflection and refraction at glass, and between both sides of diffuse light. Each
/// is uniform in [0, 1).
BsdfSample drawBsdf(Bsdf b, vec3 wo, float choice, float u, float v) {
  return kClearcoat || kSheen ? drawLayered(b, wo, choice, u, v) : drawBase(b, wo, choice, u, v);
}

/// A direction with the weight and the pdf that evaluateBsdf() finds for it.
BsdfSample weighed(BsdfSample s, BsdfValue value) {
  s.pdf = value.pdf;
  s.weight = value.pdf > 0.0f ? value.value / value.pdf : vec3(0.0f);
  return s;
}

/// Draws a direction and weighs it.
BsdfSample sampleBsdf(Bsdf b, vec3 wo, float choice, float u, float v) {
  BsdfSample s = drawBsdf(b, wo, choice, u, v);
  if (s.pdf < 0.0f) s = weighed(s, evaluateBsdf(b, wo, s.wi));
  return s;
}
