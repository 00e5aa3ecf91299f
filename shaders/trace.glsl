// SPDX-License-Identifier: MIT
// The tracer, which the entries that trace include and call. The whole of it, without media:
//
//   tracePixel(pixel):                            a lane of the megakernel; a lane of wavefront.glsl has 32 pixels
//     film = load(pixel)
//     until film has its samples or the draw its steps:
//       path = beginSample()                      a camera ray; or one of a lamp or the sun (caustics/)
//       while the path goes on: advance(path)
//       film = endSample(path)                    sums of radiance and its variance, counts
//     store(film)
//
//   advance(path):                                one round
//     hit = traverse(path.ray)
//     meet(path, hit)
//     if it left a shadow ray: meetShadow(path, traverse(shadow ray))
//
//   traverse(ray):                                traverse.glsl
//     node = root
//     until nothing is left:
//       inner node: node = nearer child that the ray meets; push the farther one; none: pop
//       leaf: keep the nearest hit on its two primitives (intersect.glsl, tree/alpha.glsl); pop
//
//   meet(path, hit):
//     the shadow catcher lies before it: catcher.glsl
//     nothing is hit:
//       radiance += throughput * environment * weight(pdf of scattering, pdf of light samples); end
//     else shade(path, hit)
//
//   shade(path, hit):                             shade.glsl
//     surface, material = what is hit             surface.glsl, material.glsl
//     throughput *= absorption along the ray
//     radiance += throughput * emission * weight(pdf of scattering, pdf of light samples)
//     more scatterings than --bounces: end
//     light = a light by its power, a point of it   lights.glsl
//     contribution = throughput * irradiance * BSDF * cosine * weight(pdf of the light sample, pdf of scattering)
//     shadow ray = from the surface to the light
//     direction = a direction drawn from the BSDF   bsdf.glsl, layers.glsl
//     throughput *= BSDF * cosine / pdf
//     Russian roulette: end, or throughput /= chance to survive
//     path.ray = from the surface along the direction
//
//   meetShadow(path, hit):
//     if nothing is hit: radiance += contribution
#include "layout.glsl"
#include "frame.glsl"
layout(std430, binding = kProgressBinding) restrict buffer ProgressBlock { Progress progress; };
#include "work/count.glsl"
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
#include "tree/state.glsl"
#include "tree/ray.glsl"
#include "tree/leaf.glsl"
#include "traverse.glsl"
#include "texture.glsl"
#include "material.glsl"
#include "perlin.glsl"
#include "fresnel.glsl"
#include "surface.glsl"
#include "ggx.glsl"
#include "energy.glsl"
#include "iridescence.glsl"
#include "bsdf.glsl"
#include "layers.glsl"
#include "material_layers.glsl"
#include "phong.glsl"
#include "sky/sun.glsl"
#include "environment.glsl"
#include "environment_light.glsl"
#include "lights.glsl"
#include "film_pixel.glsl"
#include "film.glsl"
// On camera paths 0 without guiding, and -1 without light paths.
layout(location = kMostCasters) uniform int casterCount;
layout(location = 0) uniform vec4 casters[kMostCasters];  // local space: middle, radius

#include "caustics/flux.glsl"
#include "caustics/form.glsl"
#include "path_state.glsl"
#include "path_states.glsl"
#include "tree/alpha.glsl"
#include "media/phase.glsl"
#include "media/flight.glsl"
#include "media/fog.glsl"
#include "media/fog_block.glsl"
#include "media/volume.glsl"
#include "media/volume_block.glsl"
#include "shutter/camera.glsl"
#include "path.glsl"
#include "media/scatter.glsl"
#include "reuse/candidates.glsl"
#include "reuse/reservoir.glsl"
#include "reuse/neighbours.glsl"
#include "caustics/guiding.glsl"
#include "shade.glsl"
#include "integrator.glsl"
#include "path_rows.glsl"

/// Rays are traced from end to end: what the budget ends begins its sample again in the next draw, and no traversal is
/// kept from round to round.
const bool kWholeRays = kGi && !kPassing && !kResumable && kAov == kAovNone;

/// A pixel may want fewer samples than the draw brings (Film::setTargets).
uint samplesWanted(FilmPixel film) {
  uint own = film.flags >> kPixelTargetShift;
  return own > 0u ? min(own, uint(frame.samplesWanted)) : uint(frame.samplesWanted);
}

/// The number of a pixel in the tile.
int numberInTile(ivec2 pixel) {
  ivec2 place = pixel - frame.tile.xy;
  return place.y * frame.tile.z + place.x;
}

/// Adds the finished path to the film.
FilmPixel endSample(FilmPixel film, Path p, ivec2 pixel) {
  if (kCountWork) endWork(numberInTile(pixel));
  film.rays += uint(tracedRays(p));
  return record(film, p, pixel);
}

/// The luminance of the throughput that a path had left when --bounces ended it, as seen from outside all glass.
float cutThroughput(Path p) {
  if (!kScatters || p.phase != kPhaseCut) return 0.0;
  return kPassesLight ? luminance(p.throughput) * p.etaScale : luminance(p.throughput);
}

/// Adds it to what the draw reports.
void reportCut(float cut) {
  if (!(cut > 0.0) || isNonfinite(cut)) return;
  uint units = uint(min(cut * kCutUnits, float(4.0e9)));
  uint before = atomicAdd(progress.cutLow, units);
  if (before + units < before) atomicAdd(progress.cutHigh, 1u);
}

/// The path's ray has been traced: something stops it before its hit, or it hits a surface, or nothing.
Path meet(Path p) {
  float t = interceptedAt(p);
  if (t < kFarAway) {
    p = intercept(p, t);
  } else if (p.hitSlot < 0) {
    p = miss(p);
  } else {
    p = hit(p);
  }
  return p;
}

/// The shadow ray has been traced, as far as the budget lets it.
Path meetShadow(Path p) {
  if (!isDone(p.traversal)) return p;
  p.rays += 1;
  if (kCountWork) countShadowRay();
  return settleShadow(p);
}

/// One round of a path. A traversal that the budget ends leaves it in its phase. On GPUs a round is one ray of either
/// kind, so that there is one traversal: a second one takes registers (docs/measurements/gpu.md).
Path advance(Path p, int budget, TreeFrame tree) {
  p.traversal.steps += 1;

  // Step: find what the ray hits: that of the path, or its shadow ray.
  bool isShadow = kGpu && kShadows && p.phase == kPhaseShadow;
  // Only light paths may have ended before their first ray.
  if ((kWholeRays && !kLightPaths) || p.phase == kPhaseExtend || isShadow) {
    // The flight, which limits the ray, is drawn already: a walk through a grid takes long.
    if (kWholeRays && !isShadow) p = extendTo(p, kMedia ? p.traversal.t : kFarAway);
    if (kGpu && kWholeRays && isShadow) p = traceAnew(p, p.shadowLimit);
    if (kTestsAlpha) p = withChances(p);
    p.traversal = traverse(isShadow ? p.shadowOrigin : p.origin, isShadow ? p.shadowDirection : p.direction,
                           isShadow ? p.shadowLimit : kFarAway, p.traversal, tree, budget, isShadow);
    // A shadow ray or one that is not done leaves its hit, too: that of the ray before then needs no registers.
    if (kWholeRays) p = withHit(p, p.traversal);
    if (!isShadow && isDone(p.traversal)) {
      p.rays += 1;
      if (kCountWork) countRay(p);
      if (!kWholeRays) p = withHit(p, p.traversal);
      p.phase = kPhaseShade;
    }
  }
  if (kGpu && isShadow) p = meetShadow(p);

  // Step: shade it; this may need a shadow ray.
  if (p.phase == kPhaseShade) {
    p = meet(p);
    p.traversal.steps += kCandidateSteps;
  }

  // Step: is the light seen?
  if (!kGpu && kShadows && p.phase == kPhaseShadow) {
    if (kTestsAlpha) p = withChances(p);
    p.traversal = traverse(p.shadowOrigin, p.shadowDirection, p.shadowLimit, p.traversal, tree, budget, true);
    p = meetShadow(p);
  }
  return p;
}

/// Advances one pixel (y from the bottom) until it has the samples wanted or has used the step budget of this draw. On
/// GPUs its film stays in memory while a path goes on.
void tracePixel(ivec2 pixel) {
  FilmPixel film = loadFilm(pixel);
  fetchFrame(film.flags);  // the flags keep compilers from reading the block in the loops
  int row = numberInTile(pixel) * kSuspendedRows;
  int budget = frame.stepBudget;
  TreeFrame tree = treeFrame();
  bool advanced = false;
  float cut = 0.0;  // throughput that was lost to kBounces
  if (kCountWork) forgetWork();
  Path p;
  p.phase = kPhaseEnd;
  p.traversal.steps = 0;
  if (kResumable && (film.flags & kPixelSuspended) != 0u) p = resumePath(row, keyOfPath(pixel));
  p.pixel = placeOf(pixel, film.samples);

  bool tracing = p.phase != kPhaseEnd;
  while (p.traversal.steps < budget) {
    if (!tracing) {
      if (kGpu) film = loadFilm(pixel);
      if (film.samples >= samplesWanted(film)) break;
      if (kCountWork) beginWork(numberInTile(pixel));
      p = beginPath(pixel, film.samples, p.traversal.steps);
      tracing = true;
    }
    p = advance(p, budget, tree);
    if (p.phase >= kPhaseEnd) {
      cut += cutThroughput(p);
      if (kGpu) film = loadFilm(pixel);
      if (hasMoreRays(p)) {
        p = nextRay(p, pixel, film.samples);
      } else {
        film = endSample(film, p, pixel);
        if (kGpu) storeFilm(pixel, film);
        tracing = false;
        advanced = true;
      }
    }
  }

  if (kGpu) film = loadFilm(pixel);
  film.flags &= ~kPixelSuspended;
  if (tracing || film.samples < samplesWanted(film)) {
    // The budget alone may end the loop: one that ended below it was cut by the driver.
    if (p.traversal.steps < budget) film.flags |= kPixelBudgetHit;
    atomicAdd(progress.unfinished, 1u);
    if (kResumable && tracing) {
      film.flags |= kPixelSuspended;
      if (kCountWork) keepWork(numberInTile(pixel));
      suspendPath(p, row);
    }
    // Else the sample begins again in the next draw, unless it is longer than a whole draw.
    if (!kResumable && !advanced) atomicAdd(progress.stuck, 1u);
  }
  if (kScatters) reportCut(cut);
  storeFilm(pixel, film);
}
