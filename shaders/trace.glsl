// SPDX-License-Identifier: MIT
// The tracer: what both entries (fragment and compute) include and call.
#include "layout.glsl"
layout(std140, binding = kFrameBinding) uniform FrameBlock { Frame frameBlock; };
// The block once more as a variable: llvmpipe reads a uniform lane by lane, so each is read once a draw.
Frame frame = Frame(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0),
                    ivec4(0), ivec4(0), ivec4(0), ivec4(0), ivec4(0), vec4(0.0), vec4(0.0),
                    vec4(0.0));
layout(std430, binding = kProgressBinding) restrict buffer ProgressBlock { Progress progress; };
#include "read.glsl"
#include "random.glsl"
#include "sampling.glsl"
#include "luminance.glsl"
#include "pixel_filter.glsl"
#include "camera.glsl"
#include "intersect.glsl"
#include "slab.glsl"
#include "stack.glsl"
#include "tree.glsl"
#include "traverse.glsl"
#include "texture.glsl"
#include "material.glsl"
#include "perlin.glsl"
#include "fresnel.glsl"
#include "surface.glsl"
#include "ggx.glsl"
#include "energy.glsl"
#include "iridescence.glsl"
#include "sheen.glsl"
#include "bsdf.glsl"
#include "layers.glsl"
#include "material_layers.glsl"
#include "phong.glsl"
#include "environment.glsl"
#include "lights.glsl"
#include "film_pixel.glsl"
#include "film.glsl"
#include "path_state.glsl"
#include "path_rows.glsl"
#include "path.glsl"
#include "reuse/candidates.glsl"
#include "reuse/reservoir.glsl"
#include "reuse/neighbours.glsl"
#include "caustics/emit.glsl"
#include "shade.glsl"
#include "catcher.glsl"

/// Each round of the loop is one ray of a path, its shading and its shadow ray, without the phases of a path that can
/// be suspended.
const bool kDirect = kGi && !kPassing && !kResumable && kFeature == kFeatureNone;

Traversal beginTraversal(float limit, bool wanted, int steps) {
  Traversal t = startTraversal(limit, frame.limits.w);
  t.steps = steps;
  if (!wanted) t.node = kTraversalDone;
  return t;
}

/// A pixel may want fewer samples than the draw brings (Film::setTargets).
uint samplesWanted(FilmPixel film) {
  uint own = film.flags >> kPixelTargetShift;
  return own > 0u ? min(own, uint(frame.picture.z)) : uint(frame.picture.z);
}

/// A pixel on its way: what the loops below advance.
struct PixelTrace {
  FilmPixel film;
  Path path;
  bool tracing;  // a sample is under way
  float cut;     // what kBounces took of the throughput
};

/// What stays the same meanwhile.
struct PixelTask {
  ivec2 pixel;  // y from the bottom
  uint key;     // of its random numbers
  uint wanted;  // samples
  int budget;   // traversal steps in this draw
};

PixelTrace beginSample(PixelTrace t, PixelTask task) {
  uint index = t.film.samples + uint(frame.sampling.x);
  if (kLightPaths) t.path = startLightPath(recordOf(task.pixel, t.film.samples), task.key, t.path.traversal.steps);
  if (!kLightPaths) t.path = startPath(task.pixel, task.key, index, t.path.traversal.steps);
  t.tracing = true;
  return t;
}

PixelTrace endSample(PixelTrace t, PixelTask task) {
  t.cut += cutThroughput(t.path);
  t.film.rays += uint(t.path.rays);
  if (kShadowCatcher) t.path = showShadow(t.path);
  if (kLightPaths) {
    storeRecord(recordOf(task.pixel, t.film.samples), t.path.radiance, t.path.part.xy);
    t.film.samples += 1u;
  } else if (kLightRecords) {
    t.film.samples += 1u;
  } else if (kFeature == kFeatureGuides) {
    t.film = addGuides(t.film, t.path.radiance, t.path.contribution, t.path.shadowLimit, t.path.alpha);
  } else {
    t.film = addSample(t.film, t.path.radiance, t.path.alpha);
  }
  return t;
}

/// Whole rays only: a traversal that the budget ends begins its sample anew in the next draw.
PixelTrace traceDirect(PixelTrace t, PixelTask task, TreeFrame tree) {
  while (t.path.traversal.steps < task.budget) {
    if (!t.tracing) {
      if (t.film.samples >= task.wanted) break;
      t = beginSample(t, task);
      if (kLightPaths && t.path.phase == kPhaseEnd) {
        t = endSample(t, task);
        t.tracing = false;
        continue;
      }
    }
    // Step: find what the ray hits.
    Traversal hit = beginTraversal(kFarAway, true, t.path.traversal.steps + 1);
    if (kCreases) hit.tie = t.path.tie;
    if (kLightPaths) hit.both = true;
    hit = traverse(t.path.origin, t.path.direction, kFarAway, hit, tree, task.budget, false);
    t.path.traversal.steps = hit.steps;
    if (hit.node != kTraversalDone) break;
    t.path.rays += 1;

    // Step: shade it.
    if (kShadowCatcher && meetsCatcher(t.path, hit.slot < 0 ? kFarAway : hit.t)) {
      t.path = meetCatcher(withHit(t.path, hit));
    } else if (hit.slot < 0) {
      t.path = meetSurroundings(t.path);
    } else {
      t.path = withHit(t.path, hit);
      t.path = shade(t.path);
    }
    t.path.traversal.steps = hit.steps + kCandidateSteps;

    // Step: is the light seen? Literals are tested for lanes without a shadow ray, too: a branch would save nothing.
    if (kShadows) {
      bool waiting = t.path.phase == kPhaseShadow;
      Traversal shadow = beginTraversal(t.path.shadowLimit, waiting, t.path.traversal.steps);
      shadow =
          traverse(t.path.shadowOrigin, t.path.shadowDirection, t.path.shadowLimit, shadow, tree, task.budget, true);
      t.path.traversal.steps = shadow.steps;
      if (waiting && shadow.node != kTraversalDone) break;
      t.path.rays += waiting ? 1 : 0;
      t.path.radiance += waiting && shadow.slot < 0 ? t.path.contribution : vec3(0.0);
      t.path.phase = waiting ? t.path.after : t.path.phase;
    }
    t.tracing = t.path.phase == kPhaseExtend;
    if (!t.tracing) t = endSample(t, task);
  }
  return t;
}

/// In phases, between which a path can be suspended, and for what a ray alone does not decide: holes, guides, heat
/// maps.
PixelTrace tracePhases(PixelTrace t, PixelTask task, TreeFrame tree) {
  while (t.path.traversal.steps < task.budget) {
    if (!t.tracing) {
      if (t.film.samples >= task.wanted) break;
      t = beginSample(t, task);
    }
    t.path.traversal.steps += 1;

    // Step: find what the path's ray hits.
    if (t.path.phase == kPhaseExtend) {
      t.path.traversal =
          traverse(t.path.origin, t.path.direction, kFarAway, t.path.traversal, tree, task.budget, false);
      if (t.path.traversal.node == kTraversalDone) {
        t.path.rays += 1;
        t.path = withHit(t.path, t.path.traversal);
        t.path.phase = kPhaseShade;
      }
    }

    // Step: shade it; this may need a shadow ray.
    if (kHeatmap) {
      if (t.path.phase == kPhaseShade) t.path.phase = kPhaseEnd;
    } else if (t.path.phase == kPhaseShade) {
      if (kShadowCatcher && meetsCatcher(t.path, t.path.hitSlot < 0 ? kFarAway : t.path.hitT)) {
        t.path = meetCatcher(t.path);
      } else if (t.path.hitSlot < 0) {
        t.path = meetSurroundings(t.path);
      } else {
        t.path = shade(t.path);
      }
      t.path.traversal.steps += kCandidateSteps;
    }

    // Step: is the light seen?
    if (kShadows && t.path.phase == kPhaseShadow) {
      t.path.traversal = traverse(t.path.shadowOrigin, t.path.shadowDirection, t.path.shadowLimit, t.path.traversal,
                                  tree, task.budget, !kPassing);
      if (t.path.traversal.node == kTraversalDone) {
        t.path.rays += 1;
        t.path = settleShadow(t.path);
      }
    }

    // Step: the sample is complete.
    if (t.path.phase >= kPhaseEnd) {
      if (kHeatmap) t.path.radiance = vec3(float(t.path.traversal.visits));
      t = endSample(t, task);
      t.tracing = false;
    }
  }
  return t;
}

/// What an unfinished pixel leaves for the next draw, and says of this one.
PixelTrace leaveUnfinished(PixelTrace t, PixelTask task, uint samplesBefore, int state) {
  // The budget alone may end the loops above: one that ended below it was cut by the driver.
  if (t.path.traversal.steps < task.budget) t.film.flags |= kPixelBudgetHit;
  atomicAdd(progress.unfinished, 1u);
  if (kResumable && t.tracing) {
    t.film.flags |= kPixelSuspended;
    suspendPath(t.path, state * kSuspendedRows);
  }
  // Else the sample begins anew in the next draw, unless it is longer than a whole draw.
  if (!kResumable && t.film.samples == samplesBefore) atomicAdd(progress.stuck, 1u);
  return t;
}

/// Advances one pixel (y from the bottom) until it has the samples wanted or has used the step budget of this draw.
void tracePixel(ivec2 pixel) {
  PixelTrace t;
  t.film = loadFilm(pixel);
  // Always so, but compilers do not know: they would put the block's reads back to where they are used, inside the
  // loop.
  if (t.film.flags != 0xffffffffu) frame = frameBlock;
  ivec2 place = pixel - frame.tile.xy;
  int state = place.y * frame.tile.z + place.x;
  PixelTask task;
  task.pixel = pixel;
  task.key = kLightPaths ? keyOfLightPaths() : keyOfPixel(pixel);
  task.wanted = samplesWanted(t.film);
  task.budget = frame.limits.z;
  TreeFrame tree = treeFrame();
  uint samplesBefore = t.film.samples;
  t.cut = 0.0;
  t.path.phase = kPhaseEnd;
  t.path.traversal.steps = 0;
  if (kResumable && (t.film.flags & kPixelSuspended) != 0u) t.path = resumePath(state * kSuspendedRows, task.key);
  t.path.pixel = pixel;
  t.film.flags &= ~kPixelSuspended;
  t.tracing = t.path.phase != kPhaseEnd;

  if (kDirect) {
    t = traceDirect(t, task, tree);
  } else {
    t = tracePhases(t, task, tree);
  }

  bool finished = t.film.samples >= task.wanted && !t.tracing;
  if (!finished) t = leaveUnfinished(t, task, samplesBefore, state);
  if (kScatters) reportCut(t.cut);
  storeFilm(pixel, t.film);
}
