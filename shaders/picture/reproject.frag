// SPDX-License-Identifier: MIT
// Takes from a past picture its values at the points that the present one shows (src/render/picture_passes.h). Places
// and points are relative to the present camera's position.
#include "picture/picture.glsl"
#include "sampling.glsl"
#include "camera.glsl"

layout(binding = 0) uniform sampler2D radiances;  // the present, from film.frag
layout(binding = 1) uniform sampler2D counts;
layout(binding = 2) uniform sampler2D albedos;
layout(binding = 3) uniform sampler2D normals;
layout(binding = 4) uniform sampler2D pastRadiances;
layout(binding = 5) uniform sampler2D pastCounts;
layout(binding = 6) uniform sampler2D pastAlbedos;
layout(binding = 7) uniform sampler2D pastNormals;
layout(location = 1) uniform ivec2 pastSize;
// Two cameras, present and past: position, half of the width (at distance 1 for a perspective), half of the height,
// forward. w of these: none, the shift of the lens along x, along y, and the type of camera (CameraType in
// src/scene/scene.h).
layout(location = 2) uniform vec4 cameras[8];

layout(location = 0) out vec4 past;   // light at the present albedo, and the variance of its luminance
// Luminance of the present light minus that of the past; the variance that noise gives this difference, negative if not
// known; samples of the past, 0 if it has no value here; 1 if such a pixel is compared, else 0.
layout(location = 1) out vec4 apart;

const float kCovered = 0.5;  // share of a pixel's samples that makes it show a surface

const float kPerspectiveType = 0.0;
const float kPanoramaType = 2.0;  // and above: a fisheye

/// The surface that a part of a pixel shows.
struct Surface {
  vec3 albedo;
  float coverage;
  vec3 normal;
  float depth;
};

Surface surfaceOf(vec4 albedo, vec4 normal) {
  float part = 1.0 / max(albedo.a, 1e-6);
  return Surface(part * albedo.rgb, albedo.a, part * normal.xyz, part * normal.w);
}

vec3 divisorOf(Surface s) { return mix(max(s.albedo, vec3(0.0)), vec3(1.0), kAlbedoFloor); }

/// The point in the middle of a pixel.
vec3 pointAt(vec2 pixel, float depth) {
  vec2 place = 2.0 * pixel / vec2(size) - 1.0;
  if (cameras[3].w >= kPanoramaType) {
    vec2 whole = vec2(length(cameras[1].xyz), length(cameras[2].xyz));
    vec2 angles = place * whole;
    vec3 d = cameras[3].w == kPanoramaType ? panoramaDirection(place.x, place.y) : fisheyeDirection(angles.x, angles.y);
    vec3 aside = d.x * (cameras[1].xyz / whole.x) + d.y * (cameras[2].xyz / whole.y);
    return cameras[0].xyz + depth * (aside + d.z * cameras[3].xyz);
  }
  place += vec2(cameras[1].w, cameras[2].w);
  vec3 aside = place.x * cameras[1].xyz + place.y * cameras[2].xyz;
  return cameras[0].xyz + depth * cameras[3].xyz + (cameras[3].w == kPerspectiveType ? depth : 1.0) * aside;
}

bool showsTheSame(Surface now, float depth, Surface before) {
  const float depthApart = 0.02;   // relative difference
  const float normalAlike = 0.9;   // cosine
  const float albedoApart = 0.15;  // a channel
  vec3 apart = abs(now.albedo - before.albedo);
  return before.coverage >= kCovered && abs(before.depth - depth) <= depthApart * abs(depth) &&
         dot(now.normal, before.normal) >= normalAlike * length(now.normal) * length(before.normal) &&
         max(max(apart.r, apart.g), apart.b) <= albedoApart;
}

/// The history (`past`), interpolated at a point.
struct Known {
  vec3 light;  // without albedo
  float variance;
  float samples;
  float weight;  // the sum of the weights of the taps that show the same surface
};

Known knownOf(Surface now, vec3 point) {
  Known known = Known(vec3(0.0), 0.0, 0.0, 0.0);
  vec3 view = point - cameras[4].xyz;
  float depth = dot(view, cameras[7].xyz);
  vec3 right = cameras[5].xyz;
  vec3 up = cameras[6].xyz;
  float w = cameras[7].w == kPerspectiveType ? depth : 1.0;
  if (!(w > 0.0)) return known;
  vec2 place = vec2(dot(view, right) / dot(right, right), dot(view, up) / dot(up, up)) / w;
  place -= vec2(cameras[5].w, cameras[6].w);
  if (cameras[7].w >= kPanoramaType) {
    vec2 whole = vec2(length(right), length(up));
    vec3 d = vec3(dot(view, right) / whole.x, dot(view, up) / whole.y, depth);
    place = cameras[7].w == kPanoramaType ? panoramaPlace(d) : fisheyePlace(d) / whole;
    depth = length(view);
  }
  vec2 at = (0.5 + 0.5 * place) * vec2(pastSize) - 0.5;
  if (!(all(greaterThan(at, vec2(-1.0))) && all(lessThan(at, vec2(pastSize))))) return known;
  ivec2 corner = ivec2(floor(at));
  for (int tap = 0; tap < 4; ++tap) {
    ivec2 pixel = corner + ivec2(tap & 1, tap >> 1);
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, pastSize))) continue;
    vec2 near = 1.0 - abs(at - vec2(pixel));
    float weight = near.x * near.y;
    float samples = texelFetch(pastCounts, pixel, 0).x;
    Surface before = surfaceOf(texelFetch(pastAlbedos, pixel, 0), texelFetch(pastNormals, pixel, 0));
    if (!(weight > 0.0 && samples > 0.0) || !showsTheSame(now, depth, before)) continue;
    vec4 light = texelFetch(pastRadiances, pixel, 0);
    vec3 divisor = divisorOf(before);
    float part = luminance(divisor);
    known.light += weight * light.rgb / divisor;
    known.variance += weight * light.a / (part * part);
    known.samples += weight * samples;
    known.weight += weight;
  }
  float all = max(known.weight, 1e-6);
  return Known(known.light / all, known.variance / all, known.samples / all, known.weight);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  past = vec4(0.0);
  apart = vec4(0.0);
  vec4 radiance = texelFetch(radiances, pixel, 0);
  float samples = texelFetch(counts, pixel, 0).x;
  Surface now = surfaceOf(texelFetch(albedos, pixel, 0), texelFetch(normals, pixel, 0));
  if (now.coverage < kCovered || !(samples > 0.0)) return;
  Known known = knownOf(now, pointAt(gl_FragCoord.xy, now.depth));
  if (known.weight < 0.25) return;  // of the four taps
  vec3 divisor = divisorOf(now);
  float part = luminance(divisor);
  past = vec4(known.light * divisor, known.variance * part * part);
  apart = vec4(luminance(radiance.rgb - past.rgb), samples > 1.0 ? radiance.a + past.a : -1.0, known.samples, 1.0);
}
