// SPDX-License-Identifier: MIT
#include "bench/command/setting_check.h"

#include <algorithm>

#include "base/errors.h"
#include "bench/report/picture_check.h"
#include "image/channels.h"
#include "options/check_render.h"
#include "session/say.h"

namespace fragtrace {

namespace {

constexpr int kLeastSamples = 4;  // fewer samples do not show the noise

void judge(TimedSetting& s, const FilmPixels& other, CheckAgainst against, const std::string& name) {
  if (against != CheckAgainst::SameSamples && s.report.frames < kLeastSamples) {
    RenderTimes times;
    s.tracer.renderer->addSamples(*s.film, s.loaded->view, s.report.frames, kLeastSamples, times);
  }
  const FilmPixels pixels = s.film->read();
  const PictureCheck check = checkPicture(pixels, other, against);
  PictureVerdict& v = s.report.picture;
  v = {name, check.rmse, check.differing, check.meanErrors, check.farBlocks, check.wrong};
  const FilmTotals totals = totalsOf(pixels);
  if (totals.nonfinitePixels > 0)
    v.wrong = "samples of " + std::to_string(totals.nonfinitePixels) + " pixels are not finite";
  if (totals.budgetHits > 0)
    v.wrong = "the driver ended loops early in " + std::to_string(totals.budgetHits) + " pixels";
}

/// Does the same by the other way through the tree; the heat map shows the way itself.
RenderOptions otherWay(const RenderOptions& options) {
  RenderOptions other = options;
  other.output.quiet = true;
  if (options.output.debugView == DebugView::Visits) return other;
  other.device.traversal =
      options.device.traversal == TraversalMethod::Bvh ? TraversalMethod::FrontToBack : TraversalMethod::Bvh;
  return other;
}

/// Settings that are to show one picture, against that of the first of them by the other way.
void checkGroup(const Context& context, std::vector<TimedSetting*> group, ProgressBar& bar, double done,
                double part) {
  const BenchConfiguration& first = group.front()->configuration;
  Statistics stats;
  const RenderOptions options = otherWay(first.render);
  const LoadedScene loaded = loadScene(options, stats);
  const Tracer tracer = makeTracer(context, loaded, options, stats);
  Film film(loaded.size);
  tracer.renderer->compile(tracer.variant, film, loaded.view);
  std::ranges::stable_sort(group, {}, [](const TimedSetting* s) { return s->report.frames; });
  const char* way = tracer.variant.traversal == TraversalMethod::Bvh ? "bvh" : "front-to-back";
  int samples = 0;
  for (TimedSetting* s : group) {
    const bool same = drawSameSamples(first.render, s->configuration.render);
    const int wanted = same ? s->report.frames : std::max(kLeastSamples, s->report.frames);
    if (wanted > samples) {
      RenderTimes times;
      tracer.renderer->addSamples(film, loaded.view, samples, wanted, times, [&](double fraction) {
        bar.show(done + part * fraction);
        return true;
      });
      samples = wanted;
    }
    const bool inStep = same && samples == s->report.frames;
    judge(*s, film.read(), inStep ? CheckAgainst::SameSamples : CheckAgainst::OtherSamples,
          "'" + first.name + "' by " + way);
  }
}

}  // namespace

ReferencePicture readReference(const std::filesystem::path& path) {
  const Image image = readImage(path);
  if (!findColorChannels(image)) throw InputError(path.string() + ": has no colour");
  ReferencePicture reference;
  reference.path = path;
  reference.film = filmOf(image, reference.noiseFree);
  return reference;
}

void checkSize(const ReferencePicture& reference, const TimedSetting& setting) {
  if (reference.film.size != setting.loaded->size)
    throw InputError(reference.path.string() + ": is not of the size of '" + setting.configuration.name +
                     "'");
}

void checkSettings(const Context& context, std::span<TimedSetting> settings,
                   const std::optional<ReferencePicture>& reference, bool quiet) {
  if (reference) {
    for (TimedSetting& s : settings)
      judge(s, reference->film, reference->noiseFree ? CheckAgainst::NoiseFree : CheckAgainst::OtherSamples,
            reference->path.filename().string());
    return;
  }
  ProgressBar bar("checking pictures", quiet);
  std::vector<bool> judged(settings.size(), false);
  for (size_t i = 0; i < settings.size(); ++i) {
    std::vector<TimedSetting*> group;
    for (size_t j = i; j < settings.size(); ++j) {
      if (judged[j] || !showSame(settings[i].configuration.render, settings[j].configuration.render))
        continue;
      judged[j] = true;
      group.push_back(&settings[j]);
    }
    if (!group.empty())
      checkGroup(context, group, bar, double(i) / double(settings.size()), 1.0 / double(settings.size()));
  }
  bar.clear();
}

void throwIfWrong(std::span<const FrameSetting> settings) {
  std::string text;
  for (const FrameSetting& s : settings) {
    if (s.picture.wrong.empty()) continue;
    text += (text.empty() ? "" : "; ") + s.scene + ", " + s.configuration + ": " + s.picture.wrong +
            " (against " + s.picture.against + ")";
  }
  if (!text.empty()) throw RenderError("wrong picture: " + text);
}

}  // namespace fragtrace
