// SPDX-License-Identifier: MIT
#include "cli/picture_file.h"

#include "image/channels.h"
#include "image/format.h"
#include "image/heatmap.h"
#include "image/lines.h"
#include "image/tone_map.h"
#include "render/debug_picture.h"
#include "scene/projection.h"

namespace fragtrace {

namespace {

/// Lines over what a display shows of the picture.
void drawLines(Image& display, std::span<const PictureLine> lines) {
  const glm::vec3 orange(1.0f, 0.55f, 0.1f);
  const glm::dvec2 half(0.5 * display.width, -0.5 * display.height);
  const glm::dvec2 middle(0.5 * display.width, 0.5 * display.height);
  for (const PictureLine& line : lines)
    drawLine(display, middle + line.from * half, middle + line.to * half, orange);
}

}  // namespace

bool showsColors(const RenderOptions& options) {
  return has(options.stages, Stage::BvhHeatmap) || options.debugView != DebugView::None;
}

Image shownPicture(const RenderOptions& options, const ShaderVariant& variant, const FilmPixels& pixels,
                   const Layers& layers, std::span<const double> variance) {
  Image picture = imageOf(pixels, layers, variance);
  if (has(variant.stages, Stage::BvhHeatmap)) return paintHeatmap(picture);
  if (options.debugView != DebugView::None)
    replaceColor(picture, debugPicture(options.debugView, pixels, variance));
  return picture;
}

std::vector<PictureLine> treeLines(const RenderOptions& options, const LoadedScene& loaded,
                                   const Camera& camera, glm::ivec2 size) {
  if (!options.treeLevel) return {};
  const std::vector<Bounds> boxes = boxesAtLevel(loaded.bvh, uint32_t(*options.treeLevel));
  if (boxes.empty()) say(options, "warning: the tree has no level " + std::to_string(*options.treeLevel));
  return boxEdges(boxes, projectionOf(camera, double(size.x) / size.y), loaded.scene.space);
}

void writePicture(const RenderOptions& options, const Image& linear, std::span<const PictureLine> lines) {
  if (!isDisplayFormat(options.output)) return writeImage(options.output, linear);
  const bool colors = showsColors(options);
  const bool keepsAlpha = formatOfName(options.output) == ImageFormat::Png;
  Image display = toDisplay(keepsAlpha ? linear : withoutAlpha(linear), colors ? 0.0 : options.exposure,
                            colors ? ToneMap::Linear : options.toneMap);
  drawLines(display, lines);
  writeImage(options.output, display);
}

}  // namespace fragtrace
