// SPDX-License-Identifier: MIT
// Reads a displayed picture at a place between its pixels. At an edge, a kernel that is long along the edge and short
// across it removes the stairs. Its direction is that of the luma's structure tensor (Foerstner and Guelch 1987). AMD's
// FSR 1 (2021) enlarges by the same idea, from the same twelve pixels.

// The twelve pixels are four by four without corners, from the row before; the middle ones are 3, 4, 7 and 8.
const int kTaps = 12;
const ivec2 kTapAt[kTaps] = ivec2[](ivec2(0, -1), ivec2(1, -1), ivec2(-1, 0), ivec2(0, 0), ivec2(1, 0), ivec2(2, 0),
                                    ivec2(-1, 1), ivec2(0, 1), ivec2(1, 1), ivec2(2, 1), ivec2(0, 2), ivec2(1, 2));

vec3 tensorOf(float x, float y) { return vec3(x * x, x * y, y * y); }

/// A unit vector across the edge that passes the middle, and its strength (0 to 1).
vec3 edgeOf(vec4 colors[kTaps], vec4 weights) {
  float l[kTaps];
  for (int i = 0; i < kTaps; ++i) l[i] = dot(colors[i].rgb, vec3(0.299, 0.587, 0.114));
  vec3 tensor = weights.x * tensorOf(l[4] - l[2], l[7] - l[0]) + weights.y * tensorOf(l[5] - l[3], l[8] - l[1]) +
                weights.z * tensorOf(l[8] - l[6], l[10] - l[3]) + weights.w * tensorOf(l[9] - l[7], l[11] - l[4]);
  float trace = tensor.x + tensor.z;
  float apart = sqrt((tensor.x - tensor.z) * (tensor.x - tensor.z) + 4.0 * tensor.y * tensor.y);
  float largest = 0.5 * (trace + apart);
  vec2 across = tensor.x >= tensor.z ? vec2(largest - tensor.z, tensor.y) : vec2(tensor.y, largest - tensor.x);
  float size = length(across);
  if (!(size > 0.0)) return vec3(1.0, 0.0, 0.0);
  const float fullStep = 0.25;  // step of luma over two pixels that counts in full as an edge
  return vec3(across / size, apart / trace * min(2.0 * sqrt(largest) / fullStep, 1.0));
}

vec4 enlarged(sampler2D picture, vec2 uv) {
  ivec2 last = textureSize(picture, 0) - 1;
  vec2 place = uv * vec2(last + 1) - 0.5;
  ivec2 corner = ivec2(floor(place));
  vec2 f = place - vec2(corner);
  vec4 a = texelFetch(picture, clamp(corner, ivec2(0), last), 0);
  vec4 b = texelFetch(picture, clamp(corner + ivec2(1, 0), ivec2(0), last), 0);
  vec4 c = texelFetch(picture, clamp(corner + ivec2(0, 1), ivec2(0), last), 0);
  vec4 d = texelFetch(picture, clamp(corner + ivec2(1, 1), ivec2(0), last), 0);
  vec4 least = min(min(a, b), min(c, d));
  vec4 most = max(max(a, b), max(c, d));
  vec4 range = most - least;
  const float even = 0.02;  // range of a channel below which there is no edge
  if (max(max(range.r, range.g), max(range.b, range.a)) < even) return mix(mix(a, b, f.x), mix(c, d, f.x), f.y);
  vec4 colors[kTaps];
  for (int i = 0; i < kTaps; ++i) colors[i] = texelFetch(picture, clamp(corner + kTapAt[i], ivec2(0), last), 0);
  vec3 edge = edgeOf(colors, vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y));
  // Distances across the edge count more than those along it.
  vec2 across = mix(1.0, 1.4, edge.z) * edge.xy;
  vec2 along = mix(1.0, 0.4, edge.z) * vec2(-edge.y, edge.x);
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    vec2 away = vec2(kTapAt[i]) - f;
    float x = dot(across, away);
    float y = dot(along, away);
    float near = max(1.0 - 0.5 * (x * x + y * y), 0.0);  // the kernel ends at the root of 2 pixels
    float weight = near * near * near;
    sum += weight * colors[i];
    weights += weight;
  }
  return clamp(sum / weights, least, most);
}
