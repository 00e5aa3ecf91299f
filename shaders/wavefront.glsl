// SPDX-License-Identifier: MIT
// Many paths per lane: the wavefront (docs/design/architecture.md). Each lane owns the pixels of a column of its tile.
// A round shades what the rays of the last one hit, ends and begins samples, then traces all rays in one loop that
// gives a lane its next ray as soon as the last one is done, so that no lane waits for the longest ray. What is done to
// some pixels only is a loop of its own over their bits: llvmpipe executes a branch that no lane takes, but not an
// iteration. Its loops are the steps of advance() (machine.glsl) one by one, in the same order for each pixel, so
// pictures are the same bits where a compiler keeps to the text.

/// Rows of a path.
const int kWaveRows = int(kPassingRows ? kPathRows : kPathRows - kPathPassingRows);

/// The lane's pixels, a bit each. One that is in none of hits, misses, rays and shadows has its samples.
struct Wave {
  int first;     // row of the states of the first
  ivec2 corner;  // the first, in the film
  uint hits;     // the ray has hit a surface, which is to be shaded
  uint misses;   // the ray has missed, the path has ended, or none has begun
  uint waiting;  // the path also waits for its shadow ray
  uint blocked;  // the shadow ray has hit something; while the path does not wait for it, something light may pass
  uint rays;     // the ray is to be traced
  uint shadows;
  // Iterations of loops, as llvmpipe counts them, which ends all of them at 65,535 (src/render/renderer.cpp): samples
  // that fall out so are never drawn.
  int steps;
  float cut;
};

int rowOf(Wave v, int k) { return v.first + k * kWaveRows; }

int numberOf(Wave v, int k) { return numberInTile(v.corner + ivec2(0, k)); }

uint keyOf(Wave v, int k) { return keyOfPixel(v.corner + ivec2(0, k)); }

/// Loads the distance up to which the shadow ray has passed surfaces.
Path loadShadowPast(Path p, int row) {
  p.traversal.tMin = uintBitsToFloat(readPathStates(row + kRowTMin).z);
  return p;
}

/// The path of pixel k, with what its shadow ray has let through.
Path takeUp(inout Wave v, int k) {
  Path p = loadPath(rowOf(v, k), keyOf(v, k));
  uint bit = 1u << k;
  bool waited = (v.waiting & bit) != 0u;
  bool arrives = waited && (v.blocked & bit) == 0u;
  vec3 light = p.connection.light;
  if (kDimsLate && arrives) {
    Path dimmed = loadShadowPast(loadShadow(p, rowOf(v, k)), rowOf(v, k));
    dimmed = dimShadow(dimmed, innermost(p.connection.medium), passedBefore(dimmed), dimmed.connection.limit);
    light = dimmed.connection.light;
    p.traversal.steps += dimmed.traversal.steps;
  }
  p.radiance += arrives ? light : vec3(0.0);
  p.rays += waited ? 1 : 0;
  if (waited) countShadowRay();
  v.waiting &= ~bit;
  v.blocked &= ~bit;
  return p;
}

/// Between loops: the next one reads what the last one has stored.
void settleStates() {
  memoryBarrierBuffer();
  memoryBarrierImage();
}

/// The first, short part of a traversal, which is the same for all rays: the triangles that the tree does not hold, and
/// the first step into the tree. It is done if the ray misses the tree.
Traversal beginRay(vec3 origin, vec3 direction, float limit, Traversal t, bool anyHit, TreeFrame tree) {
  if (kLargeFirst) t = meetLargeFirst(origin, direction, t, anyHit);
  return stepNode(t, treeRayOf(t, origin, direction, tree), limit, tree, isAtNode(t));
}

Traversal beginExtension(Path p, TreeFrame tree) {
  Traversal t = p.traversal;
  t.node = frame.leafCount == 0 ? kTraversalDone : 0;
  return beginRay(p.ray.origin, p.ray.direction, kFarAway, t, false, tree);
}

Traversal beginConnection(Path p, TreeFrame tree) {
  return beginRay(p.connection.origin, p.connection.direction, p.connection.limit, p.traversal, true, tree);
}

/// A ray has met a surface, or may be scattered by a medium: it is shaded.
bool isMeeting(Traversal t) { return t.slot >= 0 || kMedia; }

/// Notes what a shadow ray has met before the tree, and whether it is to be traced. Where light may pass what it has
/// met, it is done when that was asked, in the next round.
Wave sendShadow(Wave v, uint bit, int row, Traversal t) {
  bool done = isDone(t) && (t.slot < 0 || isStopped(t));
  v.shadows |= done ? 0u : bit;
  v.blocked |= done && t.slot >= 0 ? bit : 0u;
  if (kPassing) {
    pathStates[row + kRowShadowHit] = metBy(t);
    pathStates[row + kRowTMin].zw = uvec2(floatBitsToUint(t.tMin), uint(t.tMinSlot));
  }
  return v;
}

Wave sendRay(Wave v, uint bit, Traversal t) {
  bool done = isDone(t);
  v.rays |= done ? 0u : bit;
  v.hits |= done && isMeeting(t) ? bit : 0u;
  v.misses |= done && !isMeeting(t) ? bit : 0u;
  return v;
}

/// Shadow rays that have met a surface that may let light pass continue behind it where it does; what their paths do
/// next waits for them.
Wave passShadows(Wave v, uint left, TreeFrame tree) {
  for (; left != 0u; left &= left - 1u) {
    int k = findLSB(left);
    int row = rowOf(v, k);
    v.steps += 1;
    Path p = loadShadow(loadPath(row, keyOf(v, k)), row);
    if (kDimsLate) p = loadShadowPast(p, row);
    p.phase = kPhaseConnect;
    p = connect(p);
    if (kThroughGlass || kDimsLate) pathStates[row + kRowContribution].xyz = floatBitsToUint(p.connection.light);
    if (kDimsLate) pathStates[row + kRowInstances].w = p.connection.medium;
    uint bit = 1u << k;
    v.waiting |= bit;
    if (p.phase == kPhaseConnect) {
      pathStates[row + kRowCounts].y += 1u;
      countShadowRay();
      v.blocked &= ~bit;
      v = sendShadow(v, bit, row, beginConnection(p, tree));
    }
    keepWork(numberOf(v, k));
  }
  return v;
}

/// Shades the points that rays have hit.
Wave shadeHits(Wave v, uint left, TreeFrame tree) {
  for (; left != 0u; left &= left - 1u) {
    int k = findLSB(left);
    uint bit = 1u << k;
    int row = rowOf(v, k);
    // Searches in tables of lights are not counted, except for candidates: they take one or two iterations, and lanes
    // shade together.
    v.steps += 1 + kCandidateIterations;
    Path p = takeUp(v, k);
    p.rays += 1;
    countRay(p);
    p.pixel = v.corner + ivec2(0, k);
    p = kMedia ? meet(p) : hit(p);
    bool shadow = kShadows && p.phase == kPhaseConnect;
    Traversal s = p.traversal;
    p.phase = p.next;
    v.cut += cutThroughput(p);
    bool goesOn = p.phase <= kPhasePass;
    if (goesOn) p = extend(p);
    v.steps += p.traversal.steps;
    Traversal t = p.traversal;
    if (goesOn) t = beginExtension(p, tree);
    p.traversal = t;
    savePath(withHit(p, t), row, false);
    if (goesOn) v = sendRay(v, bit, t);
    if (!goesOn) v.misses |= bit;
    if (shadow) {
      p.traversal = s;
      v.waiting |= bit;
      v = sendShadow(v, bit, row, beginConnection(p, tree));
    }
    keepWork(numberOf(v, k));
  }
  return v;
}

/// Ends the samples whose rays have met nothing, or whose paths have ended, and begins the next ones. What ends in the
/// surroundings at once goes no farther than here.
Wave beginSamples(Wave v, uint left, TreeFrame tree) {
  const int most = 64;  // samples of a round that end in the surroundings at once
  bool more = false;
  int k = 0;
  int samples = 0;
  ivec2 pixel = v.corner;
  FilmPixel film = loadFilm(pixel);
  Path p = loadPath(v.first, 0u);
  while (left != 0u || more) {
    v.steps += 1;
    if (!more) {
      k = findLSB(left);
      left &= left - 1u;
      pixel = v.corner + ivec2(0, k);
      film = loadFilm(pixel);
      p = takeUp(v, k);
    }
    if (p.phase == kPhaseExtend) {
      countRay(p);
      p = miss(p);
      p.phase = kPhaseEnd;
      p.rays += 1;
    }
    bool another = p.phase != kPhaseNone && hasMoreRays(p);
    if (p.phase != kPhaseNone && !another) {
      film = endSample(film, p, pixel);
      p.phase = kPhaseNone;
    }
    more = false;
    uint bit = 1u << k;
    int row = rowOf(v, k);
    if (another || film.samples < samplesWanted(film)) {
      if (!another) beginWork(numberOf(v, k));
      p = another ? nextRay(p, pixel, film.samples) : beginPath(pixel, film.samples, 0);
      p = extend(p);
      v.steps += p.traversal.steps;
      Traversal t = beginExtension(p, tree);
      samples += 1;
      more = isDone(t) && !isMeeting(t) && samples < most;
      if (!more) {
        p.traversal = t;
        savePath(withHit(p, t), row, !(kPassesLight && frame.cameraSolids != kPrimitiveNone));
        v = sendRay(v, bit, t);
      }
    }
    if (!more) storeFilm(pixel, film);
    if (!more) keepWork(numberOf(v, k));
  }
  return v;
}

/// Keeps what a ray has hit once its traversal is done.
Wave settleRay(Wave v, Traversal t, int current, bool isShadow) {
  uint bit = 1u << current;
  int row = rowOf(v, current);
  bool met = t.slot >= 0;
  v.blocked |= isShadow && met ? bit : 0u;
  if (kPassing) v.waiting &= ~(isShadow && met && !isStopped(t) ? bit : 0u);
  v.hits |= !isShadow && isMeeting(t) ? bit : 0u;
  v.misses |= !isShadow && !isMeeting(t) ? bit : 0u;
  if (kPassing || !isShadow) {
    pathStates[row + (isShadow ? kRowShadowHit : kRowHit)] = metBy(t);
    if (kInstances) {
      if (isShadow) pathStates[row + kRowInstances].y = uint(t.hitInstance);
      if (!isShadow) pathStates[row + kRowContribution].w = uint(t.hitInstance);
    }
  }
  return v;
}

/// Traces all rays, except for those that the step budget leaves over. A lane whose ray is done takes its next one.
Wave traceRays(Wave v, int budget, TreeFrame tree) {
  Traversal t = startTraversal(0.0, 0);
  TreeRay ray = makeTreeRay(vec3(0.0), vec3(1.0), 0.0);
  vec3 origin = vec3(0.0);
  vec3 direction = vec3(1.0);
  float limit = 0.0;
  int current = 0;
  bool isShadow = false;
  while ((!isDone(t) || (v.rays | v.shadows) != 0u) && v.steps < budget) {
    if (isDone(t)) {
      isShadow = v.rays == 0u;
      current = findLSB(isShadow ? v.shadows : v.rays);
      v.rays = isShadow ? 0u : v.rays & (v.rays - 1u);
      v.shadows = isShadow ? v.shadows & (v.shadows - 1u) : v.shadows;
      int row = rowOf(v, current);
      vec4 a = uintBitsToFloat(readPathStates(row + (isShadow ? kRowShadow : kRowRay)));
      origin = a.xyz;
      direction = uintBitsToFloat(readPathStates(row + (isShadow ? kRowShadowDirection : kRowDirection))).xyz;
      limit = isShadow ? a.w : kFarAway;
      if (kMedia && !isShadow) limit = uintBitsToFloat(readPathStates(row + kRowHit).x);
      t = startTraversal(limit, frame.leafCount);
      t.tie = isShadow ? 0.0 : a.w;
      t.extends = !isShadow;
      if (kTestsAlpha) {
        uvec4 counts = readPathStates(row + kRowCounts);
        t.chances = chancesOf(makeSampler(keyOf(v, current), counts.x), bounceIn(counts.z));
      }
      if (kPassing) {
        uvec4 tMins = readPathStates(row + kRowTMin);
        t.tMin = uintBitsToFloat(isShadow ? tMins.z : tMins.x);
        t.tMinSlot = int(isShadow ? tMins.w : tMins.y);
      }
      if (kLargeFirst) {
        // A shadow ray that has met something before the tree comes here only where that may let light pass.
        uvec4 known = readPathStates(row + (kPassing && isShadow ? kRowShadowHit : kRowHit));
        bool use = kPassing || !isShadow;
        t.t = use ? uintBitsToFloat(known.x) : t.t;
        t.slot = use ? int(known.y) : -1;
        if (kWeights) t.weights = use ? uintBitsToFloat(known.zw) : vec2(0.0);
      }
      ray = treeRayOf(t, origin, direction, tree);
    }
    // Three node steps between two leaves. They are no loop, which would be three iterations.
    t = stepNode(t, ray, limit, tree, isAtNode(t));
    t = stepNode(t, ray, limit, tree, isAtNode(t));
    t = stepNode(t, ray, limit, tree, isAtNode(t));
    if (kInstances && changesSpace(t)) {
      t = changeSpace(t);
      ray = treeRayOf(t, origin, direction, tree);
    } else if (t.leaves >= kFirstChild) {
      t = meetLeaf(t, ray, origin, direction, isShadow);
    }
    v.steps += 1;
    if (isDone(t)) v = settleRay(v, t, current, isShadow);
    if (isDone(t)) keepWork(numberOf(v, current));
  }
  if (!isDone(t)) v.rays |= 1u << current;
  return v;
}

/// The samples of these pixels begin again.
Wave beginAnew(Wave v, uint left) {
  v.hits &= ~left;
  v.misses |= left;
  v.rays &= ~left;
  v.shadows &= ~left;
  v.waiting &= ~left;
  v.blocked &= ~left;
  for (; left != 0u; left &= left - 1u) {
    int row = rowOf(v, findLSB(left));
    v.steps += 1;
    beginWork(numberOf(v, findLSB(left)));
    pathStates[row + kRowRadiance] = uvec4(0u, 0u, 0u, uint(kPhaseNone));
    pathStates[row + kRowCounts] = uvec4(0u);
  }
  return v;
}

/// Advances the pixels of one lane (in rows from lane.y x kWaveSlots of the tile on) until they have the samples wanted
/// or the step budget of this draw is used.
void traceWave(ivec2 lane) {
  Wave v;
  v.corner = tileOfDraw().xy + ivec2(lane.x, lane.y * int(kWaveSlots));
  fetchFrame(loadFilm(v.corner).flags);
  int own = (lane.y * frame.tile.z + lane.x) * int(kWaveLaneRows);  // the lane's first row; it holds masks
  v.first = own + 1;
  int count = min(int(kWaveSlots), frame.tile.w - lane.y * int(kWaveSlots));
  int budget = frame.stepBudget;
  TreeFrame tree = treeFrame();
  uvec4 kept = frame.tileGoesOn == 0 ? uvec4(0u) : pathStates[own];
  v.hits = kept.x;
  v.misses = kept.y;
  v.waiting = kept.z;
  v.blocked = kept.w;
  v.rays = 0u;
  v.shadows = 0u;
  v.steps = 0;
  v.cut = 0.0;
  forgetWork();
  if (frame.tileGoesOn == 0) v = beginAnew(v, count < 32 ? (1u << count) - 1u : 0xffffffffu);
  bool advanced = false;

  // A round begins only where half of the budget is left, so that only rays that are longer than that are lost.
  while ((v.hits | v.misses) != 0u && v.steps < budget / 2) {
    settleStates();
    if (kPassing) {
      v = passShadows(v, v.blocked & ~v.waiting, tree);
      settleStates();
    }
    uint later = v.shadows;
    uint hits = v.hits & ~later;
    v.hits &= later;
    v = shadeHits(v, hits, tree);
    settleStates();
    uint misses = v.misses & ~v.shadows;
    // Shadow rays that were settled before the tree leave nothing to wait for.
    v.misses &= v.shadows;
    v = beginSamples(v, misses, tree);
    settleStates();
    v = traceRays(v, budget, tree);
    v.steps += 6;  // the round, and the first iteration of each of the five loops in it, which all lanes take
    uint lost = v.rays | v.shadows;
    advanced = advanced || lost == 0u;
    v = beginAnew(v, lost);
  }
  pathStates[own] = uvec4(v.hits, v.misses, v.waiting, v.blocked);
  if ((v.hits | v.misses) != 0u) {
    atomicAdd(progress.unfinished, 1u);
    if (!advanced) atomicAdd(progress.stuck, 1u);
  }
  if (kScatters) reportCut(v.cut);
}
