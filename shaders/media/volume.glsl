// SPDX-License-Identifier: MIT
// Grids of densities in bricks of 8 x 8 x 8 voxels. A ray passes from brick to brick, each of which knows the largest
// density within it (its majorant). Flights meet the medium as often as if it were as dense as that; a meeting is real
// with the density's share of the majorant (delta tracking: Woodcock et al., 1965; ratio tracking of transmittance:
// Novak, Selle and Jarosz, Residual Ratio Tracking, 2014). Between voxels the density is interpolated by drawing one
// of the eight, which both estimates keep unbiased (Hofmann and Evans, Efficient Unbiased Volume Path Tracing, 2021).

struct Walk {
  float entry;          // the distance at which the ray enters the box of all bricks
  float end;            // the distance of the flight's end; kFarAway where it meets nothing
  float transmittance;  // an estimate of it, of walks that go through
  int steps;            // loop iterations
};

/// The next number of a sequence of 32-bit numbers that a seed begins.
uint nextState(uint state) { return state * 747796405u + 2891336453u; }

/// A place, or with w = 0 a direction, of local space, in bricks from the first corner of the table.
vec3 inBricks(Volume v, vec3 place, float w) {
  return vec3(dot(vec3(v.toBricksX), place), dot(vec3(v.toBricksY), place), dot(vec3(v.toBricksZ), place)) +
         w * vec3(v.toBricksX.w, v.toBricksY.w, v.toBricksZ.w);
}

/// Entry of the table: the brick's first texel, or 0 where it is empty; its majorant.
uvec2 brickEntry(Volume v, ivec3 brick) {
  return readBricks((brick.z * v.table.y + brick.y) * v.table.x + brick.x);
}

bool isInTable(Volume v, ivec3 brick) {
  return min(brick.x, min(brick.y, brick.z)) >= 0 && brick.x < v.table.x && brick.y < v.table.y && brick.z < v.table.z;
}

/// The first texel of the brick that a voxel is in, or 0, and its number in the brick.
ivec2 findVoxel(Volume v, ivec3 voxel) {
  ivec3 brick = ivec3(voxel.x >> 3, voxel.y >> 3, voxel.z >> 3);
  int first = isInTable(v, brick) ? int(brickEntry(v, brick).x) : 0;
  return ivec2(first, ((voxel.z & 7) * 8 + (voxel.y & 7)) * 8 + (voxel.x & 7));
}

/// Part of the grid's largest density.
float voxelDensity(Volume v, ivec3 voxel) {
  ivec2 found = findVoxel(v, voxel);
  if (found.x == 0) return 0.0f;
  uvec2 texel = readBricks(found.x + (found.y >> 2));
  vec2 pair = unpackHalf2x16((found.y & 2) != 0 ? texel.y : texel.x);
  return (found.y & 1) != 0 ? pair.y : pair.x;
}

/// One of the eight voxels round a place in bricks, drawn with its weight in the linear interpolation.
ivec3 drawVoxel(vec3 place, uint bits) {
  vec3 offset = (vec3(float(bits & 1023u), float((bits >> 10) & 1023u), float((bits >> 20) & 1023u)) + 0.5f) *
                float(1.0 / 1024.0);
  vec3 voxel = floor(place * 8.0f + offset);
  return ivec3(int(voxel.x), int(voxel.y), int(voxel.z));
}

/// Radiance of the medium's emission at a place of local space.
vec3 volumeRadiance(Volume v, vec3 point, uint bits) {
  ivec2 found = findVoxel(v, drawVoxel(inBricks(v, point, 1.0f), bits));
  if (found.x == 0) return vec3(0.0f);
  uvec2 texel = readBricks(found.x + kBrickTexels + found.y);
  return v.extinction.y * vec3(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y).x);
}

/// Entry and exit of a ray through a box from 0 to `size`.
vec2 throughBox(vec3 size, vec3 origin, vec3 inverse) {
  vec3 a = -origin * inverse;
  vec3 b = (size - origin) * inverse;
  vec3 low = min(a, b);
  vec3 high = max(a, b);
  return vec2(max(low.x, max(low.y, low.z)), min(high.x, min(high.y, high.z)));
}

float inverseOf(float d) { return abs(d) < float(1e-18) ? float(1e18) : 1.0f / d; }

/// Walks along a ray between two distances: to the end of the flight that `seed` draws, or all the way (`through`), for
/// the transmittance.
Walk walkVolume(Volume v, vec3 origin, vec3 direction, float from, float to, bool through, uint seed) {
  vec3 o = inBricks(v, origin, 1.0f);
  vec3 d = inBricks(v, direction, 0.0f);
  vec3 inverse = vec3(inverseOf(d.x), inverseOf(d.y), inverseOf(d.z));
  vec3 size = vec3(float(v.table.x), float(v.table.y), float(v.table.z));
  vec2 inside = throughBox(size, o, inverse);
  float t = max(from, inside.x);
  float exit = min(to, inside.y);
  Walk walk;
  walk.entry = inside.x;
  walk.end = kFarAway;
  walk.transmittance = 1.0f;
  walk.steps = 0;
  vec3 corner = clamp(floor(o + t * d), vec3(0.0f), size - 1.0f);
  ivec3 brick = ivec3(int(corner.x), int(corner.y), int(corner.z));
  ivec3 ahead = ivec3(d.x < 0.0f ? -1 : 1, d.y < 0.0f ? -1 : 1, d.z < 0.0f ? -1 : 1);
  vec3 far = corner + vec3(d.x < 0.0f ? 0.0f : 1.0f, d.y < 0.0f ? 0.0f : 1.0f, d.z < 0.0f ? 0.0f : 1.0f);
  vec3 next = (far - o) * inverse;  // distances of the brick's sides ahead
  uint state = seed;
  float depth = -log(1.0f - unitFloat(mixBits(state)));
  while (t < exit && walk.steps < kMostVolumeSteps) {
    walk.steps += 1;
    float majorant = uintBitsToFloat(brickEntry(v, brick).y);
    float leave = min(min(next.x, next.y), min(next.z, exit));
    float span = v.extinction.x * majorant * max(leave - t, 0.0f);
    if (depth >= span) {
      depth -= span;
      t = leave;
      bool alongX = next.x <= leave;
      bool alongY = !alongX && next.y <= leave;
      bool alongZ = !alongX && !alongY && next.z <= leave;
      if (alongX) brick.x += ahead.x;
      if (alongX) next.x += abs(inverse.x);
      if (alongY) brick.y += ahead.y;
      if (alongY) next.y += abs(inverse.y);
      if (alongZ) brick.z += ahead.z;
      if (alongZ) next.z += abs(inverse.z);
      if (!isInTable(v, brick)) exit = t;
    } else {
      t += depth / (v.extinction.x * majorant);
      state = nextState(state);
      float share = voxelDensity(v, drawVoxel(o + t * d, mixBits(state))) / majorant;
      state = nextState(state);
      float u = unitFloat(mixBits(state));
      if (!through && u < share) {
        walk.end = t;
        exit = t;
      }
      walk.transmittance *= 1.0f - share;
      // Roulette, so that rays through what is all but opaque come to an end.
      if (through && walk.transmittance < 0.05f) {
        if (u < 0.5f) walk.transmittance = 0.0f;
        if (u < 0.5f) exit = t;
        walk.transmittance *= 2.0f;
      }
      state = nextState(state);
      depth = -log(1.0f - unitFloat(mixBits(state)));
    }
  }
  countVolumeWalks(1u);
  countVolumeSteps(uint(walk.steps));
  return walk;
}
