// SPDX-License-Identifier: MIT
#include "session/picture/black_picture.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/text.h"
#include "base/vectors.h"
#include "image/channels.h"
#include "scene/describe.h"
#include "session/file_light.h"

namespace fragtrace {

namespace {

constexpr double kNearlyAll = 0.99;
constexpr double kFewestPaths = 0.001;  // share: fewer is none
constexpr double kNoticedMetal = 0.5;   // share of what is seen
constexpr double kNoticedLight = 0.05;  // share of it

/// What a picture's pixels tell, without those that nothing covers.
struct Darkness {
  double black = 0.0;  ///< the share of the pixels that a display shows as black
  double lit = 0.0;    ///< the number of these that have any light
  double mean = 0.0;   ///< their logarithmic mean
};

Darkness darknessOf(const DrawnView& view) {
  constexpr double kBlack = 0.5 / 255.0 / 12.92;  // half of a display's first step
  const Image& picture = view.picture;
  const auto colors = findColorChannels(picture);
  if (!colors || picture.values.empty()) return {};
  const auto alpha = std::ranges::find(picture.channels, "A");
  const double exposure = std::exp2(view.options.output.exposure.value_or(0.0));
  Darkness dark;
  double count = 0.0;
  for (size_t i = 0; i < picture.values.size(); i += picture.channelCount()) {
    if (alpha != picture.channels.end() &&
        picture.values[i + size_t(alpha - picture.channels.begin())] == 0.0f)
      continue;
    ++count;
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c) color[c] = double(picture.values[i + (*colors)[size_t(c)]]);
    const double light = luminance(color);
    if (light * exposure >= kBlack) continue;
    ++dark.black;
    if (!(light > 0.0)) continue;
    dark.mean += std::log(light);
    ++dark.lit;
  }
  if (count == 0.0) return {};
  return {dark.black / count, dark.lit, dark.lit > 0.0 ? std::exp(dark.mean / dark.lit) : 0.0};
}

/// The scene as it was drawn, for paths on the processor.
struct LoadedAgain {
  Scene scene;
  Bvh tree;
};

LoadedAgain loadAgain(const DrawnView& view) {
  GltfOptions loading = gltfOptionsOf(view.options);
  loading.limits.strict = false;
  LoadedAgain again{loadGltf(view.options.scene, loading), {}};
  setLampScale(again.scene, view.loaded.light.lampScale);
  again.tree = buildSceneBvh(again.scene);
  return again;
}

/// Makes the backs of all surfaces like their fronts.
void turnAll(Scene& scene) {
  for (Material& m : scene.materials) m.doubleSided = true;
}

SeenLight seenBy(const DrawnView& view, const LoadedAgain& again) {
  const double aspect = double(view.loaded.size.x) / view.loaded.size.y;
  return seenLight({again.scene, again.tree}, view.loaded.camera, aspect);
}

std::string whyViewIsEmpty(const DrawnView& view) {
  const LoadedScene& loaded = view.loaded;
  const bool chosen = loaded.overrides == view.options.camera.overrides;
  const std::string nothing =
      std::string(chosen ? "this" : "the default") + " view shows nothing of the scene";
  LoadedAgain again = loadAgain(view);
  turnAll(again.scene);
  if (!seenBy(view, again).cells.empty())
    return nothing + " but backs, which are not drawn; --double-sided all draws them";
  return nothing + "; " +
         (chosen && !loaded.overrides.fit ? "--fit moves the camera until it does"
                                          : "--camera-position and --camera-focal-point choose another");
}

/// Why no light reaches what is seen; empty: it may be by chance.
std::string whyUnlit(const DrawnView& view) {
  LoadedAgain again = loadAgain(view);
  const SeenLight seen = seenBy(view, again);
  turnAll(again.scene);
  const SeenLight turned = seenBy(view, again);
  if (turned.meanLuminance(1.0) > 100.0 * seen.meanLuminance(1.0))
    return "the fronts of surfaces that would be lit, or shine, are turned away (--double-sided all)";
  const bool surrounded = view.loaded.environment.kind != Surroundings::None;
  if (!surrounded && !mayShine(again.scene)) return "there is no light (--studio, --sky, --hdri-file)";
  const bool closed = seen.open < kFewestPaths;
  const BoundsDouble& bounds = again.scene.bounds;
  const glm::dvec3& place = view.loaded.camera.position;
  const bool inside = glm::all(glm::lessThanEqual(bounds.minimum, place)) &&
                      glm::all(glm::lessThanEqual(place, bounds.maximum));
  if (closed && inside)
    return "the camera stands inside the scene, in a closed shell that light from outside does not enter; "
           "--fit "
           "moves it out";
  if (closed) return "no light from outside reaches what it sees, which is closed in";
  const bool isReached = seen.meanLuminance(1.0) > 0.0;
  if (isReached && seen.smoothMetal > kNoticedMetal)
    return "smooth metal has nothing to reflect (--studio, --sky, --hdri-file)";
  if (!surrounded && !isReached)
    return "the scene's own light is out of sight of all that is seen (--studio, --sky, --hdri-file)";
  if (samplesPerPixel(view.stats) < 16.0) return "";
  return "nearly all camera paths end in the dark; " +
         std::string(inside
                         ? "the camera stands inside the scene, perhaps in a closed shell; --fit moves it out"
                         : "no light reaches what it sees (--studio, --sky, --hdri-file)");
}

std::string whyBlack(const DrawnView& view) {
  const Darkness dark = darknessOf(view);
  if (dark.black < kNearlyAll) return "";
  const std::string black = std::to_string(int(100.0 * dark.black)) + " % of the pixels are black: ";
  const double pixels = double(view.stats.size.x) * view.stats.size.y;
  const auto hit = double(view.stats.film.hitPixels);
  if (hit < (1.0 - kNearlyAll) * pixels) return black + "the scene fills less than 1 % of the view (--fit)";
  if (dark.lit > kNoticedLight * hit)
    return black + formatted("there is light, too little for this exposure (--exposure %.0f)",
                             std::ceil(std::log2(kMiddleGrey / dark.mean)));
  const std::string why = whyUnlit(view);
  return why.empty() ? "" : black + why;
}

}  // namespace

std::string whyNothingIsSeen(const DrawnView& view) {
  const Statistics& stats = view.stats;
  const bool isView = view.options.output.debugView == DebugView::None;
  const bool nothing = (stats.scene.triangles == 0 && stats.scene.spheres == 0) ||
                       hasNoArea(view.loaded.scene);  // which is said
  if (!isView || nothing || view.options.camera.region || stats.film.samples == 0) return "";
  try {
    if (stats.film.hitPixels == 0) return whyViewIsEmpty(view);
    return has(view.options.stages, Stage::Gi) ? whyBlack(view) : "";
  } catch (const InputError&) {
    return "";  // the file has changed meanwhile
  }
}

}  // namespace fragtrace
