// SPDX-License-Identifier: MIT
#include "pack/pack_grid.h"

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "base/words.h"

namespace fragtrace {

namespace {

static_assert(layout::kBrickTexels * 4 == kBrickVoxels);

/// Largest values of a brick: of all voxels, and of those at its lower sides. Bit 0 of the index means X = 0,
/// bit 1 Y = 0, bit 2 Z = 0. Half floats that are not negative have the order of their bits.
using Largest = std::array<uint16_t, 8>;

Largest largestOf(const uint16_t* values) {
  Largest largest{};
  for (int i = 0; i < int(kBrickVoxels); ++i) {
    const uint32_t sides =
        uint32_t((i & 7) == 0) | uint32_t(((i >> 3) & 7) == 0) << 1 | uint32_t((i >> 6) == 0) << 2;
    for (uint32_t s = 0; s < 8; ++s) {
      if ((s & ~sides) == 0) largest[s] = std::max(largest[s], values[i]);
    }
  }
  return largest;
}

void appendHalves(Words& texels, const uint16_t* halves, size_t count) {
  for (size_t i = 0; i < count; i += 2) texels.push_back(uint32_t(halves[i]) | uint32_t(halves[i + 1]) << 16);
}

/// The table has an entry for the bricks before the first along each axis, too.
size_t tableTexelsOf(const VolumeGrid& grid) {
  const glm::ivec3 bricks = grid.bricks + 1;
  return size_t(bricks.x) * size_t(bricks.y) * size_t(bricks.z);
}

size_t texelsPerBrick(const VolumeGrid& grid) {
  return size_t(layout::kBrickTexels) + (grid.radiance.empty() ? 0 : kBrickVoxels);
}

}  // namespace

size_t texelsOf(const VolumeGrid& grid) {
  return tableTexelsOf(grid) + grid.values.size() / kBrickVoxels * texelsPerBrick(grid);
}

PackedGrid packGrid(const VolumeGrid& grid, Words& texels) {
  PackedGrid packed;
  packed.bricks = grid.bricks + 1;
  packed.largest = grid.largest;
  packed.brightest = grid.brightest;
  const glm::dmat4 toBricks = glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / kBrickSide));
  packed.fromFile = toBricks * glm::translate(glm::dmat4(1.0), glm::dvec3(kBrickSide - grid.minimum)) *
                    glm::inverse(grid.toWorld);

  const size_t stored = grid.values.size() / kBrickVoxels;
  std::vector<Largest> largest(stored);
  for (size_t i = 0; i < stored; ++i) largest[i] = largestOf(&grid.values[i * kBrickVoxels]);
  const auto tableTexels = uint32_t(tableTexelsOf(grid));
  const auto perBrick = uint32_t(texelsPerBrick(grid));
  texels.reserve(2 * texelsOf(grid));

  for (int z = -1; z < grid.bricks.z; ++z) {
    for (int y = -1; y < grid.bricks.y; ++y) {
      for (int x = -1; x < grid.bricks.x; ++x) {
        // Interpolation at a brick's upper sides also reads the lower sides of the next bricks.
        uint16_t most = 0;
        for (uint32_t s = 0; s < 8; ++s) {
          const uint32_t number = grid.entryOf(glm::ivec3(x, y, z) + glm::ivec3(s & 1, (s >> 1) & 1, s >> 2));
          if (number > 0) most = std::max(most, largest[number - 1][s]);
        }
        const uint32_t number = grid.entryOf({x, y, z});
        texels.push_back(number == 0 ? 0 : tableTexels + (number - 1) * perBrick);
        texels.push_back(floatWord(glm::unpackHalf1x16(most)));
      }
    }
  }
  for (size_t i = 0; i < stored; ++i) {
    appendHalves(texels, &grid.values[i * kBrickVoxels], kBrickVoxels);
    if (grid.radiance.empty()) continue;
    for (size_t v = i * kBrickVoxels; v < (i + 1) * kBrickVoxels; ++v) {
      const std::array<uint16_t, 4> rgb{grid.radiance[3 * v], grid.radiance[3 * v + 1],
                                        grid.radiance[3 * v + 2], 0};
      appendHalves(texels, rgb.data(), rgb.size());
    }
  }
  return packed;
}

}  // namespace fragtrace
