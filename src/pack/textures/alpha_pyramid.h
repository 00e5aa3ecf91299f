// SPDX-License-Identifier: MIT
// The greatest alpha of a picture's parts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

namespace fragtrace {

/// A square grid on each level. A cell of level 0 covers 4 x 4 texels, a cell of the next one four cells of
/// the level before, up to a single cell for all. A pyramid without levels knows nothing.
struct AlphaPyramid {
  static constexpr int kCellBits = 2;

  std::vector<std::vector<uint8_t>> levels;  ///< 255 is an alpha of 1; rounded up

  /// Returns true if an alpha of the texels from `low` to `high`, both included, may be above `most`.
  bool exceeds(glm::ivec2 low, glm::ivec2 high, int most) const;
};

/// Fills the cells of a level from those of the level below.
std::vector<uint8_t> coarser(std::span<const uint8_t> cells);

template <typename Value>
AlphaPyramid alphaPyramidOf(std::span<const Value> rgba, glm::ivec2 size) {
  constexpr uint32_t kOne = std::numeric_limits<Value>::max();
  const int larger = std::max(size.x, size.y);
  size_t side = 1;
  while (int64_t(side) << AlphaPyramid::kCellBits < larger) side *= 2;
  std::vector<uint8_t> cells(side * side);
  for (size_t y = 0; y < size_t(size.y); ++y) {
    uint8_t* row = &cells[(y >> AlphaPyramid::kCellBits) * side];
    for (size_t x = 0; x < size_t(size.x); ++x) {
      const uint32_t alpha = rgba[(y * size_t(size.x) + x) * 4 + 3];
      uint8_t& cell = row[x >> AlphaPyramid::kCellBits];
      cell = std::max(cell, uint8_t((alpha * 255u + kOne - 1u) / kOne));
    }
  }
  AlphaPyramid pyramid;
  pyramid.levels.push_back(std::move(cells));
  while (pyramid.levels.back().size() > 1) pyramid.levels.push_back(coarser(pyramid.levels.back()));
  return pyramid;
}

}  // namespace fragtrace
