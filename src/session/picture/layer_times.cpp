// SPDX-License-Identifier: MIT
#include "session/picture/layer_times.h"

#include <algorithm>

#include "render/adaptive.h"
#include "session/picture/draw_samples.h"

namespace fragtrace {

std::vector<double> measureAovs(const PictureJob& job, Film& film, const View& view, Statistics& stats) {
  constexpr int kSide = 256;
  Work work{{}, glm::min(film.size(), glm::ivec2(kSide)), 0, 1};
  work.corner = (film.size() - work.size) / 2;
  const double times =
      double(job.loaded.region.size.x) * job.loaded.region.size.y / (double(work.size.x) * work.size.y);
  const auto secondsOf = [&](const ShaderVariant& variant) {
    stats.compileMs += useOrCompile(*job.tracer.renderer, variant, film, view);
    if (!job.showsProgress) return 0.0;
    RenderTimes measured;
    job.tracer.renderer->addSamples(film, view, {&work, 1}, measured);
    film.clear();
    return 0.001 * measured.renderMs * times;
  };
  std::vector<double> seconds;
  for (const ShaderVariant& variant : job.tracer.aovs) seconds.push_back(secondsOf(variant));
  const size_t groups = job.options.output.lightGroups.size();
  if (groups > 0) seconds.insert(seconds.end(), groups, secondsOf(job.tracer.variant));
  return seconds;
}

double secondsOfAovs(const PictureJob& job, const DrawingPlan& plan, size_t first, int samples) {
  double seconds = 0.0;
  const std::vector<ShaderVariant>& aovs = job.tracer.aovs;
  for (size_t i = first; i < plan.layerSeconds.size(); ++i) {
    const int own = i < aovs.size() ? samplesOfLayer(job.options, aovs[i].aov, samples) : samples;
    seconds += plan.layerSeconds[i] * own;
  }
  return seconds;
}

double secondsOfAovs(const PictureJob& job, const DrawingPlan& plan) {
  constexpr int kLeastAdaptive = 64;
  const int spp = job.options.sampling.spp;
  return secondsOfAovs(job, plan, 0, isAdaptive(job.options) ? std::min(spp, kLeastAdaptive) : spp);
}

}  // namespace fragtrace
