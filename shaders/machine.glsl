// SPDX-License-Identifier: MIT
// The path machine: a path goes from phase to phase until it ends. The integrator (integrators/) says what happens at
// begin, hit, miss and connected.
//
//   phase    what advance() does                                               next phase
//   begin    starts to trace the ray that the path has                         extend
//   pass     starts to trace the same ray behind the surface that it has met   extend
//   extend   traverse() looks for the nearest hit                              meet, once it is done
//   meet     intercept(), hit() or miss() add light, and may set up            connect with a shadow ray, else p.next
//            a shadow ray and the next ray
//   connect  traverse() looks for anything on the shadow ray;                  p.next
//            nothing: connected() adds the light sample
//   end      record() adds the path to the film (trace.glsl)
//
// A round of a path is an extension, what it meets, and a connection. On GPUs it is one ray of either kind, so that
// there is one traversal: a second one takes registers (docs/measurements/gpu.md).

/// Rays are traced from end to end: what the budget ends begins its sample again in the next draw, and no traversal is
/// kept from round to round.
const bool kWholeRays = kGi && !kPassing && !kResumable && kDrawsLight && !kLightPart;

/// Starts a traversal behind the surface that the ray has met at distance t, and passes.
Path beginBehind(Path p, float limit, float t, int slot) {
  countSurfacesPassed(1u);
  p = beginTraversal(p, limit);
  p.traversal.tMin = t;
  p.traversal.tMinSlot = slot;
  return p;
}

/// Starts to trace the path's ray, up to the end of its flight in a medium.
Path extend(Path p) {
  bool passes = kPassing && p.phase == kPhasePass;
  if (passes) p = beginBehind(p, kFarAway, p.hit.t, p.hit.slot);
  if (!passes) p = beginTraversal(p, kFarAway);
  p.traversal.tie = p.ray.tie;
  p.traversal.extends = true;
  p.traversal.both = true;
  if (kMedia && !(passes && p.eye.caught)) p = limitFlight(p, passes ? p.hit.t : 0.0);
  p.phase = kPhaseExtend;
  return p;
}

/// Traces the path's ray, or its shadow ray, as far as the budget lets it.
Path traced(Path p, bool connects, int budget, TreeFrame tree) {
  if (kTestsAlpha) p = withChances(p);
  bool ofConnection = connects && !kGpu;  // on GPUs swapRays() has put it into p.ray
  vec3 origin = ofConnection ? p.connection.origin : p.ray.origin;
  vec3 direction = ofConnection ? p.connection.direction : p.ray.direction;
  float limit = connects ? p.connection.limit : kFarAway;
  p.traversal = traverse(origin, direction, limit, p.traversal, tree, budget, connects);
  return p;
}

/// The path's ray has been traced: something stops it before its hit, or it hits a surface, or nothing.
Path meet(Path p) {
  p.phase = kPhaseMeet;
  p.next = kPhaseEnd;
  float t = interceptedAt(p);
  if (t < kFarAway) {
    p = intercept(p, t);
  } else if (p.hit.slot < 0) {
    p = miss(p);
  } else {
    p = hit(p);
  }
  if (p.phase == kPhaseMeet) p.phase = p.next;
  return p;
}

/// The share of the connection's light that the surface on its shadow ray lets pass, which may be none.
vec3 passed(Path p, Surface s) {
  vec3 baseColor = vec3(baseColorAt(s.material, s.texcoords, s.color));
  vec3 share = vec3(0.0);
  if (kThroughGlass && p.connection.throughGlass) share = lightThrough(s, baseColor, p.connection.direction);
  if (kClearShadows && p.eye.caught) share = clearThrough(s, baseColor, p.connection.direction);
  return share;
}

/// The shadow ray has been traced. One that has met glass may continue behind it; else the path does.
Path connect(Path p) {
  int slot = p.traversal.slot;
  bool passes = false;
  if (kPassing && slot >= 0 && slot != kOpaqueSlot) {
    countShadowSurfaces(1u);
    Surface s = surfaceAt(slot, p.traversal.hitInstance, p.connection.origin, p.connection.direction, p.traversal.t,
                          p.traversal.weights, p.time);
    p.connection.light *= passed(p, s);
    passes = maxComponent(abs(p.connection.light)) > 0.0;
    if (kDimsLate && passes) {
      p = dimShadow(p, solidBefore(p.connection.medium, s, false), passedBefore(p), p.traversal.t);
      if (isSolid(s.material)) p.connection.medium = behindBoundary(p.connection.medium, s);
    }
  }
  if (kPassing && passes) return beginBehind(p, p.connection.limit, p.traversal.t, slot);
  if (kDimsLate && slot < 0) p = dimShadow(p, innermost(p.connection.medium), passedBefore(p), p.connection.limit);
  if (slot < 0) p = connected(p);
  if (kClearShadows && p.eye.caught) p.connection.light = vec3(1.0);
  p.phase = p.next;
  return p;
}

/// The shadow ray has been traced, as far as the budget lets it.
Path connectTraced(Path p) {
  if (!isDone(p.traversal)) return p;
  p.rays += 1;
  countShadowRay();
  if (kGpu) p = swapRays(p);
  p = connect(p);
  if (kGpu && p.phase == kPhaseConnect) p = swapRays(p);
  return p;
}

/// One round of a path. A traversal that the budget ends leaves it in its phase.
Path advance(Path p, int budget, TreeFrame tree) {
  p.traversal.steps += 1;
  bool connects = kGpu && kShadows && p.phase == kPhaseConnect;
  // Only light paths may have ended before their first ray.
  bool begins = kWholeRays && !kLightPaths ? !connects : p.phase <= kPhasePass;
  if (begins) p = extend(p);
  if (kGpu && kWholeRays && connects) p = beginTraversal(p, p.connection.limit);
  if (p.phase == kPhaseExtend || connects) {
    p = traced(p, connects, budget, tree);
    // A shadow ray or one that is not done leaves its hit, too: that of the ray before then needs no registers.
    if (kWholeRays) p = withHit(p, p.traversal);
    if (!connects && isDone(p.traversal)) {
      p.rays += 1;
      countRay(p);
      if (!kWholeRays) p = withHit(p, p.traversal);
      p.phase = kPhaseMeet;
    }
  }
  if (kGpu && connects) p = connectTraced(p);
  if (p.phase == kPhaseMeet) {
    p = meet(p);
    if (kGpu && kShadows && p.phase == kPhaseConnect) p = swapRays(p);
    p.traversal.steps += kCandidateIterations / 3;  // a step is three
  }
  if (!kGpu && kShadows && p.phase == kPhaseConnect) p = connectTraced(traced(p, true, budget, tree));
  return p;
}
