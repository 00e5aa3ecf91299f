// SPDX-License-Identifier: MIT
// The tracer: what both entries (fragment and compute) include and call.
#include "layout.glsl"
layout(std140, binding = kFrameBinding) uniform FrameBlock { Frame frameBlock; };
// The block once more as a variable: llvmpipe reads a uniform lane by lane, so each is read once a draw.
Frame frame = Frame(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), ivec4(0), ivec4(0), ivec4(0), ivec4(0));
layout(std430, binding = kProgressBinding) restrict buffer ProgressBlock { Progress progress; };
#include "read.glsl"
#include "random.glsl"
#include "sampling.glsl"
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
#include "path.glsl"
#include "shade.glsl"

/// Each round of the loop is one ray of a path, its shading and its shadow ray, without the phases of a path that can be suspended.
const bool kDirect = kGi && !kAlpha && !kResumable && kFeature == kFeatureNone;

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

/// Advances one pixel (y from the bottom) until it has the samples wanted or has used the step budget of this draw.
void tracePixel(ivec2 pixel) {
  FilmPixel film = loadFilm(pixel);
  // Always so, but compilers do not know: they would put the block's reads back to where they are used, inside the loop.
  if (film.flags != 0xffffffffu) frame = frameBlock;
  ivec2 place = pixel - frame.tile.xy;
  int state = place.y * frame.tile.z + place.x;
  uint wanted = samplesWanted(film);
  int budget = frame.limits.z;
  uint key = pixelKey(uint(pixel.x), uint(frame.picture.y - 1 - pixel.y), uint(frame.picture.w));
  TreeFrame tree = treeFrame();
  uint samplesBefore = film.samples;
  uint raysBefore = film.rays;
  Path p;
  p.phase = kPhaseEnd;
  p.traversal.steps = 0;
  if (kResumable && (film.flags & kPixelSuspended) != 0u) p = loadPath(state);
  film.flags &= ~kPixelSuspended;
  bool tracing = p.phase != kPhaseEnd;
  bool finished = false;
  float cut = 0.0;

  while (kDirect && !finished && p.traversal.steps < budget) {
    if (!tracing) {
      if (film.samples >= wanted) {
        finished = true;
        break;
      }
      raysBefore = film.rays;
      p = startPath(pixel, key, film.samples + uint(frame.sampling.x), p.traversal.steps);
    }
    // Step: find what the ray hits. A traversal that does not come to its end here begins its sample anew in the next draw.
    tracing = true;
    Traversal hit = beginTraversal(kFarAway, true, p.traversal.steps + 1);
    if (kCreases) hit.tie = p.tie;
    hit = traverse(p.origin, p.direction, kFarAway, hit, tree, budget, false);
    p.traversal.steps = hit.steps;
    if (hit.node != kTraversalDone) break;
    film.rays += 1u;

    // Step: shade it.
    if (hit.slot < 0) {
      p = meetSurroundings(p);
    } else {
      p.hitSlot = hit.slot;
      p.hitInstance = hit.hitInstance;
      p.hitT = hit.t;
      p.hitWeights = hit.weights;
      p = shade(p);
    }
    p.traversal.steps = hit.steps;

    // Step: is the light seen? Literals are tested for lanes without a shadow ray, too: a branch would save nothing.
    if (kShadows) {
      bool waiting = p.phase == kPhaseShadow;
      Traversal shadow = beginTraversal(p.shadowLimit, waiting, hit.steps);
      shadow = traverse(p.shadowOrigin, p.shadowDirection, p.shadowLimit, shadow, tree, budget, true);
      p.traversal.steps = shadow.steps;
      if (waiting && shadow.node != kTraversalDone) break;
      film.rays += waiting ? 1u : 0u;
      p.radiance += waiting && shadow.slot < 0 ? p.contribution : vec3(0.0);
      p.phase = waiting ? p.after : p.phase;
    }
    tracing = p.phase == kPhaseExtend;
    if (!tracing) {
      cut += cutThroughput(p);
      film = addSample(film, p.radiance, p.alpha);
    }
  }

  while (!kDirect && !finished && p.traversal.steps < budget) {
    // Step: begin the next sample.
    if (!tracing) {
      if (film.samples >= wanted) {
        finished = true;
        break;
      }
      raysBefore = film.rays;
      p = startPath(pixel, key, film.samples + uint(frame.sampling.x), p.traversal.steps);
      tracing = true;
    }
    p.traversal.steps += 1;

    // Step: find what the path's ray hits.
    if (p.phase == kPhaseExtend) {
      p.traversal = traverse(p.origin, p.direction, kFarAway, p.traversal, tree, budget, false);
      if (p.traversal.node == kTraversalDone) {
        film.rays += 1u;
        p.hitSlot = p.traversal.slot;
        p.hitInstance = p.traversal.hitInstance;
        p.hitT = p.traversal.t;
        p.hitWeights = p.traversal.weights;
        p.phase = kPhaseShade;
      }
    }

    // Step: shade it; this may need a shadow ray.
    if (kHeatmap) {
      if (p.phase == kPhaseShade) p.phase = kPhaseEnd;
    } else if (p.phase == kPhaseShade) {
      if (p.hitSlot < 0) {
        p = meetSurroundings(p);
      } else {
        p = shade(p);
      }
    }

    // Step: is the light seen?
    if (kShadows && p.phase == kPhaseShadow) {
      p.traversal = traverse(p.shadowOrigin, p.shadowDirection, p.shadowLimit, p.traversal, tree, budget, !kAlpha);
      if (p.traversal.node == kTraversalDone) {
        film.rays += 1u;
        p = settleShadow(p);
      }
    }

    // Step: the sample is complete.
    if (p.phase >= kPhaseEnd) {
      cut += cutThroughput(p);
      if (kHeatmap) p.radiance = vec3(float(p.traversal.visits));
      if (kFeature == kFeatureGuides) {
        film = addGuides(film, p.radiance, p.contribution, p.shadowLimit, p.alpha);
      } else {
        film = addSample(film, p.radiance, p.alpha);
      }
      tracing = false;
    }
  }

  if (!finished && film.samples >= wanted && !tracing) finished = true;
  if (!finished) {
    // The budget alone may end the loops above: one that ended below it was cut by the driver.
    if (p.traversal.steps < budget) film.flags |= kPixelBudgetHit;
    atomicAdd(progress.unfinished, 1u);
    if (kResumable && tracing) {
      film.flags |= kPixelSuspended;
      savePath(p, state);
    }
    if (!kResumable) {
      // The sample begins anew in the next draw, unless it is longer than a whole draw.
      if (tracing) film.rays = raysBefore;
      if (film.samples == samplesBefore) atomicAdd(progress.stuck, 1u);
    }
  }
  if (kScatters) reportCut(cut);
  storeFilm(pixel, film);
}
