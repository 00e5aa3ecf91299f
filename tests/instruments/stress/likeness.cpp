// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/likeness.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "bench/report/picture_check.h"
#include "tests/instruments/stress/random_sketch.h"

namespace fragtrace {

namespace {

constexpr double kMostApart = 1e-3;
constexpr double kMostErrorsSame = 3.0;
/// Meshes in a space of their own round in another way, so that some paths part: by up to 0.7 standard errors
/// of the mean and 0.9 of a block in 60 scenes. Without the mirror of tangents it is 4.0 and 4.4.
constexpr double kMostErrorsShared = 2.0;
constexpr double kMostErrorsOther = 5.0;

/// Paths draw the same numbers for the same choices, so they differ by rounding alone. Blended surfaces have
/// the numbers of their primitives, which are others in shared meshes.
bool sameNumbers(Form form) { return form == Form::Scaled || form == Form::Moved || form == Form::Shared; }

double meanOf(const FilmPixels& film) {
  double sum = 0.0;
  for (const FilmPixel& p : film.pixels) sum += p.luminance();
  return sum / double(film.pixels.size());
}

size_t countOtherHits(const FilmPixels& a, const FilmPixels& b, double scale) {
  constexpr double kApart = 1e-3;
  size_t count = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const double da = a.pixels[i].mean().x;
    const double db = b.pixels[i].mean().x / scale;
    count += !(std::abs(da - db) <= kApart * std::abs(da));
  }
  return count;
}

/// Empty: means and blocks are at most so many standard errors apart.
std::string whyApart(const Likeness& l, double mostErrors) {
  if (!(l.meanErrors <= mostErrors))
    return formatted("their means are %.3g standard errors apart", l.meanErrors);
  if (!(l.worstBlock <= mostErrors)) return formatted("a block is %.3g standard errors off", l.worstBlock);
  return "";
}

bool isBlended(const SceneSketch& sketch) {
  return std::ranges::any_of(sketch.materials, [](const SketchMaterial& m) { return m.alpha < 1.0; });
}

std::string whyOther(const Likeness& l) {
  if (l.form == Form::Shared)
    return whyApart(l, isBlended(randomSketch(l.seed)) ? kMostErrorsOther : kMostErrorsShared);
  if (sameNumbers(l.form)) {
    if (!(l.meanApart <= kMostApart)) return formatted("their means are %.2g apart", l.meanApart);
    if (!(l.worstBlock <= kMostErrorsSame))
      return formatted("a block is %.3g standard errors off", l.worstBlock);
    return "";
  }
  return whyApart(l, kMostErrorsOther);
}

SceneDrawing drawingOf(const Context& context, const SceneSketch& drawn, RenderOptions options,
                       uint32_t seed) {
  options.sampling.seed = seed;
  return {context, sceneOf(drawn), options, environmentOf(drawn), drawn.skyTurn};
}

/// The other way to draw the same: the shader reads the scene by other buffers, and runs in another stage.
RenderOptions byOtherMeans(RenderOptions options, uint32_t seed) {
  constexpr std::array kReads{BufferReads::Ssbo, BufferReads::Image, BufferReads::Texel};
  options.device.bufferReads = kReads[seed / 7 % kReads.size()];
  options.device.dispatch = seed / 11 % 2 == 0 ? Dispatch::Fragment : Dispatch::Compute;
  if (options.device.schedule == Schedule::Wavefront) options.device.dispatch = Dispatch::Auto;
  return options;
}

/// The sketch with surfaces that chance does not let pass: its numbers are those of primitives, whose order
/// forms change.
SceneSketch withoutChance(SceneSketch sketch) {
  for (SketchMaterial& material : sketch.materials) material.alpha = 1.0;
  return sketch;
}

/// A random scene and its form.
struct Pair {
  SceneSketch sketch;
  SceneSketch other;
  SceneDrawing a;
  SceneDrawing b;

  Pair(const Context& context, const SceneSketch& scene, uint32_t seed, Form form,
       const RenderOptions& options)
      : sketch(scene),
        other(inForm(sketch, form, seed)),
        a(drawingOf(context, sketch, options, options.sampling.seed)),
        b(drawingOf(context, other, byOtherMeans(options, seed),
                    options.sampling.seed + (sameNumbers(form) ? 0 : 1))) {}

  void compareHits(Likeness& l, const SceneDrawing::GoOn& goOn) {
    const FilmPixels before = a.depth(goOn);
    l.pixels = before.pixels.size();
    l.otherHits = countOtherHits(before, b.depth(goOn), glm::length(glm::dvec3(other.root[0])));
  }
};

RenderOptions optionsOf(int side) {
  RenderOptions options;
  options.sampling.spp = 64;
  options.sampling.bounces = 6;
  options.sampling.seed = 1;
  options.camera.resolution = glm::ivec2(side);
  options.device.traversal = TraversalMethod::FrontToBack;
  // The variance of samples tells their noise only if they are independent.
  options.stages.reset(size_t(Stage::Sobol));
  return options;
}

/// Draws a scene and its form, and compares the pictures. Only samples that are wrong by themselves are in
/// `wrong`.
Likeness compared(const Context& context, uint32_t seed, Form form, const RenderOptions& options,
                  const SceneDrawing::GoOn& goOn) {
  Likeness l;
  l.seed = seed;
  l.form = form;
  Pair pair(context, randomSketch(seed), seed, form, options);
  const FilmPixels a = pair.a.picture(goOn);
  const FilmPixels b = pair.b.picture(goOn);
  const PictureCheck check = checkPicture(b, a, CheckAgainst::OtherSamples);
  l.meanApart = std::abs(meanOf(b) / meanOf(a) - 1.0);
  l.meanErrors = check.meanErrors;
  l.worstBlock = check.worstBlock;
  if (isBlended(pair.sketch))
    Pair(context, withoutChance(pair.sketch), seed, form, options).compareHits(l, goOn);
  else
    pair.compareHits(l, goOn);
  const FilmTotals totals[] = {totalsOf(a), totalsOf(b)};
  for (const FilmTotals& t : totals) {
    if (t.nonfinitePixels > 0) l.wrong = std::to_string(t.nonfinitePixels) + " pixels met NaN or infinity";
    if (t.budgetHits > 0) l.wrong = std::to_string(t.budgetHits) + " pixels in which a loop was cut";
    if (t.emptyPixels > 0) l.wrong = "a pixel without samples";
  }
  return l;
}

}  // namespace

Likeness hitsOf(const Context& context, uint32_t seed, Form form, const SceneDrawing::GoOn& goOn) {
  Likeness l;
  l.seed = seed;
  l.form = form;
  Pair(context, withoutChance(randomSketch(seed)), seed, form, optionsOf(64)).compareHits(l, goOn);
  return l;
}

Likeness likenessOf(const Context& context, uint32_t seed, Form form, Schedule schedule,
                    const SceneDrawing::GoOn& goOn) {
  RenderOptions options = optionsOf(24);
  options.device.schedule = schedule;
  Likeness l = compared(context, seed, form, options, goOn);
  if (!l.wrong.empty()) return l;
  l.wrong = whyOther(l);
  const bool byChance = form == Form::Shared || !sameNumbers(form);
  if (l.wrong.empty() || !byChance) return l;
  // Rare bright samples take some pictures apart by chance: one seed in 160 of scene 3861 shared, one in 100
  // of scene 4182 flattened. Four times as many samples double the distance of a fault, in standard errors.
  options.sampling.spp *= 4;
  options.sampling.seed += 1;
  l = compared(context, seed, form, options, goOn);
  if (l.wrong.empty()) l.wrong = whyOther(l);
  return l;
}

std::string likenessLine(const Likeness& l) {
  return formatted(
      "seed %u %.*s: mean apart %.2g (%.2f standard errors), worst block %.2f standard errors, %zu of %zu "
      "hits other%s%s",
      l.seed, int(kFormNames[size_t(l.form)].size()), kFormNames[size_t(l.form)].data(), l.meanApart,
      l.meanErrors, l.worstBlock, l.otherHits, l.pixels, l.wrong.empty() ? "" : ": ", l.wrong.c_str());
}

}  // namespace fragtrace
