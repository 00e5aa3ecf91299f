// SPDX-License-Identifier: MIT
#include "session/picture/draw_samples.h"

#include <algorithm>

#include "image/channels.h"
#include "render/denoise.h"
#include "render/film/noise.h"
#include "session/picture/denoising.h"
#include "session/picture/picture_file.h"

namespace fragtrace {

bool looksOnTheWay(const RenderOptions& options) {
  constexpr int kFewest = 4;
  const RenderOptions drawn = withGuides(options);
  return drawn.output.aovVariance && hasGuides(drawn) && options.sampling.spp >= kFewest;
}

bool drawAllSamples(Renderer& renderer, SampledFilm& sampled, const RenderOptions& options, const View& view,
                    RenderTimes& times, const Renderer::Progress& progress, Drawing& drawing) {
  const bool looks = looksOnTheWay(options);
  std::vector<int> steps;
  if (looks) steps = {options.sampling.spp / 4, options.sampling.spp / 2};
  steps.push_back(options.sampling.spp);
  int from = sampled.fewest;
  for (size_t step = sampled.looks.size(); step < steps.size(); ++step) {
    const int to = steps[step];
    const auto partly = [&](double fraction) {
      return progress((from + fraction * (to - from)) / options.sampling.spp);
    };
    if (!renderer.addSamples(sampled.film, view, from, to, times, partly)) {
      drawing.pixels = sampled.film.read();
      return false;
    }
    from = to;
    if (to < options.sampling.spp) sampled.looks.push_back(sampled.film.read());
  }
  drawing.pixels = sampled.film.read();
  if (looks) drawing.observed = observedVariance(sampled.looks[0], sampled.looks[1], drawing.pixels);
  return true;
}

Image pictureOf(const Drawing& drawing, const RenderOptions& options, bool withSamples) {
  const RenderOptions drawn = withGuides(options);
  Image picture =
      shownPicture(options, drawing.pixels,
                   {keepsAlpha(options), drawn.output.aovSamples || withSamples, drawn.output.aovVariance},
                   drawing.variance);
  if (drawing.observed.empty()) return picture;
  const auto observed = [&](size_t i) { return drawing.observed[i]; };
  appendChannels(picture, imageOfNumbers(drawing.pixels.size, observed), {kObservedChannel});
  return picture;
}

int samplesOfLayer(const RenderOptions& options, Aov aov, int ofPicture) {
  if (aov == Aov::Object || aov == Aov::Material) return std::min(ofPicture, 1);
  if (aov == Aov::Guides) return std::min(ofPicture, kFewLayerSamples);
  const bool asked = std::ranges::find(options.output.aovs, aov) != options.output.aovs.end();
  return asked ? ofPicture : std::min(ofPicture, kFewLayerSamples);
}

double useOrCompile(Renderer& renderer, const ShaderVariant& variant, Film& film, const View& view) {
  if (!renderer.knows(variant)) return renderer.compile(variant, film, view);
  renderer.use(variant);
  return 0.0;
}

LayerDraw drawLayer(glm::ivec2 size, Renderer& renderer, const ShaderVariant& variant, const View& view,
                    int samples, const Renderer::Progress& progress) {
  LayerDraw layer;
  Film film(size);
  layer.compileMs = useOrCompile(renderer, variant, film, view);
  layer.complete = renderer.addSamples(film, view, 0, samples, layer.times, progress);
  if (variant.aov == Aov::Guides) {
    Film::Guides guides = film.readGuides();
    layer.totals = totalsOf(guides.counts);
    layer.image = std::move(guides.layers);
    return layer;
  }
  const FilmPixels pixels = film.read();
  layer.totals = totalsOf(pixels);
  if (variant.aov == Aov::None) {
    layer.image = imageOf(pixels, {});
    return layer;
  }
  const AovRow& row = rowOf(variant.aov);
  std::vector<std::string> names = {"R", "G", "B"};
  names.resize(row.channels.size());
  layer.image = onlyChannels(imageOf(pixels, {}), names);
  for (size_t c = 0; c < names.size(); ++c)
    layer.image.channels[c] = std::string(row.name) + "." + row.channels[c];
  return layer;
}

LayerDraw addLayer(Image& picture, Renderer& renderer, const ShaderVariant& variant, const View& view,
                   int samples, const Renderer::Progress& progress) {
  LayerDraw layer = drawLayer({picture.width, picture.height}, renderer, variant, view, samples, progress);
  appendChannels(picture, layer.image, layer.image.channels);
  return layer;
}

}  // namespace fragtrace
