// SPDX-License-Identifier: MIT
// Shows a traced picture as a display does: exposure, tone map and sRGB. The curves and their sources are those of
// src/image/display/tone_map.cpp. Coverage stays in alpha.
#include "srgb.glsl"
#include "picture/dither.glsl"

layout(binding = 0) uniform sampler2D traced;
layout(location = 0) uniform float factor;  // 2^EV
layout(location = 1) uniform int toneMap;   // index of the curve in ToneMap
layout(location = 2) uniform bool dithers;
layout(location = 3) uniform vec4 page;     // the colour behind the surfaces; alpha 0: there is none

layout(location = 0) out vec4 displayed;

vec3 aces(vec3 color) {
  const mat3 inputs = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
  const mat3 outputs = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
  // The curve is flat long before squares overflow.
  vec3 v = inputs * min(color, vec3(1e9));
  return outputs * ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
}

vec3 agx(vec3 color) {
  const mat3 toRec2020 = mat3(0.6274, 0.0691, 0.0164, 0.3293, 0.9195, 0.0880, 0.0433, 0.0113, 0.8956);
  const mat3 toRec709 = mat3(1.6605, -0.1246, -0.0182, -0.5876, 1.1329, -0.1006, -0.0728, -0.0083, 1.1187);
  const mat3 inset = mat3(0.856627153315983, 0.137318972929847, 0.11189821299995, 0.0951212405381588, 0.761241990602591,
                          0.0767994186031903, 0.0482516061458583, 0.101439036467562, 0.811302368396859);
  const mat3 outset = mat3(1.1271005818144368, -0.1413297634984383, -0.14132976349843826, -0.11060664309660323,
                           1.157823702216272, -0.11060664309660294, -0.016493938717834573, -0.016493938717834257,
                           1.2519364065950405);
  vec3 ev = log2(max(inset * (toRec2020 * color), vec3(1e-10)));
  vec3 x = clamp((ev + 12.47393) / (4.026069 + 12.47393), 0.0, 1.0);
  vec3 contrast = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
  return toRec709 * pow(max(outset * contrast, vec3(0.0)), vec3(2.2));
}

vec3 neutral(vec3 color) {
  const float fresnel = 0.04;
  const float start = 0.8 - fresnel;
  float lowest = min(color.r, min(color.g, color.b));
  color -= lowest < 2.0 * fresnel ? lowest - lowest * lowest / (4.0 * fresnel) : fresnel;
  float peak = max(color.r, max(color.g, color.b));
  if (peak <= start) return color;
  const float room = 1.0 - start;
  float newPeak = 1.0 - room * room / (peak + room - start);
  float whiteness = 1.0 - 1.0 / (0.15 * (peak - newPeak) + 1.0);
  return mix(color * (newPeak / peak), vec3(newPeak), whiteness);
}

vec3 mapped(vec3 color, int curve) {
  // All curves are flat above this. NaN compares false.
  color = mix(vec3(0.0), min(color, vec3(1e18)), greaterThan(color, vec3(0.0)));
  if (curve == 1) color = color / (1.0 + color);
  if (curve == 2) color = aces(color);
  if (curve == 3) color = agx(color);
  if (curve == 4) color = neutral(color);
  return clamp(color, 0.0, 1.0);
}

void main() {
  vec4 texel = texelFetch(traced, ivec2(gl_FragCoord.xy), 0);
  float coverage = clamp(texel.a, 0.0, 1.0);
  vec3 color = coverage > 0.0 ? texel.rgb / coverage : vec3(0.0);
  vec3 light = mapped(color * factor, toneMap);
  if (page.a > 0.0) {
    // The same as shownOver() of src/image/display/tone_map.h.
    vec3 own = texel.rgb - (1.0 - coverage) * page.rgb;
    light = coverage > 0.0 ? coverage * mapped(own * (factor / coverage), toneMap) + min(own, vec3(0.0)) : vec3(0.0);
    light = clamp(light + (1.0 - coverage) * page.rgb, 0.0, 1.0);
    coverage = 1.0;
  }
  vec3 value = encoded(light);
  if (dithers) {
    uvec2 place = uvec2(gl_FragCoord.xy);
    for (uint c = 0u; c < 3u; ++c) value[c] = dithered(value[c], place.x, place.y, c);
  }
  displayed = vec4(value, coverage);
}
