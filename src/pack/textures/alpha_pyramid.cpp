// SPDX-License-Identifier: MIT
#include "pack/textures/alpha_pyramid.h"

namespace fragtrace {

namespace {

/// Returns true if a cell has an alpha above `most` within the cells from `low` to `high` of level 0.
bool cellExceeds(const AlphaPyramid& pyramid, size_t level, glm::ivec2 cell, glm::ivec2 low, glm::ivec2 high,
                 int most) {
  const int side = 1 << (pyramid.levels.size() - 1 - level);
  if (pyramid.levels[level][size_t(cell.y) * size_t(side) + size_t(cell.x)] <= most) return false;
  const glm::ivec2 first = cell << int(level);
  const glm::ivec2 last = first + ((1 << level) - 1);
  if (glm::any(glm::lessThan(last, low)) || glm::any(glm::lessThan(high, first))) return false;
  const bool isInside = glm::all(glm::lessThanEqual(low, first)) && glm::all(glm::lessThanEqual(last, high));
  if (level == 0 || isInside) return true;
  for (const glm::ivec2 corner : {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(1, 1)})
    if (cellExceeds(pyramid, level - 1, 2 * cell + corner, low, high, most)) return true;
  return false;
}

}  // namespace

bool AlphaPyramid::exceeds(glm::ivec2 low, glm::ivec2 high, int most) const {
  return levels.empty() ||
         cellExceeds(*this, levels.size() - 1, {0, 0}, low >> kCellBits, high >> kCellBits, most);
}

std::vector<uint8_t> coarser(std::span<const uint8_t> cells) {
  size_t side = 1;
  while (4 * side * side < cells.size()) ++side;
  std::vector<uint8_t> result(side * side);
  for (size_t y = 0; y < side; ++y) {
    for (size_t x = 0; x < side; ++x) {
      const uint8_t* top = &cells[4 * y * side + 2 * x];
      const uint8_t* bottom = top + 2 * side;
      result[y * side + x] = std::max({top[0], top[1], bottom[0], bottom[1]});
    }
  }
  return result;
}

}  // namespace fragtrace
