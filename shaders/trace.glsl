// SPDX-License-Identifier: MIT
// The tracer: what both entries (fragment and compute) include and call.
#include "layout.glsl"
layout(std140, binding = kFrameBinding) uniform FrameBlock { Frame frame; };
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
#include "bsdf.glsl"
#include "phong.glsl"
#include "environment.glsl"
#include "lights.glsl"
#include "film.glsl"
#include "path_state.glsl"
#include "path.glsl"
#include "shade.glsl"

/// Advances one pixel (y from the bottom) until it has the samples wanted or has used the step budget of this draw.
void tracePixel(ivec2 pixel) {
  ivec2 place = pixel - frame.tile.xy;
  int state = place.y * frame.tile.z + place.x;
  FilmPixel film = loadFilm(pixel);
  // A pixel may want fewer samples than the draw brings (Film::setTargets).
  uint own = film.flags >> kPixelTargetShift;
  uint wanted = own > 0u ? min(own, uint(frame.picture.z)) : uint(frame.picture.z);
  int budget = frame.limits.z;
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

  while (!finished && p.traversal.steps < budget) {
    // Step: begin the next sample.
    if (!tracing) {
      if (film.samples >= wanted) {
        finished = true;
        break;
      }
      raysBefore = film.rays;
      p = startPath(pixel, film.samples + uint(frame.sampling.x), p.traversal.steps);
      tracing = true;
    }
    p.traversal.steps += 1;

    // Step: find what the path's ray hits.
    if (p.phase == kPhaseExtend) {
      p.traversal = traverse(p.origin, p.direction, kFarAway, p.traversal, tree, budget, false);
      if (p.traversal.node == kTraversalDone) {
        film.rays += 1u;
        p.hitSlot = p.traversal.slot;
        p.hitT = p.traversal.t;
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
    if (p.phase == kPhaseEnd) {
      if (kHeatmap) p.radiance = vec3(float(p.traversal.visits));
      film = addSample(film, p.radiance, p.alpha);
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
  storeFilm(pixel, film);
}
