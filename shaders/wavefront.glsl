// SPDX-License-Identifier: MIT
// Many paths a lane: the wavefront (docs/architecture.md). Each lane owns the pixels of a column of its tile. A round shades the paths of all of them, one after
// the other; then one loop traces all their rays and gives a lane its next ray as soon as the last one is done, so that no lane waits for the longest ray.
// Shading and traversal are those of the megakernel, in the same order for each pixel, so pictures are the same bits where a compiler keeps to the text.

const int kPhaseNone = 5;      // no path: the pixel has its samples, or its next one is to begin
const int kWaveNodeSteps = 6;  // node steps between two leaves: 4 and 10 were slower
const bool kLastWaveRows = kShadows || kPassesLight || kInstances;

struct WavePath {
  Path path;
  int rays;      // that the path has traced
  bool waiting;  // its shadow ray is being traced
  bool ended;    // the path before it has ended: radiance, alpha, rays and shadow ray are still that one's
};

void saveWave(WavePath w, int row) {
  Path p = w.path;
  uint flags = uint(p.phase) | (w.waiting ? 8u : 0u) | (p.cameraRay ? 16u : 0u) | (p.oneChannel ? 32u : 0u) | (p.alpha > 0.0 ? 64u : 0u) | (w.ended ? 128u : 0u);
  pathStates[row] = uvec4(floatBitsToUint(p.origin), floatBitsToUint(p.tie));
  pathStates[row + 1] = uvec4(floatBitsToUint(p.direction), p.medium);
  pathStates[row + 2] = uvec4(floatBitsToUint(p.hitT), uint(p.hitSlot), floatBitsToUint(p.hitWeights));
  pathStates[row + 3] = uvec4(floatBitsToUint(p.throughput), floatBitsToUint(p.density));
  pathStates[row + 4] = uvec4(floatBitsToUint(p.radiance), flags);
  pathStates[row + 5] = uvec4(p.numbers.index, uint(w.rays), uint(p.bounce), uint(p.clear));
  if (kLastWaveRows) {
    pathStates[row + 6] = uvec4(floatBitsToUint(p.shadowOrigin), floatBitsToUint(p.shadowLimit));
    pathStates[row + 7] = uvec4(floatBitsToUint(p.shadowDirection), floatBitsToUint(p.compression));
    pathStates[row + 8] = uvec4(floatBitsToUint(p.contribution), uint(p.hitInstance));
  }
}

/// A row of the states, which saveWave has written: by an image unit that the scene leaves free where there is one, since llvmpipe reads those five times as fast.
layout(rgba32ui, binding = kWaveUnit) uniform readonly uimageBuffer waveStates;
uvec4 readWave(int row) {
  if (kWaveImage) return imageLoad(waveStates, row);
  return pathStates[row];
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
  a = readWave(row + 2);
  p.hitT = uintBitsToFloat(a.x);
  p.hitSlot = int(a.y);
  p.hitWeights = uintBitsToFloat(a.zw);
  f = uintBitsToFloat(readWave(row + 3));
  p.throughput = f.xyz;
  p.density = f.w;
  a = readWave(row + 4);
  p.radiance = uintBitsToFloat(a.xyz);
  p.phase = int(a.w & 7u);
  w.waiting = (a.w & 8u) != 0u;
  p.cameraRay = (a.w & 16u) != 0u;
  p.oneChannel = (a.w & 32u) != 0u;
  p.alpha = (a.w & 64u) != 0u ? 1.0 : 0.0;
  w.ended = (a.w & 128u) != 0u;
  a = readWave(row + 5);
  p.numbers = makeSampler(key, a.x);
  w.rays = int(a.y);
  p.bounce = int(a.z);
  p.clear = int(a.w);
  p.shadowOrigin = vec3(0.0);
  p.shadowLimit = 0.0;
  p.shadowDirection = vec3(0.0, 0.0, 1.0);
  p.compression = 1.0;
  p.contribution = vec3(0.0);
  p.hitInstance = -1;
  if (kLastWaveRows) {
    p.compression = uintBitsToFloat(readWave(row + 7).w);
    a = readWave(row + 8);
    p.contribution = uintBitsToFloat(a.xyz);
    p.hitInstance = int(a.w);
  }
  p.after = kPhaseEnd;
  p.lightSlot = 0;
  p.crossings = 0;
  p.traversal = startTraversal(kFarAway, frame.limits.w);
  w.path = p;
  return w;
}

/// What is short and the same for all rays: the triangles that the tree does not hold, and the first step into the tree. Done: the ray misses the tree.
Traversal beginRay(vec3 origin, vec3 direction, float limit, float tie, bool anyHit, TreeFrame tree) {
  Traversal t = beginTraversal(limit, true, 0);
  if (kCreases) t.tie = tie;
  if (kLargeFirst) {
    t = traverseLiterals(origin, direction, t, anyHit);
    if (anyHit && t.slot >= 0) t.node = kTraversalDone;
  }
  return stepNode(t, treeRayOf(t, origin, direction, tree), limit, tree, t.node >= 0);
}

/// Advances the pixels of one lane (in rows from lane.y x kWaveSlots of the tile on) until they have the samples wanted or the step budget of this draw is used.
void traceWave(ivec2 lane) {
  ivec2 corner = frameBlock.tile.xy + ivec2(lane.x, lane.y * int(kWaveSlots));
  if (loadFilm(corner).flags != 0xffffffffu) frame = frameBlock;
  int count = min(int(kWaveSlots), frame.tile.w - lane.y * int(kWaveSlots));
  int last = (lane.y * frame.tile.z + lane.x) * int(kWaveLaneRows);  // what is left of the lane's own
  int first = last + 1;
  int budget = frame.limits.z;
  TreeFrame tree = treeFrame();
  uint open = count < 32 ? (1u << count) - 1u : 0xffffffffu;
  uint blocked = 0u;  // of the shadow rays of the last round
  int steps = count;
  float cut = 0.0;
  bool advanced = false;
  if (frame.sampling.z == 0) {
    for (int k = 0; k < count; ++k) pathStates[first + k * int(kWaveRows) + 4] = uvec4(0u, 0u, 0u, uint(kPhaseNone));
  } else {
    blocked = pathStates[last].x;
  }

  // A round begins only where half of the budget is left, so that only rays that are longer than that are lost.
  while (open != 0u && steps < budget / 2) {
    memoryBarrierBuffer();
    memoryBarrierImage();
    // Step: shade what the rays of the last round met, and begin paths where one has ended.
    uint rays = 0u;
    uint shadows = 0u;
    uint blockedNext = 0u;
    for (uint left = open; left != 0u; left &= left - 1u) {
      int k = findLSB(left);
      uint bit = 1u << k;
      steps += 1;
      ivec2 pixel = corner + ivec2(0, k);
      uint key = pixelKey(uint(pixel.x), uint(frame.picture.y - 1 - pixel.y), uint(frame.picture.w));
      int row = first + k * int(kWaveRows);
      WavePath w = loadWave(row, key);
      Path p = w.path;
      if (w.waiting) {
        p.radiance += (blocked & bit) == 0u ? p.contribution : vec3(0.0);
        w.rays += 1;
      }
      FilmPixel film = loadFilm(pixel);
      if (w.ended) {
        film = addSample(film, p.radiance, p.alpha);
        film.rays += uint(w.rays);
        storeFilm(pixel, film);
        p.radiance = vec3(0.0);
        p.alpha = 0.0;
        w.rays = 0;
      }
      bool shadow = false;
      if (p.phase == kPhaseExtend) {
        w.rays += 1;
        if (p.hitSlot < 0) {
          p = meetSurroundings(p);
        } else {
          p = shade(p);
        }
        shadow = p.phase == kPhaseShadow;
        p.phase = shadow ? p.after : p.phase;
      }
      w.ended = p.phase == kPhaseEnd || p.phase == kPhaseCut;
      if (p.phase != kPhaseExtend) {
        if (w.ended) cut += cutThroughput(p);
        // The next path begins while the last shadow ray of this one is traced.
        uint next = film.samples + (w.ended ? 1u : 0u);
        bool wanted = next < samplesWanted(film);
        Path last = p;
        if (wanted) p = startPath(pixel, key, next + uint(frame.sampling.x), 0);
        p.phase = wanted ? kPhaseExtend : kPhaseNone;
        p.radiance = last.radiance;
        p.alpha = last.alpha;
        p.contribution = last.contribution;
        p.shadowOrigin = last.shadowOrigin;
        p.shadowDirection = last.shadowDirection;
        p.shadowLimit = last.shadowLimit;
        open = p.phase == kPhaseNone && !w.ended ? open & ~bit : open;
      }
      if (p.phase == kPhaseExtend) {
        Traversal t = beginRay(p.origin, p.direction, kFarAway, p.tie, false, tree);
        p.hitT = t.t;
        p.hitSlot = t.slot;
        p.hitInstance = -1;
        p.hitWeights = t.weights;
        rays |= t.node != kTraversalDone ? bit : 0u;
      }
      if (kShadows && shadow) {
        Traversal t = beginRay(p.shadowOrigin, p.shadowDirection, p.shadowLimit, 0.0, true, tree);
        shadows |= t.node != kTraversalDone ? bit : 0u;
        blockedNext |= t.slot < 0 ? 0u : bit;
      }
      w.waiting = shadow;
      w.path = p;
      saveWave(w, row);
    }
    blocked = blockedNext;
    steps += 2;

    memoryBarrierBuffer();
    memoryBarrierImage();

    // Step: trace all rays. A lane whose ray is done takes its next one.
    Traversal t = beginTraversal(0.0, false, 0);
    TreeRay ray = makeTreeRay(vec3(0.0), vec3(1.0), 0.0, tree.origin, tree.cell);
    vec3 origin = vec3(0.0);
    vec3 direction = vec3(1.0);
    float limit = 0.0;
    int current = -1;
    bool isShadow = false;
    while ((t.node != kTraversalDone || (rays | shadows) != 0u) && steps < budget) {
      if (t.node == kTraversalDone) {
        isShadow = rays == 0u;
        current = findLSB(isShadow ? shadows : rays);
        rays = isShadow ? 0u : rays & (rays - 1u);
        shadows = isShadow ? shadows & (shadows - 1u) : shadows;
        int row = first + current * int(kWaveRows);
        vec4 a = uintBitsToFloat(readWave(row + (isShadow ? 6 : 0)));
        origin = a.xyz;
        direction = uintBitsToFloat(readWave(row + (isShadow ? 7 : 1))).xyz;
        limit = isShadow ? a.w : kFarAway;
        t = beginTraversal(limit, true, 0);
        if (kCreases) t.tie = isShadow ? 0.0 : a.w;
        if (kLargeFirst) {
          uvec4 known = readWave(row + 2);
          t.t = isShadow ? t.t : uintBitsToFloat(known.x);
          t.slot = isShadow ? -1 : int(known.y);
          if (kWeights) t.weights = isShadow ? vec2(0.0) : uintBitsToFloat(known.zw);
        }
        ray = treeRayOf(t, origin, direction, tree);
      }
      for (int i = 0; i < kWaveNodeSteps; ++i) t = stepNode(t, ray, limit, tree, t.node >= 0);
      bool atLeaf = t.node < 0 && t.node != kTraversalDone;
      if (kInstances && atLeaf && ~t.node >= kInstanceLeaf) {
        t = changeSpace(t);
        ray = treeRayOf(t, origin, direction, tree);
        atLeaf = false;
      }
      if (atLeaf) t = meetLeaf(t, ray, isShadow);
      steps += 1;
      if (t.node == kTraversalDone) {
        uint bit = 1u << current;
        int row = first + current * int(kWaveRows);
        if (isShadow) {
          blocked |= t.slot >= 0 ? bit : 0u;
        } else {
          pathStates[row + 2] = uvec4(floatBitsToUint(t.t), uint(t.slot), floatBitsToUint(t.weights));
          if (kInstances) pathStates[row + 8].w = uint(t.hitInstance);
        }
      }
    }
    // Rays that the budget left over: their samples begin anew in the next draw.
    uint lost = rays | shadows | (t.node != kTraversalDone ? 1u << current : 0u);
    advanced = advanced || lost == 0u;
    while (lost != 0u) {
      int row = first + findLSB(lost) * int(kWaveRows);
      pathStates[row + 4] = uvec4(0u, 0u, 0u, uint(kPhaseNone));
      pathStates[row + 5] = uvec4(0u);
      lost &= lost - 1u;
    }
  }
  if (open != 0u) {
    atomicAdd(progress.unfinished, 1u);
    if (!advanced) atomicAdd(progress.stuck, 1u);
    pathStates[last].x = blocked;
  }
  if (kScatters) reportCut(cut);
}
