// SPDX-License-Identifier: MIT
// The passes of the variance filter share these functions (src/render/denoise.h). Pictures are textures of one texel a
// pixel. Light is divided by the albedo, so that textures stay sharp, and is in units of the picture's mean.
#include "picture/picture.glsl"

const float kDarkSquared = 0.01;   // dark light, squared, which is added to the divisors of relative differences
const float kBrightest = 1e12;     // largest light
const int kWindow = 2;             // pixels each way, of the passes that look at noise

/// The least light that counts in the geometric mean, a thousandth of the arithmetic one. A lamp that is a thousand
/// times as bright as all else then hardly counts.
float leastLight(vec4 means) { return 1e-3 * means.x / max(means.y, 1.0); }

/// 1 / typical luminance of the pixels that have an albedo; 1 if all are black.
float scaleOf(vec4 means, vec4 logarithms) { return means.x > 0.0 ? exp(-logarithms.x / means.y) : 1.0; }

/// Light in units of the mean, so that squares neither overflow nor vanish.
vec3 scaledLight(vec3 light, float scale) { return clamp(light * scale, 0.0, kBrightest); }
float scaledVariance(float variance, float scale) {
  return clamp(variance * scale * scale, 0.0, kBrightest * kBrightest);
}

/// The properties by which a filter distinguishes surfaces, as means over the samples that hit something.
struct Guide {
  vec4 albedo;  // and coverage
  vec3 normal;
  float depth;  // logarithm to base 2
  vec2 slope;   // change of `depth` per pixel
};

/// All guides fit into one texel, since a tap costs as much as it fetches. 8 bits are finer than the differences that
/// count.
uvec4 packedGuide(Guide g) {
  return uvec4(packUnorm4x8(g.albedo), packSnorm4x8(vec4(g.normal, 0.0)), floatBitsToUint(g.depth),
               packHalf2x16(g.slope));
}

Guide guideOf(uvec4 bits) {
  return Guide(unpackUnorm4x8(bits.x), unpackSnorm4x8(bits.y).xyz, uintBitsToFloat(bits.z), unpackHalf2x16(bits.w));
}

/// Returns the logarithm of the weight of a tap, 0 or less, by the likeness of the surfaces. `away` is its offset in
/// pixels.
float likeness(Guide own, Guide other, vec2 away) {
  const float albedo = 0.5 / (0.08 * 0.08);
  const float normal = 0.5 / (0.3 * 0.3);
  const float depth = 0.5 / (0.01 * 0.01);  // beyond what the slope explains
  const float coverage = 50.0;
  const float slopes = 1.5;
  vec4 tinted = other.albedo - own.albedo;
  vec3 turned = other.normal - own.normal;
  float beyond = max(abs(other.depth - own.depth) - slopes * dot(abs(away), own.slope), 0.0);
  return -(albedo * dot(tinted.rgb, tinted.rgb) + normal * dot(turned, turned) + depth * beyond * beyond +
           coverage * tinted.a * tinted.a);
}

/// Returns true if the pixel shows only the background, which has no noise and is not filtered.
bool empty(Guide g) { return g.albedo.a <= 0.0; }
