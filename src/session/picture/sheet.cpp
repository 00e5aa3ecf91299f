// SPDX-License-Identifier: MIT
#include "session/picture/sheet.h"

#include <algorithm>
#include <cmath>

#include "view/shown_text.h"

namespace fragtrace {

namespace {

constexpr int kMargin = 12;    // pixels around a cell
constexpr int kNameLines = 2;  // longer names end in dots
constexpr int kLineHeight = 16;
constexpr size_t kMostCharacters = 600;
constexpr glm::vec3 kInk{0.13f};
constexpr glm::vec3 kFailedInk{0.62f, 0.08f, 0.06f};
constexpr glm::vec3 kFailedPaper{0.93f};

/// Calls `draw` with each pixel of a rectangle that lies in the sheet, and its place in the rectangle.
template <typename Draw>
void forPixels(Image& sheet, glm::ivec2 corner, glm::ivec2 size, const Draw& draw) {
  const glm::ivec2 from = glm::max(-corner, glm::ivec2(0));
  const glm::ivec2 to = glm::min(size, glm::ivec2(sheet.width, sheet.height) - corner);
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) draw(sheet.pixel(corner.x + x, corner.y + y), x, y);
  }
}

void mix(float* pixel, const glm::vec3& color, float share) {
  for (int c = 0; c < 3; ++c) pixel[c] += share * (color[c] - pixel[c]);
}

/// Puts a picture into the middle of a cell; the page is seen where it has alpha.
void drawPicture(Image& sheet, const Image& picture, const SheetLayout& layout, int index) {
  const glm::ivec2 size(picture.width, picture.height);
  const size_t channels = picture.channelCount();
  forPixels(sheet, layout.corner(index) + (layout.cell - size) / 2, size, [&](float* pixel, int x, int y) {
    const float* from = picture.pixel(x, y);
    mix(pixel, {from[0], from[1], from[2]}, channels > 3 ? from[3] : 1.0f);
  });
}

void drawText(Image& sheet, const Letters& letters, glm::ivec2 corner, const glm::vec3& color) {
  forPixels(sheet, corner, {letters.width, letters.height}, [&](float* pixel, int x, int y) {
    mix(pixel, color, float(letters.coverage[size_t(y) * size_t(letters.width) + size_t(x)]) / 255.0f);
  });
}

/// Writes the reason into the middle of the cell.
void drawFailure(Image& sheet, const std::string& reason, const SheetLayout& layout, int index,
                 WriteLetters* write) {
  const glm::ivec2 corner = layout.corner(index);
  forPixels(sheet, corner, layout.cell, [](float* pixel, int, int) { mix(pixel, kFailedPaper, 1.0f); });
  const glm::ivec2 inside = layout.cell - 2 * kMargin;
  const Letters letters =
      write(shownText(reason, kMostCharacters), std::max(inside.x, 1), std::max(inside.y / kLineHeight, 1));
  drawText(sheet, letters, corner + (layout.cell - glm::ivec2(letters.width, letters.height)) / 2,
           kFailedInk);
}

}  // namespace

glm::ivec2 SheetLayout::size() const {
  return glm::ivec2(columns, rows) * (cell + glm::ivec2(0, nameHeight) + kMargin) + kMargin;
}

glm::ivec2 SheetLayout::corner(int index) const {
  const glm::ivec2 place(index % columns, index / columns);
  return place * (cell + glm::ivec2(0, nameHeight) + kMargin) + kMargin;
}

SheetLayout layoutSheet(int count, glm::ivec2 cell, int columns) {
  if (columns == 0) columns = int(std::ceil(std::sqrt(double(count))));
  columns = std::clamp(columns, 1, count);
  return {cell, columns, (count + columns - 1) / columns, kNameLines * kLineHeight + kMargin / 2};
}

Image drawSheet(const SheetLayout& layout, const std::vector<SheetCell>& cells, WriteLetters* write) {
  const glm::ivec2 size = layout.size();
  Image sheet{size.x, size.y, {"R", "G", "B"}, {}, {}};
  sheet.values.assign(size_t(size.x) * size_t(size.y) * 3, 1.0f);
  for (int i = 0; i < int(cells.size()); ++i) {
    const SheetCell& cell = cells[size_t(i)];
    if (cell.failure.empty())
      drawPicture(sheet, readImage(cell.picture), layout, i);
    else
      drawFailure(sheet, cell.failure, layout, i, write);
    const Letters name = write(shownText(cell.name, kMostCharacters), layout.cell.x, kNameLines);
    drawText(sheet, name, layout.corner(i) + glm::ivec2(0, layout.cell.y + kMargin / 4), kInk);
  }
  return sheet;
}

}  // namespace fragtrace
