// SPDX-License-Identifier: MIT
#include "session/picture/draw_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "base/errors.h"
#include "base/text.h"
#include "base/timeline.h"
#include "image/channels.h"
#include "render/adaptive.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/checkpoints.h"
#include "session/picture/denoising.h"
#include "session/picture/draw_samples.h"
#include "session/picture/layers.h"
#include "session/picture/picture_file.h"
#include "session/say.h"

namespace fragtrace {

namespace {

/// Regions that fill `region` from its top on: whole rows where the side allows. None has more pixels than
/// `mostPixels` or a longer side than `mostSide`; both are at least 1.
std::vector<Region> dividedRegion(const Region& region, int mostSide, uint64_t mostPixels) {
  const uint64_t side = std::min(uint64_t(mostSide), mostPixels);
  const int width = int(std::min(uint64_t(region.size.x), side));
  const int height = int(std::min(mostPixels / uint64_t(width), uint64_t(mostSide)));
  std::vector<Region> parts;
  for (int y = 0; y < region.size.y; y += height) {
    for (int x = 0; x < region.size.x; x += width) {
      const glm::ivec2 corner(x, y);
      parts.push_back({region.corner + corner, glm::min(glm::ivec2(width, height), region.size - corner)});
    }
  }
  return parts;
}

/// Copies `part`, which lies at `corner` of `picture` and has the same channels.
void paste(const Image& part, glm::ivec2 corner, Image& picture) {
  const size_t row = size_t(part.width) * part.channelCount();
  for (int y = 0; y < part.height; ++y)
    std::copy_n(part.pixel(0, y), row, picture.pixel(corner.x, corner.y + y));
}

/// A sheet of models has no bars, but other programs are told the progress of its pictures.
bool hidesProgress(const PictureJob& job) {
  const ProgressForm form = job.options.output.progress;
  return job.options.output.quiet || form == ProgressForm::None ||
         (!job.showsProgress && job.sequence == nullptr && form != ProgressForm::Json);
}

double areaOf(glm::ivec2 size) { return double(size.x) * size.y; }

/// The share of a picture that was done before one of its parts, and the share of that part.
struct Share {
  double done = 0.0;
  double own = 1.0;

  double of(double fraction) const { return done + own * fraction; }
};

/// Says where a render of several parts continues; nothing for a picture in one part.
std::string placeOfPart(const Share& share) {
  if (share.own == 1.0) return "";
  return ", where " + std::to_string(int(100.0 * share.done)) + " % of the picture are done";
}

std::vector<Share> sharesOf(std::span<const Region> parts, glm::ivec2 size) {
  std::vector<Share> shares;
  double done = 0.0;
  for (const Region& part : parts) {
    const double own = areaOf(part.size) / areaOf(size);
    shares.push_back({done, own});
    done += own;
  }
  return shares;
}

/// The worst of both parts, since a goal holds in each of them.
AdaptiveStatistics bothAdaptive(const AdaptiveStatistics& a, const AdaptiveStatistics& b) {
  return {{std::max(a.error, b.error), std::min(a.share, b.share), std::max(a.rounds, b.rounds),
           a.known && b.known, a.black && b.black},
          a.noise,
          a.seconds};
}

void add(FilmTotals& totals, const FilmTotals& part, bool first) {
  totals.fewestSamples = first ? part.fewestSamples : std::min(totals.fewestSamples, part.fewestSamples);
  totals.mostSamples = std::max(totals.mostSamples, part.mostSamples);
  totals.samples += part.samples;
  totals.rays += part.rays;
  totals.hitPixels += part.hitPixels;
  totals.emptyPixels += part.emptyPixels;
  totals.nonfinitePixels += part.nonfinitePixels;
  totals.budgetHits += part.budgetHits;
  totals.cut += part.cut;
  totals.lightPaths += part.lightPaths;
  totals.pixelsPerPath = std::max(totals.pixelsPerPath, part.pixelsPerPath);
  totals.m2 += part.m2;
  totals.lightPathM2 += part.lightPathM2;
}

/// An image of all parts with the channels of one of them, still black.
Image imageOfAll(const Image& part, glm::ivec2 size) {
  Image all{size.x, size.y, part.channels, {}, {}};
  all.values.resize(size_t(size.x) * size_t(size.y) * all.channelCount());
  return all;
}

/// Adds a part to the picture of all of them. The first part makes the picture.
void addPart(Image& picture, Image part, const Region& place, const Region& all) {
  if (place == all) {
    picture = std::move(part);
    return;
  }
  if (picture.values.empty()) picture = imageOfAll(part, all.size);
  paste(part, place.corner - all.corner, picture);
}

/// One part in progress.
struct PartRun {
  const PictureJob& job;
  const View view;
  Share share;
  Statistics& stats;
  Renderer::Progress progress;
  /// Writes a checkpoint of the part in its present state.
  std::function<void(std::vector<FilmState>, const std::vector<FilmPixels>&, const AdaptiveState&)> keep;
  CheckpointKeeper& keeper;
  const Checkpoint* from;  ///< drawing continues from it; may be null

  /// Reports the progress, and keeps a checkpoint if one is due or the work is to stop.
  template <typename State>
  Renderer::Progress keeping(const State& state) const {
    return [this, state](double fraction) {
      const bool goOn = progress(fraction);
      if (keeper.isDue() || (!goOn && keeper.isKept())) state();
      return goOn;
    };
  }
};

/// Draws until the goal is reached. A part of the picture has its share of the time.
Drawing drawAdaptively(const PartRun& part, glm::ivec2 size) {
  const RenderOptions& options = part.job.options;
  // Time that a part does not use goes to no other part, which would then have less noise than the rest.
  const double seconds = options.sampling.seconds * part.share.own;
  AdaptiveRun run(size);
  if (part.from != nullptr) {
    for (size_t half : {0, 1}) run.films[half].load(part.from->films[half]);
    run.state = part.from->adaptive;
    const std::vector<int32_t>& counts = run.state.samples;
    const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
    const long mean = std::lround(2.0 * sum / double(std::max(size_t(1), counts.size())));
    say(options, "--resume: continues after about " + countText(size_t(mean), "sample") + " per pixel" +
                     placeOfPart(part.share));
  }
  const auto keep = [&] { part.keep({run.films[0].save(), run.films[1].save()}, {}, run.state); };
  const AdaptiveGoal goal{options.sampling.noise, seconds, options.sampling.spp, options.light.shadowCatcher};
  AdaptivePicture picture =
      renderAdaptively(*part.job.tracer.renderer, run, part.view, goal, part.stats.times, part.keeping(keep));
  part.stats.complete = !picture.stopped;
  const AdaptiveStatistics own{picture, options.sampling.noise, options.sampling.seconds};
  part.stats.adaptive = part.stats.adaptive ? bothAdaptive(*part.stats.adaptive, own) : own;
  return {std::move(picture.pixels), std::move(picture.variance), {}};
}

/// Draws up to --spp samples into an empty film.
Drawing drawEvenly(const PartRun& part, Film film) {
  SampledFilm sampled{std::move(film), {}, 0};
  if (part.from != nullptr) {
    const FilmState& state = part.from->films.front();
    sampled.film.load(state);
    sampled.looks = part.from->looks;
    const int spp = part.job.options.sampling.spp;
    const FilmTotals totals = totalsOf(sampled.film.read());
    sampled.fewest = int(std::min<uint32_t>(totals.fewestSamples, uint32_t(spp)));
    // Each pixel continues from its own number of samples.
    const std::string mean = formatted("%.4g", double(totals.samples) / areaOf(sampled.film.size()));
    say(part.job.options, "--resume: continues after " + mean + " of " + countText(size_t(spp), "sample") +
                              " per pixel" + placeOfPart(part.share));
  }
  const auto keep = [&] { part.keep({sampled.film.save()}, sampled.looks, {}); };
  Drawing drawing;
  part.stats.complete = drawAllSamples(*part.job.tracer.renderer, sampled, part.job.options, part.view,
                                       part.stats.times, part.keeping(keep), drawing);
  return drawing;
}

/// The picture without the numbers of samples, if nobody has asked for them and all are the same.
Image withoutNeedlessCounts(Image picture, const RenderOptions& options, const Statistics& stats) {
  const bool needed = stats.adaptive || !stats.complete || withGuides(options).output.aovSamples;
  if (needed || !findChannel(picture, "samples.Y")) return picture;
  std::vector<std::string> channels = picture.channels;
  std::erase(channels, "samples.Y");
  return onlyChannels(picture, channels);
}

/// The seconds that a sample of each layer takes in all pixels, measured in the middle of the first part: of
/// AOVs, then of light groups. Compiles all layers. The film is empty afterwards.
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

/// Returns the seconds that the layers from `first` on will take if the picture has `samples` samples.
double secondsOfAovs(const PictureJob& job, const DrawingPlan& plan, size_t first, int samples) {
  double seconds = 0.0;
  const std::vector<ShaderVariant>& aovs = job.tracer.aovs;
  for (size_t i = first; i < plan.layerSeconds.size(); ++i) {
    const int own = i < aovs.size() ? samplesOfLayer(job.options, aovs[i].aov, samples) : samples;
    seconds += plan.layerSeconds[i] * own;
  }
  return seconds;
}

/// The time that layers will take at least: those of an adaptive picture have the fewest samples of any
/// pixel, a number that is not yet known.
double secondsOfAovs(const PictureJob& job, const DrawingPlan& plan) {
  constexpr int kLeastAdaptive = 64;
  const int spp = job.options.sampling.spp;
  return secondsOfAovs(job, plan, 0, isAdaptive(job.options) ? std::min(spp, kLeastAdaptive) : spp);
}

/// A layer that is to be drawn in all parts.
struct LayerTask {
  std::string name;
  int samples = 0;
  double secondsAfter = 0.0;  ///< seconds of the layers that follow
  int interrupts = 0;         ///< more of these end it
  std::function<LayerDraw(const Region& part, const Renderer::Progress& progress)> draw;
};

struct DrawnLayer {
  Image image;
  FilmTotals totals;
};

/// Draws the layer. Throws RenderError.
DrawnLayer drawnLayer(const LayerTask& task, const PictureJob& job, const DrawingPlan& plan,
                      Statistics& stats) {
  const std::vector<Share> shares = sharesOf(plan.parts, job.loaded.region.size);
  ProgressBar bar("layer " + task.name, hidesProgress(job), task.samples, job.sequence);
  DrawnLayer layer;
  for (size_t p = 0; p < plan.parts.size(); ++p) {
    const Region& part = plan.parts[p];
    LayerDraw own = task.draw(part, [&](double fraction) {
      bar.show(shares[p].of(fraction), task.secondsAfter);
      return interrupts() == task.interrupts;
    });
    stats.complete = stats.complete && own.complete;
    stats.compileMs += own.compileMs;
    stats.featureMs += own.times.renderMs;
    stats.times.work = stats.times.work + own.times.work;
    add(layer.totals, own.totals, p == 0);
    addPart(layer.image, std::move(own.image), part, job.loaded.region);
  }
  bar.clear();
  return layer;
}

/// Adds the layers of --aov light:NAME.
void addLightGroups(Image& picture, const PictureJob& job, const DrawingPlan& plan, int samples, int before,
                    Statistics& stats) {
  const std::vector<std::string>& names = job.options.output.lightGroups;
  if (names.empty()) return;
  const LightGroups groups = lightGroupsOf(job.options, job.loaded.scene);
  for (size_t i = 0; i < names.size(); ++i) {
    const auto draw = [&](const Region& part, const Renderer::Progress& progress) {
      View view = viewOfGroup(viewOf(job.loaded, part), groups, i);
      view.pixelsPerPath = stats.film.pixelsPerPath;
      return drawLayer(part.size, *job.tracer.renderer, job.tracer.variant, view, samples, progress);
    };
    const double after = secondsOfAovs(job, plan, job.tracer.aovs.size() + i + 1, samples);
    const std::string name = "light:" + names[i];
    showLights(job.tracer, job.loaded.scene, groups, i);
    DrawnLayer layer = drawnLayer({name, samples, after, before, draw}, job, plan, stats);
    showLights(job.tracer, job.loaded.scene, groups, std::nullopt);
    sayWhatWentWrong(job.options, layer.totals, name);
    dropDimmed(layer.image, picture);
    const std::string inFile = lightLayer(names[i]);
    appendChannels(picture, layer.image, {inFile + ".R", inFile + ".G", inFile + ".B"});
  }
}

}  // namespace

std::vector<Region> partsOf(const RenderOptions& options, const LoadedScene& loaded) {
  const int mostSide = Film::mostSide();
  const glm::ivec2 size = loaded.region.size;
  const std::string what = std::to_string(size.x) + " x " + std::to_string(size.y) + " pixels";
  std::vector<Region> parts = dividedRegion(loaded.region, mostSide, mostFilmPixels(options, size));
  if (parts.size() > 1 && showsColors(options))
    throw UsageError("a picture of " + what +
                     " has to be drawn in parts here, and the scale of a debug view needs the whole; "
                     "--resolution or --region makes it smaller");
  if (parts.size() > 1 && options.light.reuse == LightReuse::Spatial)
    throw UsageError(
        "--light-reuse spatial: a picture of " + what +
        " has to be drawn in parts here (--memory-limit), and pixels take light from those about "
        "them; --resolution makes it smaller");
  if (std::max(size.x, size.y) > mostSide && options.output.denoise == Denoise::Variance)
    throw UsageError("--denoise variance: this driver filters at most " + std::to_string(mostSide) +
                     " pixels a side, and the picture has " + what);
  return parts;
}

View viewOf(const LoadedScene& loaded, const Region& part) {
  View view = loaded.view;
  if (part.size != loaded.size) view.placement = Placement{part.corner, loaded.size};
  return view;
}

void sayWhatWentWrong(const RenderOptions& options, const FilmTotals& film, const std::string& layer) {
  const std::string place = layer.empty() ? " pixels" : " pixels of the layer " + layer;
  if (film.budgetHits > 0) {
    throw RenderError("the driver ended loops early in " + std::to_string(film.budgetHits) +
                      " pixels (budget_hits); the picture would be wrong, so none is written");
  }
  if (film.emptyPixels > 0) {
    say(options, "warning: stopped before the first sample of " + std::to_string(film.emptyPixels) + place +
                     "; they are black");
  }
  if (film.nonfinitePixels > 0) {
    say(options, "warning: samples of " + std::to_string(film.nonfinitePixels) + place +
                     " were not finite and count as black (nonfinite_pixels)");
  }
}

DrawingPlan planDrawing(const PictureJob& job, Device& device, Statistics& stats) {
  PhaseTimer timer("first draw");
  lightGroupsOf(job.options, job.loaded.scene);  // a wrong name is found before anything is drawn
  for (const std::string& line : sharedGroups(job.options, job.loaded.scene)) say(job.options, line);
  std::vector<Region> parts = partsOf(job.options, job.loaded);
  Film film(parts.front().size);
  const View view = viewOf(job.loaded, parts.front());
  std::vector<double> layerSeconds = measureAovs(job, film, view, stats);
  startFilter(job.options, device);  // not while layers are timed
  stats.parts = int(parts.size());
  stats.compileMs += useOrCompile(*job.tracer.renderer, job.tracer.variant, film, view);
  stats.phases.push_back(timer.end());
  return {std::move(parts), std::move(film), std::move(layerSeconds)};
}

Image drawPicture(const PictureJob& job, DrawingPlan& plan, Statistics& stats, CheckpointKeeper& keeper) {
  const RenderOptions& options = job.options;
  std::optional<Checkpoint> from = readCheckpoint(job, plan);
  const std::string text = keeper.isKept() ? jobText(job, plan) : "";
  const std::vector<Share> shares = sharesOf(plan.parts, job.loaded.region.size);
  const double secondsAfter = secondsOfAovs(job, plan);
  // merge needs the samples of each pixel if these differ.
  const bool keepsCounts = holdsLayers(options) && !showsColors(options);
  ProgressBar bar("rendering", hidesProgress(job),
                  isAdaptive(options) ? std::nullopt : std::optional(options.sampling.spp), job.sequence);
  Image picture;
  size_t i = 0;
  if (from) {
    i = size_t(from->part);
    picture = std::move(from->picture);
    restoreMeasured(from->statistics, stats);
  }
  for (; i < plan.parts.size() && stats.complete; ++i) {
    const Region& region = plan.parts[i];
    Statistics before;
    before.film = stats.film;
    before.adaptive = stats.adaptive;
    const double timedMs = stats.times.renderMs;
    const double begun = steadyMilliseconds();
    const auto progress = [&](double fraction) {
      bar.show(shares[i].of(fraction), secondsAfter);
      if (job.told) job.told(shares[i].of(fraction));
      return interrupts() == 0;
    };
    const auto keep = [&](std::vector<FilmState> films, const std::vector<FilmPixels>& looks,
                          const AdaptiveState& state) {
      RenderTimes now = stats.times;
      now.renderMs = timedMs + steadyMilliseconds() - begun;
      keeper.write({text, measuredText(before, now), picture, int(i), std::move(films), looks, state});
    };
    const PartRun part{job,    viewOf(job.loaded, region), shares[i], stats, progress, keep,
                       keeper, from ? &*from : nullptr};
    const bool isFirst = region == plan.parts.front();
    const Drawing drawing = isAdaptive(options)
                                ? drawAdaptively(part, region.size)
                                : drawEvenly(part, isFirst ? std::move(plan.film) : Film(region.size));
    from.reset();
    add(stats.film, totalsOf(drawing.pixels), isFirst);
    const bool counted = keepsCounts && (plan.parts.size() > 1 || stats.adaptive || !stats.complete);
    addPart(picture, pictureOf(drawing, options, counted), region, job.loaded.region);
  }
  bar.clear();
  for (; i < plan.parts.size(); ++i) {
    stats.film.emptyPixels += uint64_t(areaOf(plan.parts[i].size));
    stats.film.fewestSamples = 0;
  }
  return withoutNeedlessCounts(std::move(picture), options, stats);
}

void addAovs(Image& picture, const PictureJob& job, const DrawingPlan& plan, Statistics& stats) {
  const int drawn = int(std::max(1u, stats.adaptive ? stats.film.fewestSamples : stats.film.mostSamples));
  const int all = stats.complete ? drawn : std::min(drawn, kFewLayerSamples);
  const int before = interrupts();
  for (size_t i = 0; i < job.tracer.aovs.size(); ++i) {
    const ShaderVariant& variant = job.tracer.aovs[i];
    const int samples = samplesOfLayer(job.options, variant.aov, all);
    const auto draw = [&](const Region& part, const Renderer::Progress& progress) {
      const View view = viewOf(job.loaded, part);
      if (isMatte(variant.aov))
        return drawMattes(part.size, *job.tracer.renderer, variant, view, samples, job.loaded.scene,
                          progress);
      return drawLayer(part.size, *job.tracer.renderer, variant, view, samples, progress);
    };
    const double after = secondsOfAovs(job, plan, i + 1, all);
    const std::string name(rowOf(variant.aov).name);
    const DrawnLayer layer = drawnLayer({name, samples, after, before, draw}, job, plan, stats);
    sayWhatWentWrong(job.options, layer.totals, name);
    appendChannels(picture, layer.image, layer.image.channels);
    if (isMatte(variant.aov))
      setManifest(picture, matteLayer(variant.aov), namesOfMatte(variant.aov, job.loaded.scene));
  }
  addLightGroups(picture, job, plan, all, before, stats);
}

}  // namespace fragtrace
