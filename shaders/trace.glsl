// SPDX-License-Identifier: MIT
// The tracer, which the entries that trace include and call. Its steps are those of machine.glsl.
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
#include "lights/environment_light.glsl"
#include "lights.glsl"
#include "lights/light_tree.glsl"
#include "lights/sample_light.glsl"
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
#include "dimensions.glsl"
#include "cones/cone.glsl"
#include "media/medium.glsl"
#include "path.glsl"
#include "media/scatter.glsl"
#include "reuse/candidates.glsl"
#include "reuse/reservoir.glsl"
#include "reuse/neighbours.glsl"
#include "caustics/guiding.glsl"
#include "shade.glsl"
#include "integrator.glsl"
#include "path_rows.glsl"
#include "machine.glsl"

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
  endWork(numberInTile(pixel));
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

/// The film of a pixel. On GPUs it stays in memory while a path continues.
FilmPixel filmNow(FilmPixel film, ivec2 pixel) { return kGpu ? loadFilm(pixel) : film; }

/// Advances one pixel (y from the bottom) until it has the samples wanted or has used the step budget of this draw.
void tracePixel(ivec2 pixel) {
  FilmPixel film = loadFilm(pixel);
  fetchFrame(film.flags);  // the flags keep compilers from reading the block in the loops
  int row = numberInTile(pixel) * kSuspendedRows;
  int budget = frame.stepBudget;
  TreeFrame tree = treeFrame();
  bool advanced = false;
  float cut = 0.0;  // throughput that was lost to kBounces
  forgetWork();
  Path p;
  p.phase = kPhaseEnd;
  p.traversal.steps = 0;
  if (kResumable && (film.flags & kPixelSuspended) != 0u) p = resumePath(row, keyOfPath(pixel));
  p.pixel = placeOf(pixel, film.samples);

  bool tracing = p.phase != kPhaseEnd;
  while (p.traversal.steps < budget) {
    if (!tracing) {
      film = filmNow(film, pixel);
      if (film.samples >= samplesWanted(film)) break;
      beginWork(numberInTile(pixel));
      p = beginPath(pixel, film.samples, p.traversal.steps);
      tracing = true;
    }
    p = advance(p, budget, tree);
    if (p.phase >= kPhaseEnd) {
      cut += cutThroughput(p);
      film = filmNow(film, pixel);
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

  film = filmNow(film, pixel);
  film.flags &= ~kPixelSuspended;
  if (tracing || film.samples < samplesWanted(film)) {
    // The budget alone may end the loop: one that ended below it was cut by the driver.
    if (p.traversal.steps < budget) film.flags |= kPixelBudgetHit;
    atomicAdd(progress.unfinished, 1u);
    if (kResumable && tracing) {
      film.flags |= kPixelSuspended;
      keepWork(numberInTile(pixel));
      suspendPath(p, row);
    }
    // Else the sample begins again in the next draw, unless it is longer than a whole draw.
    if (!kResumable && !advanced) atomicAdd(progress.stuck, 1u);
  }
  if (kScatters) reportCut(cut);
  storeFilm(pixel, film);
}
