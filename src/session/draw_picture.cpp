// SPDX-License-Identifier: MIT
#include "session/draw_picture.h"

#include <algorithm>

#include "film/noise.h"
#include "image/channels.h"
#include "render/denoise.h"
#include "session/denoising.h"
#include "session/picture_file.h"

namespace fragtrace {

namespace {

/// Whether somebody will ask for the picture's noise: our own filter, now or when the file is read again.
bool needsObservation(const RenderOptions& options) {
  const RenderOptions drawn = withGuides(options);
  return drawn.aovVariance && hasGuides(drawn);
}

}  // namespace

bool drawAllSamples(Renderer& renderer, Film& film, const RenderOptions& options, const View& view,
                    RenderTimes& times, const Renderer::Progress& progress, Drawing& drawing) {
  constexpr int kFewest = 4;
  const bool looks = needsObservation(options) && options.spp >= kFewest;
  std::vector<FilmPixels> seen;
  int from = 0;
  bool complete = true;
  for (const int to : {options.spp / 4, options.spp / 2, options.spp}) {
    if (!looks && to < options.spp) continue;
    const auto partly = [&](double fraction) {
      return progress((from + fraction * (to - from)) / options.spp);
    };
    complete = renderer.addSamples(film, view, from, to, times, partly);
    if (!complete) break;
    from = to;
    if (looks) seen.push_back(film.read());
  }
  if (looks && complete) {
    drawing.observed = observedVariance(seen[0], seen[1], seen[2]);
    drawing.pixels = std::move(seen.back());
  } else {
    drawing.pixels = film.read();
  }
  return complete;
}

Image pictureOf(const Drawing& drawing, const RenderOptions& options, const ShaderVariant& variant) {
  const RenderOptions drawn = withGuides(options);
  Image picture = shownPicture(options, variant, drawing.pixels,
                               {!options.background, drawn.aovSamples, drawn.aovVariance}, drawing.variance);
  if (drawing.observed.empty()) return picture;
  const auto observed = [&](size_t i) { return drawing.observed[i]; };
  appendChannels(picture, imageOfNumbers(drawing.pixels.size, observed), {kObservedChannel});
  return picture;
}

int samplesOfLayer(const RenderOptions& options, Feature feature, int ofPicture) {
  if (feature == Feature::Guides) return std::min(ofPicture, kFewLayerSamples);
  const bool asked = std::ranges::find(options.aovFeatures, feature) != options.aovFeatures.end();
  return asked ? ofPicture : std::min(ofPicture, kFewLayerSamples);
}

LayerDraw addLayer(Image& picture, Renderer& renderer, const ShaderVariant& variant, const View& view,
                   int samples, const Renderer::Progress& progress) {
  LayerDraw layer;
  RenderTimes times;
  Film film({picture.width, picture.height});
  if (renderer.knows(variant))
    renderer.use(variant);
  else
    layer.compileMs = renderer.compile(variant, film, view);
  layer.complete = renderer.addSamples(film, view, 0, samples, times, progress);
  layer.drawMs = times.renderMs;
  if (variant.feature == Feature::Guides) {
    const Film::Guides guides = film.readGuides();
    layer.totals = totalsOf(guides.counts);
    appendChannels(picture, guides.layers, guides.layers.channels);
    return layer;
  }
  const FilmPixels pixels = film.read();
  layer.totals = totalsOf(pixels);
  const FeatureRow& row = rowOf(variant.feature);
  std::vector<std::string> names;
  for (const char channel : row.channels) names.push_back(std::string(row.name) + "." + channel);
  appendChannels(picture, imageOf(pixels, {}), names);
  return layer;
}

}  // namespace fragtrace
