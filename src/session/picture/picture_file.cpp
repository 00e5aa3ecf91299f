// SPDX-License-Identifier: MIT
#include "session/picture/picture_file.h"

#include <set>

#include "base/text.h"
#include "image/channels.h"
#include "image/display/heatmap.h"
#include "image/display/lines.h"
#include "image/display/tone_map.h"
#include "image/files/video_format.h"
#include "image/format.h"
#include "render/film/debug_picture.h"
#include "scene/projection.h"
#include "session/picture_memory.h"

namespace fragtrace {

namespace {

/// Draws lines over the displayed picture, which lies at that place.
void drawLines(Image& display, std::span<const PictureLine> lines, const Placement& placement) {
  const glm::vec3 orange(1.0f, 0.55f, 0.1f);
  const glm::dvec2 half = 0.5 * glm::dvec2(placement.whole) * glm::dvec2(1.0, -1.0);
  const glm::dvec2 middle = 0.5 * glm::dvec2(placement.whole) - glm::dvec2(placement.corner);
  for (const PictureLine& line : lines)
    drawLine(display, middle + line.from * half, middle + line.to * half, orange);
}

/// A name beside the output that does not exist yet.
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
  if (videoFormatOf(options.output.file) != nullptr) return;  // checkVideo() has tried
  checkImageWritable(options.output.file, size.x, size.y, channelsOf(options), options.output.encoding,
                     !options.output.toStandardOutput);
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
  say(options, "warning: " + options.output.file.string() + ": " + std::to_string(values) +
                   " values are beyond 65504, the largest 16-bit float, and clamped to it (--half)");
}

namespace {

void writeOut(const RenderOptions& options, const Image& image) {
  const auto write = options.output.toStandardOutput ? printImage : writeImage;
  sayClamped(options, write(options.output.file, image, options.output.encoding));
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

}  // namespace

Image displayedPicture(const RenderOptions& options, const Image& linear,
                       std::span<const PictureLine> lines) {
  const bool colors = showsColors(options);
  const double exposure = colors ? 0.0 : options.output.exposure.value_or(0.0);
  const ToneMap curve = colors ? ToneMap::Linear : options.output.toneMap;
  const std::optional<glm::vec3> page = pageOf(options);
  Image display = page && findChannel(linear, "A")         ? toDisplayOver(*page, linear, exposure, curve)
                  : holdsDisplayAlpha(options.output.file) ? toDisplay(linear, exposure, curve)
                                                           : toDisplay(withoutAlpha(linear), exposure, curve);
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

}  // namespace fragtrace
