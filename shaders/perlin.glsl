// SPDX-License-Identifier: MIT
// The procedural smooth normal map (docs/gltf.md): Perlin, Improving Noise, 2002, in two dimensions.

vec2 perlinGradient(int i, int j, int octave) {
  uint h = mixBits((uint(i) * 0x8da6b343u) ^ (uint(j) * 0xd8163841u) ^ (uint(octave) * 0xcb1ab31fu));
  float phi = 2.0f * kPi * (float(h >> 8) * 5.9604644775390625e-8f);
  return vec2(cos(phi), sin(phi));
}

/// Gradient of one octave of noise with respect to the lattice coordinate.
vec2 perlinSlope(float x, float y, int octave) {
  float fx = floor(x);
  float fy = floor(y);
  int i = int(fx);
  int j = int(fy);
  float u = x - fx;
  float v = y - fy;
  vec2 g00 = perlinGradient(i, j, octave);
  vec2 g10 = perlinGradient(i + 1, j, octave);
  vec2 g01 = perlinGradient(i, j + 1, octave);
  vec2 g11 = perlinGradient(i + 1, j + 1, octave);
  float d00 = dot(g00, vec2(u, v));
  float d10 = dot(g10, vec2(u - 1.0f, v));
  float d01 = dot(g01, vec2(u, v - 1.0f));
  float d11 = dot(g11, vec2(u - 1.0f, v - 1.0f));
  float su = u * u * u * (u * (u * 6.0f - 15.0f) + 10.0f);
  float sv = v * v * v * (v * (v * 6.0f - 15.0f) + 10.0f);
  float du = 30.0f * u * u * (u * (u - 2.0f) + 1.0f);
  float dv = 30.0f * v * v * (v * (v - 2.0f) + 1.0f);
  vec2 gradient = (1.0f - sv) * ((1.0f - su) * g00 + su * g10) + sv * ((1.0f - su) * g01 + su * g11);
  float alongU = du * ((1.0f - sv) * (d10 - d00) + sv * (d11 - d01));
  float alongV = dv * ((1.0f - su) * (d01 - d00) + su * (d11 - d10));
  return gradient + vec2(alongU, alongV);
}

/// Tangent-space normal of the map at a texture coordinate.
vec3 perlinNormal(vec2 texcoord, float frequency, float amplitude, int octaves) {
  vec2 slope = vec2(0.0f);
  float weight = 1.0f;
  float scale = frequency;
  for (int octave = 0; octave < octaves; ++octave) {
    slope = slope + weight * perlinSlope(scale * texcoord.x, scale * texcoord.y, octave);
    weight = weight * 0.5f;
    scale = scale * 2.0f;
  }
  return normalize(vec3(-amplitude * slope.x, amplitude * slope.y, 1.0f));
}
