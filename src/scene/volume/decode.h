// SPDX-License-Identifier: MIT
// The worker's module for NanoVDB files. Its input is a request and the bytes of the file; its output either
// a GridListing and that many GridEntry, or a GridHeader, the table of bricks (32 bits per brick) and the
// values of those that are stored (16 bits a voxel): scene/volume/grid.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "base/worker/module.h"

namespace fragtrace {

inline constexpr size_t kGridNameBytes = 128;

struct GridRequest {
  uint64_t list = 0;                        ///< 1: list the grids; 0: decode one
  std::array<char, kGridNameBytes> name{};  ///< ends with a zero; of the grid to decode
};

inline constexpr size_t kMostGrids = 1000;

struct GridListing {
  uint64_t count = 0;
};

struct GridEntry {
  std::array<char, kGridNameBytes> name{};
  uint64_t isDensity = 0;            ///< 1: the values may be densities or temperatures
  std::array<int32_t, 3> minimum{};  ///< index of the first active voxel
  std::array<int32_t, 3> maximum{};  ///< and of the last; less than the first where there is none
  uint64_t activeVoxels = 0;
  std::array<char, 32> type{};
};

struct GridHeader {
  std::array<int32_t, 3> minimum{};  ///< index of the first voxel of the first brick
  std::array<int32_t, 3> bricks{};
  uint64_t stored = 0;  ///< bricks
  double largest = 0.0;
  /// The vectors of one step of an index along X, then Y, then Z, in the file's space.
  std::array<double, 9> axes{};
  std::array<double, 3> origin{};  ///< the place of index 0
};

/// Decodes one grid, without the file's header. Throws std::runtime_error where its numbers are no densities,
/// or the output has no room for them. No bytes lead out of `grid`.
void decodeGrid(std::span<uint8_t> grid, WorkOutput& output);

}  // namespace fragtrace
