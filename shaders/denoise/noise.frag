// SPDX-License-Identifier: MIT
// The second pass of the variance filter: the noise of each pixel. Samples of a sequence are not independent, so their
// variance is multiplied by the share that observations confirm in a window of like surfaces. That share is pulled
// towards the whole picture's share where the window is small.
#include "denoise/denoise.glsl"

layout(binding = 0) uniform sampler2D lights;     // these are outputs of prepare.frag
layout(binding = 1) uniform sampler2D observed;
layout(binding = 2) uniform usampler2D guides;
layout(binding = 3) uniform sampler2D shares;     // output of summary.frag
layout(location = 1) uniform bool wasObserved;

layout(location = 0) out vec4 light;   // alpha: the variance that the filter uses
layout(location = 1) out float noise;  // the variance that the pixel's own samples tell

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 own = texelFetch(lights, pixel, 0);
  Guide guide = guideOf(texelFetch(guides, pixel, 0));
  bool known = own.a >= 0.0;
  float weights = 0.0;
  float shown = 0.0;
  float squares = 0.0;
  float variance = 0.0;
  // These are sums of relative variance, so that the brightest pixels do not outweigh the rest.
  float independent = 0.0;
  float independentSquares = 0.0;
  float observations = 0.0;
  int reach = empty(guide) ? -1 : kWindow;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      ivec2 other = pixel + ivec2(x, y);
      bool there = inside(other);
      other = clamp(other, ivec2(0), size - 1);
      vec4 tap = texelFetch(lights, other, 0);
      float weight = there ? exp(likeness(guide, guideOf(texelFetch(guides, other, 0)), vec2(x, y))) : 0.0;
      float value = luminance(tap.rgb);
      float part = tap.a / (value * value + kDarkSquared);
      weights += weight;
      shown += weight * value;
      squares += weight * value * value;
      variance += weight * tap.a;
      independent += weight * part;
      independentSquares += weight * part * part;
      observations += weight * texelFetch(observed, other, 0).r / (value * value + kDarkSquared);
    }
  }
  light = vec4(own.rgb, 0.0);
  noise = 0.0;
  if (weights <= 0.0) return;
  if (!known) {
    shown /= weights;
    light.a = noise = max(squares / weights - shown * shown, 0.0);
    return;
  }
  float left = 1.0;
  vec4 whole = texelFetch(shares, ivec2(0), 0);
  if (wasObserved && whole.y > 0.0 && independent > 0.0) {
    // Observed / independent variance of the whole picture.
    float share = min(whole.x / whole.y, 1.0);
    float prior = 8.0 * independentSquares / independent;  // that share counts for 8 pixels
    left = min((observations + prior * share) / (independent + prior), 1.0);
  }
  noise = left * own.a;
  light.a = left * max(own.a, variance / weights);
}
