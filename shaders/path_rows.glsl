// SPDX-License-Identifier: MIT
// A path in rows of the buffer of path states. The wavefront keeps paths from round to round, the megakernel from draw
// to draw (kResumable). Rows lie alike in both. The wavefront keeps no row that its variant does not need.

const int kRowRay = 0;              // origin, tie
const int kRowDirection = 1;        // direction, medium
const int kRowHit = 2;              // the ray's hit: distance, slot, weights
const int kRowThroughput = 3;       // throughput, pdf
const int kRowRadiance = 4;         // radiance, flags
const int kRowCounts = 5;           // sample, rays, scatterings (scatteringsOf), free and straight ones (bounceCounts)
// kShadowRows:
const int kRowShadow = 6;           // shadow ray's origin, limit
const int kRowShadowDirection = 7;  // its direction, etaScale
const int kRowContribution = 8;     // contribution, instance of the hit
// kPassingRows:
const int kRowShadowHit = 9;        // the hit of the shadow ray, or of a suspended traversal: distance, slot, weights
// The last surfaces that the ray and the shadow ray have passed: distance and slot of each; a suspended traversal has
// its two groups instead of the second.
const int kRowTMin = 10;
// the cone; instance of the row of the shadow ray's hit, instance that is walked, medium of the shadow ray
const int kRowInstances = 11;
// kResumable:
const int kRowSuspended = 12;       // node of the traversal, more flags, visits
const int kRowStack = 13;
const int kRowOwn = kRowStack + kStackSize / 4;  // the integrator's

const bool kShadowRows = kShadows || kPassesLight || kInstances || kResumable;
const bool kPassingRows = kPassing || kResumable || kMedia || kRayCones;

/// Rows of a path of the megakernel.
const int kSuspendedRows = kRowOwn + int(kPathOwnRows);

/// The count of scatterings and, above it, the prefix.
uint scatteringsOf(Path p) { return uint(p.bounce) | uint(p.prefix) << 29; }

/// Both counts in a word: roulette ends a path long before either is 65,535.
uint bounceCounts(Path p) { return uint(p.freeBounces) | (kThroughGlass ? uint(p.straightBounces) << 16 : 0u); }

/// Returns the count of scatteringsOf().
int bounceIn(uint scatterings) { return int(scatterings & 0x1fffffffu); }

Path withCounts(Path p, uint scatterings, uint freeBounces) {
  p.bounce = bounceIn(scatterings);
  p.prefix = int(scatterings >> 29);
  p.freeBounces = int(kThroughGlass ? freeBounces & 0xffffu : freeBounces);
  p.straightBounces = int(kThroughGlass ? freeBounces >> 16 : 0u);
  return p;
}

/// The hit of a traversal as a row.
uvec4 metBy(Traversal t) { return uvec4(floatBitsToUint(t.t), uint(t.slot), floatBitsToUint(t.weights)); }

/// begins: nothing has changed yet what a camera ray carries, and it is outside of all solids. The wavefront keeps
/// fewer rows of such a path.
void savePath(Path p, int row, bool begins) {
  uint flags = uint(p.phase) | (begins ? 8u : 0u) | (p.cameraRay ? 16u : 0u) | (p.oneChannel ? 32u : 0u) |
               (p.covered ? 64u : 0u) | (p.connection.throughGlass ? 128u : 0u) | p.ray.normal << 8;
  pathStates[row + kRowRay] = uvec4(floatBitsToUint(p.ray.origin), floatBitsToUint(p.ray.tie));
  pathStates[row + kRowDirection] = uvec4(floatBitsToUint(p.ray.direction), p.ray.medium);
  pathStates[row + kRowHit] = uvec4(floatBitsToUint(p.hit.t), uint(p.hit.slot), floatBitsToUint(p.hit.weights));
  if (!begins) pathStates[row + kRowThroughput] = uvec4(floatBitsToUint(p.throughput), floatBitsToUint(p.ray.pdf));
  pathStates[row + kRowRadiance] = uvec4(floatBitsToUint(p.radiance), flags);
  uint sampleIndex = bitfieldReverse(p.sampler.reversed);
  pathStates[row + kRowCounts] = uvec4(sampleIndex, uint(p.rays), scatteringsOf(p), bounceCounts(p));
  if (kShadowRows && !begins) {
    pathStates[row + kRowShadow] = uvec4(floatBitsToUint(p.connection.origin), floatBitsToUint(p.connection.limit));
    pathStates[row + kRowShadowDirection] = uvec4(floatBitsToUint(p.connection.direction), floatBitsToUint(p.etaScale));
  }
  uvec4 light = uvec4(floatBitsToUint(p.connection.light), uint(p.hit.instance));
  if (kShadowRows) pathStates[row + kRowContribution] = light;
  if (kPassingRows) {
    Traversal t = p.traversal;
    pathStates[row + kRowTMin] = uvec4(floatBitsToUint(t.tMin), uint(t.tMinSlot), 0u, 0u);
    pathStates[row + kRowInstances] = uvec4(p.ray.cone, uint(t.hitInstance), uint(t.instance), p.connection.medium);
  }
}

/// Loads a path without its shadow ray. key: that of its random numbers.
Path loadPath(int row, uint key) {
  vec4 f = uintBitsToFloat(readPathStates(row + kRowRay));
  uvec4 a = readPathStates(row + kRowDirection);
  uvec4 counts = readPathStates(row + kRowCounts);
  Path p = newPath(f.xyz, uintBitsToFloat(a.xyz), makeSampler(key, counts.x));
  p.ray.tie = f.w;
  p.ray.medium = a.w;
  a = readPathStates(row + kRowHit);
  p.hit.t = uintBitsToFloat(a.x);
  p.hit.slot = int(a.y);
  p.hit.weights = uintBitsToFloat(a.zw);
  a = readPathStates(row + kRowRadiance);
  p.radiance = uintBitsToFloat(a.xyz);
  p.phase = int(a.w & 7u);
  p.cameraRay = (a.w & 16u) != 0u;
  p.oneChannel = (a.w & 32u) != 0u;
  p.covered = (a.w & 64u) != 0u;
  p.connection.throughGlass = (a.w & 128u) != 0u;
  p.ray.normal = a.w >> 8;
  bool begins = !kResumable && (a.w & 8u) != 0u;
  f = uintBitsToFloat(readPathStates(row + kRowThroughput));
  p.throughput = begins ? vec3(1.0 / float(kCameraRays)) : f.xyz;
  p.ray.pdf = begins ? 0.0 : f.w;
  if (kTimed) p.time = timeOf(p.sampler);
  p.rays = int(counts.y);
  p = withCounts(p, counts.z, counts.w);
  if (kShadowRows) {
    p.etaScale = begins ? 1.0 : uintBitsToFloat(readPathStates(row + kRowShadowDirection).w);
    a = readPathStates(row + kRowContribution);
    p.connection.light = uintBitsToFloat(a.xyz);
    p.hit.instance = int(a.w);
  }
  if (kRayCones) p.ray.cone = readPathStates(row + kRowInstances).x;
  if (kDimsLate) {
    p.connection.medium = readPathStates(row + kRowInstances).w;
    p.traversal.tMin = uintBitsToFloat(readPathStates(row + kRowTMin).x);
  }
  return p;
}

/// The shadow ray, and what the traversal has met.
Path loadShadow(Path p, int row) {
  vec4 f = uintBitsToFloat(readPathStates(row + kRowShadow));
  p.connection.origin = f.xyz;
  p.connection.limit = f.w;
  p.connection.direction = uintBitsToFloat(readPathStates(row + kRowShadowDirection).xyz);
  uvec4 a = readPathStates(row + kRowShadowHit);
  p.traversal.t = uintBitsToFloat(a.x);
  p.traversal.slot = int(a.y);
  p.traversal.weights = uintBitsToFloat(a.zw);
  p.traversal.hitInstance = kInstances ? int(readPathStates(row + kRowInstances).y) : -1;
  return p;
}

/// A path that continues in the next draw, in whatever phase and wherever in a traversal.
void suspendPath(Path p, int row) {
  savePath(p, row, false);
  Traversal t = p.traversal;
  uint flags = uint(p.next) | (p.eye.caught ? 16u : 0u) | (p.eye.clear ? 64u : 0u);
  pathStates[row + kRowShadowHit] = metBy(t);
  pathStates[row + kRowTMin].zw = uvec2(t.group, t.leaves);
  pathStates[row + kRowSuspended] = uvec4(uint(t.node), 0u, flags, uint(t.visits));
  if (!kIterative && !kLiterals) saveStack(t.stack, row + kRowStack);
  suspendOwn(p, row + kRowOwn);
}

Path resumePath(int row, uint key) {
  Path p = loadShadow(loadPath(row, key), row);
  uvec4 a = readPathStates(row + kRowSuspended);
  p.next = int(a.z & 15u);
  p.eye.caught = (a.z & 16u) != 0u;
  p.eye.clear = (a.z & 64u) != 0u;
  if (kMoving) p.traversal.part = momentAt(p.time, frame.segments.x).part;
  p.traversal.node = int(a.x);
  p.traversal.visits = int(a.w);
  a = readPathStates(row + kRowTMin);
  p.traversal.tMin = uintBitsToFloat(a.x);
  p.traversal.tMinSlot = int(a.y);
  p.traversal.group = a.z;
  p.traversal.leaves = a.w;
  if (kInstances) p.traversal.instance = int(readPathStates(row + kRowInstances).z);
  p.traversal.extends = p.phase == kPhaseExtend;
  p.traversal.both = p.phase == kPhaseExtend;
  p.traversal.tie = p.phase == kPhaseExtend ? p.ray.tie : 0.0;
  if (!kIterative && !kLiterals) p.traversal.stack = loadStack(row + kRowStack);
  return resumeOwn(p, row + kRowOwn);
}
