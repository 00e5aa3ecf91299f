// SPDX-License-Identifier: MIT
// The parts of a Bsdf that extensions add, read from the rows behind the texture slots (layout.glsl).

/// Direction in which facets are stretched, in tangent and bitangent (x, y), and strength of the anisotropy
/// (KHR_materials_anisotropy).
vec3 anisotropyAt(uint material, vec4 texcoords) {
  vec3 row = materialFloats(material, kMaterialAnisotropy).xyz;
  vec2 direction = vec2(1.0, 0.0);
  uvec4 slot = slotAnisotropy(material);
  if ((slot.z & kTexturePresent) != 0u) {
    vec3 texel = sampleTexture(slot, texcoords, false).rgb;
    vec2 d = texel.xy * 2.0 - 1.0;
    float squared = dot(d, d);
    direction = squared > 1e-8 ? d * inversesqrt(squared) : direction;
    row.x *= texel.b;
  }
  return vec3(row.y * direction.x - row.z * direction.y, row.z * direction.x + row.y * direction.y, row.x);
}

/// alpha is that of the perpendicular direction, alpha along = mix(alpha, 1, strength^2); alpha of the Bsdf is the root
/// of their product.
Bsdf stretchMicrofacets(Bsdf b, float strength) {
  b.stretch = 1.0;
  if (strength <= 0.0) return b;
  float across = max(b.alpha, kMirrorAlpha);
  float along = mix(across, 1.0, strength * strength);
  b.alpha = sqrt(along * across);
  b.stretch = sqrt(along / across);
  b.mirrorLike = false;
  return b;
}

Bsdf addFilm(Bsdf b, uint material, vec4 texcoords) {
  vec4 row = materialFloats(material, kMaterialIridescence);
  b.film = row.x;
  b.filmIndex = row.y;
  b.film *= texelIridescence(material, texcoords).r;
  b.filmThickness = mix(row.z, row.w, texelIridescenceThickness(material, texcoords).g);
  return b;
}

Bsdf addDiffuseTransmission(Bsdf b, uint material, vec4 texcoords) {
  vec4 row = materialFloats(material, kMaterialDiffuseTransmission);
  b.diffuseThrough = row.w;
  b.throughColor = row.rgb;
  b.diffuseThrough *= texelDiffuseTransmission(material, texcoords).a;
  b.throughColor *= texelDiffuseTransmissionColour(material, texcoords).rgb;
  return b;
}

/// The part of the light that a thin wall transmits and scatters on the way (KHR_materials_scatter): as diffuse light
/// of the multiscatter colour, forward and back by the anisotropy. It joins the diffuse base, which keeps its part.
Bsdf addThinScattering(Bsdf b, uint material, vec4 texcoords) {
  b.diffuseColor = b.baseColor;
  float strength = materialFloats(material, kMaterialScatterStrength).x;
  if (b.solid || strength <= 0.0) return b;
  vec4 scatter = materialFloats(material, kMaterialScatter);
  strength *= texelScattering(material, texcoords).a;
  scatter.rgb *= texelScatteringColour(material, texcoords).rgb;
  float scattered = b.glass * strength;
  float through = scattered * (0.5 + 0.5 * scatter.w);
  vec3 back = b.opaque * b.baseColor + (scattered - through) * scatter.rgb;
  b.glass -= scattered;
  b.opaque += scattered;
  b.diffuseColor = back / max(b.opaque - through, 1e-12);
  b.diffuseThrough = b.opaque > 0.0 ? through / b.opaque : 0.0;
  b.throughColor = scatter.rgb;
  return b;
}

Bsdf addSheen(Bsdf b, uint material, vec4 texcoords) {
  vec4 row = materialFloats(material, kMaterialSheen);
  row.rgb *= texelSheen(material, texcoords).rgb;
  row.a *= texelSheenRoughness(material, texcoords).a;
  float roughness = max(row.a, 0.05);  // below, the lobe is narrower than its table
  b.sheenColor = row.rgb;
  b.sheenAlpha = roughness * roughness;
  return b;
}

/// Weight and roughness of the clearcoat.
vec2 clearcoatAt(uint material, vec4 texcoords) {
  vec2 coat = materialFloats(material, kMaterialClearcoat).xy;
  coat.x *= texelClearcoat(material, texcoords).r;
  coat.y *= texelClearcoatRoughness(material, texcoords).g;
  return coat;
}

/// The share of the emitted light that leaves through the clearcoat, seen at `cosine` to the triangle.
float emissionUnderCoat(uint material, vec4 texcoords, float cosine) {
  return 1.0 - clearcoatAt(material, texcoords).x * fresnelSchlick(vec3(kCoatF0), 1.0, cosine).x;
}

/// The clearcoat's normal, in the frame of the base.
vec3 coatNormalAt(Surface s, Frame3 around, vec3 wo) {
  if (!kNormalMaps) return vec3(0.0, 0.0, 1.0);
  vec3 normal = s.shadingNormal;
  uvec4 slot = slotClearcoatNormals(s.material);
  float scale = materialFloats(s.material, kMaterialClearcoat).z;
  if ((slot.z & kTexturePresent) != 0u) normal = normalFromMap(s, texturedNormal(slot, scale, s.texcoords));
  normal = reflectingNormal(facingNormal(normal, wo), s.geometricNormal, wo);
  return normalize(toFrame(around, normal));
}

/// All of the layers of a point, `around` its shading normal. Inside of a solid there is no layer: clearcoat and sheen
/// lie on the outside.
Bsdf addLayers(Bsdf b, Surface s, Frame3 around, vec3 wo, float strength) {
  if (kAnisotropy) b = stretchMicrofacets(b, strength);
  if (kIridescence) b = addFilm(b, s.material, s.texcoords);
  if (kDiffuseTransmission) b = addDiffuseTransmission(b, s.material, s.texcoords);
  if (kThinScattering) b = addThinScattering(b, s.material, s.texcoords);
  bool outside = s.front || !b.solid;
  if (kSheen) {
    b = addSheen(b, s.material, s.texcoords);
    if (!outside) b.sheenColor = vec3(0.0);
  }
  if (kClearcoat) {
    vec2 coat = clearcoatAt(s.material, s.texcoords);
    b.coat = outside ? coat.x : 0.0;
    b.coatAlpha = coat.y * coat.y;
    b.coatNormal = coatNormalAt(s, around, wo);
  }
  return b;
}
