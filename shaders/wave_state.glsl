// SPDX-License-Identifier: MIT
// What the wavefront keeps of a path while its rays are traced, in rows of the storage buffer of path states.

const int kPhaseNone = 5;  // no path: the pixel's next one is to begin
/// Rows of a path: all, or those before the ones of alpha.
const int kWavePathRows = int(kPassing ? kWaveRows : kWaveRows - kWaveAlphaRows);
const bool kShadowRows = kShadows || kPassesLight || kInstances;

/// A path between two rounds, and the rays that its sample has traced so far.
struct WavePath {
  Path path;
  int rays;
};

// Rows: 0 origin, tie; 1 direction, medium; 2 distance, slot, weights of the hit; 3 throughput, density; 4 radiance,
// flags; 5 sample, rays, scatterings; with kShadowRows 6 shadow ray, limit; 7 its direction, compression; 8
// contribution, instance of the hit; with kPassing 9 distance, slot, weights of the shadow ray's hit; 10 what the ray
// and the shadow ray have passed through; 11 crossings, instance of the shadow ray's hit.
const int kRowHit = 2;
const int kRowFlags = 4;
const int kRowShadow = 6;
const int kRowContribution = 8;
const int kRowShadowHit = 9;
const int kRowPast = 10;
const int kRowCrossings = 11;

/// A row of the states: by an image unit that the scene leaves free where there is one, since llvmpipe reads those five
/// times as fast.
layout(rgba32ui, binding = kWaveUnit) uniform readonly uimageBuffer waveStates;
uvec4 readWave(int row) {
  if (kWaveImage) return imageLoad(waveStates, row);
  return pathStates[row];
}

/// A path that begins. Its first ray has met what t says.
void saveFirst(Path p, Traversal t, int row) {
  pathStates[row] = uvec4(floatBitsToUint(p.origin), floatBitsToUint(p.tie));
  pathStates[row + 1] = uvec4(floatBitsToUint(p.direction), p.medium);
  pathStates[row + kRowHit] = uvec4(floatBitsToUint(t.t), uint(t.slot), floatBitsToUint(t.weights));
  pathStates[row + kRowFlags] = uvec4(0u, 0u, 0u, uint(kPhaseExtend) | 16u | kNoNormal << 8);
  pathStates[row + 5] = uvec4(p.numbers.index, 0u, 0u, 0u);
  if (kShadowRows) pathStates[row + kRowContribution] = uvec4(0u, 0u, 0u, uint(-1));
  if (kPassing) {
    pathStates[row + kRowPast] = uvec4(floatBitsToUint(t.past), uint(t.pastSlot), 0u, 0u);
    pathStates[row + kRowCrossings] = uvec4(0u);
  }
}

/// And how far it is a chain, which has no room among the flags.
uint bounceOf(Path p) { return uint(p.bounce) | (kCaustics ? uint(p.chain) << 30 : 0u); }

Path withBounce(Path p, uint word) {
  p.bounce = int(kCaustics ? word & 0x3fffffffu : word);
  p.chain = int(kCaustics ? word >> 30 : 0u);
  return p;
}

void saveWave(WavePath w, Traversal t, int row) {
  Path p = w.path;
  uint flags = uint(p.phase) | (p.cameraRay ? 16u : 0u) | (p.oneChannel ? 32u : 0u) | (p.alpha > 0.0 ? 64u : 0u) |
               (p.throughWalls ? 128u : 0u) | (kLightTree ? p.normal << 8 : 0u);
  pathStates[row] = uvec4(floatBitsToUint(p.origin), floatBitsToUint(p.tie));
  pathStates[row + 1] = uvec4(floatBitsToUint(p.direction), p.medium);
  pathStates[row + kRowHit] = uvec4(floatBitsToUint(t.t), uint(t.slot), floatBitsToUint(t.weights));
  pathStates[row + 3] = uvec4(floatBitsToUint(p.throughput), floatBitsToUint(p.density));
  pathStates[row + kRowFlags] = uvec4(floatBitsToUint(p.radiance), flags);
  pathStates[row + 5] = uvec4(p.numbers.index, uint(w.rays), bounceOf(p), clearOf(p));
  if (kShadowRows) {
    pathStates[row + kRowShadow] = uvec4(floatBitsToUint(p.shadowOrigin), floatBitsToUint(p.shadowLimit));
    pathStates[row + kRowShadow + 1] = uvec4(floatBitsToUint(p.shadowDirection), floatBitsToUint(p.compression));
    pathStates[row + kRowContribution] = uvec4(floatBitsToUint(p.contribution), uint(-1));
  }
  if (kPassing) {
    Traversal none = startTraversal(0.0, 0);
    pathStates[row + kRowPast] = uvec4(floatBitsToUint(t.past), uint(t.pastSlot), floatBitsToUint(none.past),
                                       uint(none.pastSlot));
    pathStates[row + kRowCrossings] = uvec4(uint(p.crossings), 0u, 0u, 0u);
  }
}

WavePath loadWave(int row, uint key) {
  WavePath w;
  Path p;
  vec4 f = uintBitsToFloat(readWave(row));
  p.origin = f.xyz;
  p.tie = f.w;
  uvec4 a = readWave(row + 1);
  p.direction = uintBitsToFloat(a.xyz);
  p.medium = a.w;
  a = readWave(row + kRowHit);
  p.hitT = uintBitsToFloat(a.x);
  p.hitSlot = int(a.y);
  p.hitWeights = uintBitsToFloat(a.zw);
  a = readWave(row + kRowFlags);
  p.radiance = uintBitsToFloat(a.xyz);
  p.phase = int(a.w & 15u);
  p.cameraRay = (a.w & 16u) != 0u;
  p.oneChannel = (a.w & 32u) != 0u;
  p.alpha = (a.w & 64u) != 0u ? 1.0 : 0.0;
  p.throughWalls = (a.w & 128u) != 0u;
  p.normal = kLightTree ? a.w >> 8 : kNoNormal;
  // Nothing has changed what a camera ray carries.
  f = uintBitsToFloat(readWave(row + 3));
  p.throughput = p.cameraRay ? vec3(1.0) : f.xyz;
  p.density = p.cameraRay ? 0.0 : f.w;
  a = readWave(row + 5);
  p.pixel = ivec2(0);
  p.numbers = makeSampler(key, a.x);
  w.rays = int(a.y);
  p = withBounce(p, a.z);
  p = withClear(p, a.w);
  p.shadowOrigin = vec3(0.0);
  p.shadowLimit = 0.0;
  p.shadowDirection = vec3(0.0, 0.0, 1.0);
  p.compression = 1.0;
  p.contribution = vec3(0.0);
  p.hitInstance = -1;
  if (kShadowRows) {
    p.compression = p.cameraRay ? 1.0 : uintBitsToFloat(readWave(row + kRowShadow + 1).w);
    a = readWave(row + kRowContribution);
    p.contribution = uintBitsToFloat(a.xyz);
    p.hitInstance = int(a.w);
  }
  p.after = kPhaseEnd;
  p.lightSlot = 0;
  p.crossings = kPassing ? int(readWave(row + kRowCrossings).x) : 0;
  p.traversal = startTraversal(kFarAway, frame.limits.w);
  w.path = p;
  return w;
}
