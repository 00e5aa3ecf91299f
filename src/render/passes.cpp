// SPDX-License-Identifier: MIT
// The part of the renderer that cuts samples into passes over the picture, by the time that draws took
// before.
#include "render/draw_plan.h"
#include "render/renderer.h"

namespace fragtrace {

using Clock = std::chrono::steady_clock;

/// Counts of work take a plan that no time changes: so many samples of a pixel in a draw, at most.
constexpr int kMostCountedSamples = 4;

void Renderer::adaptPace(int samples) {
  int& most = pace_->mostSamplesPerDraw;
  most = overBudget_ ? std::max(1, samples / 2) : std::max(most, samples * 2);
}

bool Renderer::addSamples(Film& film, const View& view, std::span<const Work> parts, RenderTimes& times,
                          const Progress& progress) {
  const double drawnBefore = drawnMs_;
  const WorkCounts workBefore = work_;
  const auto start = Clock::now();
  const bool complete = addParts(film, view, parts, times, progress);
  times.renderMs += millisecondsBetween(start, Clock::now());
  times.drawMs += drawnMs_ - drawnBefore;
  times.work = times.work + (work_ - workBefore);
  if (complete) progress(1.0);
  return complete;
}

bool Renderer::addParts(Film& film, const View& view, std::span<const Work> parts, RenderTimes& times,
                        const Progress& progress) {
  double total = 0.0;
  for (const Work& part : parts) total += pixelSamples(part);
  double done = 0.0;  // pixel-samples
  double doneMs = 0.0;
  const GoOn goOn = [&](double more) { return progress((done + more) / total); };
  const GoOn stays = [&](double) { return goOn(0.0); };
  if (!chooseLightPaths(film, view, stays)) return false;
  ShaderVariant& variant = pace_->drawn;
  for (const Work& part : parts) {
    for (Work pass = part; pass.from < part.to; pass.from = pass.to) {
      // Step: plan a pass. Where pixels take light samples of others in the same sample, these are stored
      // for one sample at a time.
      int left = variant.neighbours ? 1 : part.to - pass.from;
      if (!trainGuiding(film, view, pass.from, times, stays)) return false;
      if (usesGuiding(variant) && !guides_ && film.pixelsPerPath() != kNoLightPaths) left = 1;
      const int mostPixels = software_ || variant.resumable ? kMaxTilePixels : kMaxGpuTilePixels;
      const DrawPlan plan =
          variant.wavefront    ? planWaves(part.size, software_ ? kWaveTile : kGpuWaveTile, pass.from, left)
          : variant.countsWork ? planDraws(part.size, left, kMostCountedSamples, mostPixels, 0.0, targetMs_)
                               : planDraws(part.size, left, pace_->mostSamplesPerDraw, mostPixels,
                                           pace_->msPerSample * part.busy, targetMs_);
      pass.to = pass.from + plan.samples;
      const auto start = Clock::now();

      // Step: draw it.
      if (!storeReservoirs(film, view, pass.from, stays)) return false;
      const auto drawStart = Clock::now();
      if (!drawPass({variant, film, view, tilesOf(pass, plan.tile)}, goOn)) return false;
      done += pixelSamples(pass);
      doneMs += millisecondsBetween(drawStart, Clock::now());
      pace_->msPerSample = doneMs / done;
      adaptPace(plan.samples);
      const bool lit = addLightPaths(film, view, pass.to, stays);

      // Step: note its time, if it is that of whole frames.
      const double frameMs = millisecondsBetween(start, Clock::now()) / plan.samples;
      if (part.size == film.size() && part.busy == 1.0) {
        if (times.frameMs.empty()) times.firstFrameMs = frameMs;
        times.frameMs.insert(times.frameMs.end(), size_t(plan.samples), frameMs);
      }
      if (!lit) return false;
    }
  }
  return true;
}

}  // namespace fragtrace
