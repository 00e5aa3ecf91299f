// SPDX-License-Identifier: MIT
// One level of the variance filter: 5 x 5 taps `stride` pixels apart (edge-avoiding a-trous wavelets: Dammertz et al.
// 2010). A tap's weight falls where surfaces differ, and where light differs by more than its noise explains. The
// variance of the mean is carried along (Schied et al. 2017 do both).
#include "denoise/denoise.glsl"

layout(binding = 0) uniform sampler2D lights;  // light without albedo; variance of its luminance
layout(binding = 1) uniform usampler2D guides;
layout(location = 1) uniform int stride;

layout(location = 0) out vec4 filtered;

/// The squared difference of luminance, or the one that it would be if all channels differed as much relative to their
/// size, whichever is larger. Noise is known for luminance only, and most of it is as coloured as the light itself.
float differenceOf(vec3 a, vec3 b) {
  const float tint = 0.2;  // share of luminance that is added to the divisor of a channel's difference
  float both = luminance(a) + luminance(b);
  float apart = luminance(a) - luminance(b);
  vec3 relative = (a - b) * (1.0 + tint) * both / (a + b + tint * both + 1e-20);
  return max(apart * apart, dot(relative, relative) / 3.0);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 own = texelFetch(lights, pixel, 0);
  Guide guide = guideOf(texelFetch(guides, pixel, 0));
  float bright = luminance(own.rgb);
  const float deviations = 2.5 * 2.5;  // difference of light, in standard deviations, squared
  // A quiet pixel assumes at most this many times its own variance for a noisy one, and the reverse, so no light is
  // lost.
  const float unlike = 20.0;
  float rounding = 1e-6 * bright * bright + 1e-30;  // of light, squared: such a difference is no noise
  vec3 sum = vec3(0.0);
  float variance = 0.0;
  float weights = 0.0;
  const float kernel[3] = float[3](0.375, 0.25, 0.0625);
  int reach = empty(guide) ? -1 : 2;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      ivec2 away = ivec2(x, y) * stride;
      ivec2 other = pixel + away;
      bool there = inside(other);
      other = clamp(other, ivec2(0), size - 1);
      vec4 light = texelFetch(lights, other, 0);
      float noise = deviations * min(own.a + light.a, unlike * min(own.a, light.a)) + rounding;
      float exponent = likeness(guide, guideOf(texelFetch(guides, other, 0)), vec2(away)) -
                       differenceOf(light.rgb, own.rgb) / noise;
      float weight = there ? kernel[abs(x)] * kernel[abs(y)] * exp(exponent) : 0.0;
      sum += weight * light.rgb;
      variance += weight * weight * light.a;
      weights += weight;
    }
  }
  filtered = weights > 0.0 ? vec4(sum / weights, variance / (weights * weights)) : own;
}
