// SPDX-License-Identifier: MIT
#include "session/picture/picture_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/errors.h"
#include "base/text.h"
#include "base/vectors.h"
#include "image/channels.h"
#include "image/display/heatmap.h"
#include "image/display/tone_map.h"
#include "image/files/process.h"
#include "image/files/video_format.h"
#include "image/format.h"
#include "render/film/film_pixels.h"
#include "scene/camera.h"
#include "scene/describe.h"
#include "session/environment.h"
#include "session/tracer.h"

namespace fragtrace {

namespace {

/// The four columns by which a row vector is multiplied, as rows of numbers.
std::vector<float> matrixOf(const std::array<glm::dvec4, 4>& columns) {
  std::vector<float> numbers;
  for (int row = 0; row < 4; ++row) {
    for (const glm::dvec4& column : columns) numbers.push_back(float(column[row]));
  }
  return numbers;
}

/// The coordinate of a point (x, y, z, 1) along an axis from an origin.
glm::dvec4 along(const glm::dvec3& axis, const glm::dvec3& origin) { return {axis, -glm::dot(axis, origin)}; }

/// Draws lines over the displayed picture, which lies at that place.
void drawLines(Image& display, std::span<const PictureLine> lines, const Placement& placement) {
  const glm::vec3 orange(1.0f, 0.55f, 0.1f);
  const glm::dvec2 half = 0.5 * glm::dvec2(placement.whole) * glm::dvec2(1.0, -1.0);
  const glm::dvec2 middle = 0.5 * glm::dvec2(placement.whole) - glm::dvec2(placement.corner);
  for (const PictureLine& line : lines)
    drawLine(display, middle + line.from * half, middle + line.to * half, orange);
}

/// A name next to the output that does not exist yet.
std::filesystem::path rescuePath(std::filesystem::path output) {
  const std::string stem = output.stem().string();
  output.replace_extension(".pfm");
  std::error_code error;
  for (int i = 2; std::filesystem::exists(std::filesystem::symlink_status(output, error)); ++i)
    output.replace_filename(stem + "-" + std::to_string(i) + ".pfm");
  return output;
}

/// Names what a picture loses in a .pfm: "the layers albedo, A and what merge needs".
std::string lostInPfm(const RenderOptions& options, const Image& linear) {
  std::set<std::string> layers;
  for (const std::string& channel : linear.channels) {
    if (channel != "R" && channel != "G" && channel != "B")
      layers.insert(channel == "A" ? "alpha" : channel.substr(0, channel.find('.')));
  }
  std::string lost = joined(layers);
  const auto add = [&](const char* more) { lost += (lost.empty() ? "" : " and ") + std::string(more); };
  if (holdsDisplay(options.output.file)) add("what only a display has (exposure, tone curve, boxes)");
  if (!linear.attributes.empty()) add("what merge needs");
  return lost;
}

}  // namespace

void setCamera(Image& image, const Camera& camera, glm::ivec2 size) {
  const Projection view = projectionOf(camera, double(size.x) / size.y);
  const glm::dvec4 right = along(glm::normalize(view.right), view.position);
  const glm::dvec4 up = along(glm::normalize(view.up), view.position);
  const glm::dvec4 depth = along(view.forward, view.position);
  const glm::dvec4 one(0.0, 0.0, 0.0, 1.0);
  const bool perspective = view.type == CameraType::Perspective;
  const glm::dvec4 w = perspective ? depth : one;
  const double halfWidth = glm::length(view.right);
  const double halfHeight = glm::length(view.up);
  image.numbers["worldToCamera"] = matrixOf({right, up, depth, one});
  if (!isRectilinear(view.type)) return;
  // The third coordinate only makes the matrix invertible: 1 - 1 / depth of a perspective, else the depth.
  image.numbers["worldToNDC"] =
      matrixOf({0.5 * (w + right / halfWidth - view.shift.x * w),
                0.5 * (w - up / halfHeight + view.shift.y * w), perspective ? depth - one : depth, w});
  if (perspective) image.numbers["screenWindowWidth"] = {float(2.0 * halfWidth)};
}

void setChromaticities(Image& image) {
  image.numbers["chromaticities"] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
}

bool showsColors(const RenderOptions& options) { return options.output.debugView != DebugView::None; }

Image shownPicture(const RenderOptions& options, const FilmPixels& pixels, const Layers& layers,
                   std::span<const double> variance) {
  Image picture = imageOf(pixels, layers, variance);
  if (options.output.debugView == DebugView::Visits) return paintHeatmap(picture);
  if (options.output.debugView != DebugView::None)
    replaceColor(picture, debugPicture(options.output.debugView, pixels, variance));
  return picture;
}

std::vector<PictureLine> treeLines(const RenderOptions& options, const LoadedScene& loaded,
                                   const Camera& camera, glm::ivec2 size) {
  if (!options.output.treeLevel) return {};
  const std::vector<Bounds> boxes = boxesAtLevel(loaded.bvh, uint32_t(*options.output.treeLevel));
  if (boxes.empty())
    say(options, "warning: the tree has no level " + std::to_string(*options.output.treeLevel));
  return boxEdges(boxes, projectionOf(camera, double(size.x) / size.y), loaded.scene.space);
}

void checkPictureWritable(const RenderOptions& options, glm::ivec2 size) {
  if (holdsDisplay(options.output.file) && options.output.ocio.isAsked())
    shownByView({1, 1, {"R", "G", "B"}, {0.0f, 0.0f, 0.0f}, {}}, options.output.ocio);
  if (videoFormatOf(options.output.file) != nullptr) return;  // checkVideo() has tried
  checkImageWritable(options.output.file, size.x, size.y, channelsOf(options), options.output.encoding,
                     !options.output.toStandardOutput, options.output.place);
}

std::string rescuePicture(const RenderOptions& options, const Image& linear, const std::string& reason) {
  const bool isVideo = videoFormatOf(options.output.file) != nullptr;
  if (options.output.toStandardOutput || isVideo || formatOfName(options.output.file) == ImageFormat::Pfm)
    return reason;
  const std::filesystem::path path = rescuePath(options.output.file);
  try {
    writeImage(path, linear);
  } catch (const std::exception& error) {
    // If the folder is gone, both messages say so.
    const std::string other = error.what();
    const auto cause = [](const std::string& text) { return text.substr(text.rfind(": ") + 1); };
    return reason + "; nor as .pfm" + (cause(other) == cause(reason) ? "" : ": " + other);
  }
  const std::string lost = lostInPfm(options, linear);
  return reason + "; the " + (showsColors(options) ? "colours" : "radiance") + " alone is in " +
         path.string() + (lost.empty() ? "" : ", lost: " + lost);
}

void sayClamped(const RenderOptions& options, size_t values) {
  if (values == 0) return;
  say(options, "warning: " + placeOf(options.output).string() + ": " + std::to_string(values) +
                   " values are beyond 65504, the largest 16-bit float, and clamped to it (--half)");
}

namespace {

void writeOut(const RenderOptions& options, const Image& image) {
  const OutputOptions& out = options.output;
  sayClamped(options, out.toStandardOutput ? printImage(out.file, image, out.encoding)
                                           : writeImage(out.file, image, out.encoding, out.place));
}

/// Bits per channel of an output that holdsDisplay().
int bitsOf(const OutputOptions& output) {
  if (const auto form = pixelFormOf(output.file)) return form->bits;
  if (const VideoFormat* const video = videoFormatOf(output.file)) return video->pixels.bits;
  return formatOfName(output.file) == ImageFormat::Jpeg ? 8 : output.encoding.pngBits;
}

/// Returns true if the page is expected to blend sRGB values: browsers and offices do, and shadows and glass
/// show it.
bool blendsValues(const RenderOptions& options) {
  if (options.output.alpha != AlphaOf::Auto) return options.output.alpha == AlphaOf::Display;
  return (options.light.shadowCatcher || options.light.transparentGlass) && !showsColors(options);
}

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

Image displayedPicture(const RenderOptions& options, const Image& linear,
                       std::span<const PictureLine> lines) {
  const bool colors = showsColors(options);
  const double exposure = colors ? 0.0 : options.output.exposure.value_or(0.0);
  const ToneMap curve = colors ? ToneMap::Linear : options.output.toneMap;
  const std::optional<glm::vec3> page = pageOf(options);
  const auto shown = [&](const Image& picture) {
    return colors || !options.output.ocio.isAsked()
               ? toDisplay(picture, exposure, curve)
               : shownByView(exposedColors(picture, exposure), options.output.ocio);
  };
  Image display = page && findChannel(linear, "A")         ? toDisplayOver(*page, linear, exposure, curve)
                  : holdsDisplayAlpha(options.output.file) ? shown(linear)
                                                           : shown(withoutAlpha(linear));
  if (blendsValues(options)) display = forBlendedValues(std::move(display));
  const Placement place = linear.placement.value_or(Placement{{0, 0}, {linear.width, linear.height}});
  if (options.output.dither && bitsOf(options.output) == 8 && !colors) dither(display, place.corner);
  drawLines(display, lines, place);
  return display;
}

void writePicture(const RenderOptions& options, const Image& linear, std::span<const PictureLine> lines) {
  if (!holdsDisplay(options.output.file)) return writeOut(options, linear);
  writeOut(options, displayedPicture(options, linear, lines));
}

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
