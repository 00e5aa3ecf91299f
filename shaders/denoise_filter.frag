// SPDX-License-Identifier: MIT
// One level of the variance filter: 5 x 5 taps `stride` pixels apart (edge-avoiding a-trous wavelets: Dammertz et al. 2010), each weighed by how alike the
// surfaces are and by whether the light differs by more than its noise explains; the variance of the mean is carried along (Schied et al. 2017 do both).
#include "denoise.glsl"

layout(binding = 0) uniform sampler2D lights;    // as denoise_prepare.frag leaves these
layout(binding = 1) uniform sampler2D surfaces;
layout(binding = 2) uniform sampler2D shapes;
layout(binding = 3) uniform sampler2D slopes;
layout(location = 1) uniform int stride;

layout(location = 0) out vec4 filtered;

// Differences that weigh exp(-1/2), squared; of coverage exp(-1).
const float kAlbedoSquared = 0.03 * 0.03;
const float kNormalSquared = 0.15 * 0.15;
const float kDepthSquared = 0.01 * 0.01;  // of its logarithm to base 2, beyond what the slope explains
const float kCoverageSquared = 0.02;
const float kSlopes = 1.5;
const float kDeviationsSquared = 2.0 * 2.0;  // of light, in standard deviations
const float kRounding = 1e-6;                // of light, squared: what is not noise

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 own = texelFetch(lights, pixel, 0);
  vec4 surface = texelFetch(surfaces, pixel, 0);
  vec4 shape = texelFetch(shapes, pixel, 0);
  vec2 slope = kSlopes * texelFetch(slopes, pixel, 0).xy;
  float luminance = brightness(own.rgb);
  vec3 sum = vec3(0.0);
  float variance = 0.0;
  float weights = 0.0;
  const float kernel[3] = float[3](0.375, 0.25, 0.0625);
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      ivec2 away = ivec2(x, y) * stride;
      ivec2 other = pixel + away;
      bool there = inside(other);
      other = clamp(other, ivec2(0), size - 1);
      vec4 light = texelFetch(lights, other, 0);
      vec4 apart = texelFetch(surfaces, other, 0) - surface;
      vec4 turned = texelFetch(shapes, other, 0) - shape;
      float beyond = max(abs(turned.w) - dot(abs(vec2(away)), slope), 0.0);
      float difference = brightness(light.rgb) - luminance;
      float noise = kDeviationsSquared * (own.a + light.a) + kRounding * luminance * luminance + 1e-30;
      float exponent = 0.5 * (dot(apart.rgb, apart.rgb) / kAlbedoSquared + dot(turned.xyz, turned.xyz) / kNormalSquared + beyond * beyond / kDepthSquared) +
                       apart.a * apart.a / kCoverageSquared + difference * difference / noise;
      float weight = there ? kernel[abs(x)] * kernel[abs(y)] * exp(-exponent) : 0.0;
      sum += weight * light.rgb;
      variance += weight * weight * light.a;
      weights += weight;
    }
  }
  filtered = vec4(sum / weights, variance / (weights * weights));
}
