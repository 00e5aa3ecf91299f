// SPDX-License-Identifier: MIT
// Reads NanoVDB files by the headers of OpenVDB. Its C interface follows a file's offsets with a check of
// each, so that no offset leads out of the grid.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <istream>
#include <span>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#include <nanovdb/util/IO.h>
#define PNANOVDB_C
#define PNANOVDB_BUF_BOUNDS_CHECK
#include <nanovdb/PNanoVDB.h>
#pragma GCC diagnostic pop

#include "base/message.h"
#include "base/worker/module.h"
#include "scene/volume/decode.h"
#include "scene/volume/grid.h"

namespace fragtrace {
namespace {

/// A file in memory, as the library reads one.
class MemoryFile : public std::streambuf {
 public:
  explicit MemoryFile(std::span<const uint8_t> bytes) {
    char* const begin = reinterpret_cast<char*>(const_cast<uint8_t*>(bytes.data()));
    setg(begin, begin, begin + bytes.size());
  }

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type base = from == std::ios_base::cur   ? gptr() - eback()
                          : from == std::ios_base::end ? egptr() - eback()
                                                       : 0;
    off_type place = 0;
    if (__builtin_add_overflow(base, offset, &place) || place < 0 || place > egptr() - eback())
      return pos_type(-1);
    setg(eback(), eback() + place, egptr());
    return place;
  }
};

bool isDensityType(nanovdb::GridType type) {
  using nanovdb::GridType;
  return type == GridType::Float || type == GridType::Double || type == GridType::Fp4 ||
         type == GridType::Fp8 || type == GridType::Fp16 || type == GridType::FpN;
}

/// Reads by the library; what that throws says little to who has never seen NanoVDB.
template <typename Read>
auto readBy(std::span<const uint8_t> bytes, const Read& read) {
  MemoryFile file(bytes);
  std::istream stream(&file);
  try {
    return read(stream);
  } catch (const std::exception& error) {
    throw std::runtime_error("is broken, or not a NanoVDB file (" + std::string(error.what()) + ")");
  }
}

std::vector<nanovdb::io::GridMetaData> entriesOf(std::span<const uint8_t> bytes) {
  return readBy(bytes, [](std::istream& file) { return nanovdb::io::readGridMetaData(file); });
}

template <size_t N>
void copyText(std::array<char, N>& to, const std::string& text) {
  std::memcpy(to.data(), text.data(), std::min(text.size(), N - 1));
}

void listGrids(std::span<const uint8_t> bytes, WorkOutput& output) {
  std::vector<nanovdb::io::GridMetaData> grids = entriesOf(bytes);
  grids.resize(std::min(grids.size(), kMostGrids));
  const GridListing listing{grids.size()};
  output.append(asMessage(listing));
  for (const nanovdb::io::GridMetaData& grid : grids) {
    GridEntry entry;
    copyText(entry.name, grid.gridName);
    const bool known = grid.gridType < nanovdb::GridType::End;
    const bool levelSet = grid.gridClass == nanovdb::GridClass::LevelSet;
    copyText(entry.type, std::string(known ? nanovdb::toStr(grid.gridType) : "unknown") +
                             (levelSet ? ", a level set" : ""));
    entry.isDensity = isDensityType(grid.gridType) && !levelSet;
    entry.activeVoxels = grid.voxelCount;
    for (int axis = 0; axis < 3; ++axis) {
      entry.minimum[size_t(axis)] = grid.indexBBox.min()[axis];
      entry.maximum[size_t(axis)] = grid.indexBBox.max()[axis];
    }
    output.append(asMessage(std::as_const(entry)));
  }
}

/// A view of one grid. Its bytes stay where they are.
class Grid {
 public:
  explicit Grid(std::span<uint8_t> bytes)
      : buffer_(
            pnanovdb_make_buf(reinterpret_cast<uint32_t*>(bytes.data()), bytes.size() / sizeof(uint32_t))),
        type_(pnanovdb_grid_get_grid_type(buffer_, {})) {
    if (!isDensityType(nanovdb::GridType(type_))) throw std::runtime_error("its grid holds no plain numbers");
    root_ = pnanovdb_tree_get_root(buffer_, pnanovdb_grid_get_tree(buffer_, {}));
    pnanovdb_readaccessor_init(&accessor_, root_);
  }

  pnanovdb_coord_t minimum() const { return pnanovdb_root_get_bbox_min(buffer_, root_); }
  pnanovdb_coord_t maximum() const { return pnanovdb_root_get_bbox_max(buffer_, root_); }
  /// The number of tiles of 4,096^3 voxels. A search for the tile of a voxel looks at one after the other.
  uint32_t tiles() const { return pnanovdb_root_get_tile_count(buffer_, root_); }

  /// Returns true where all voxels of the brick that begins there have one value.
  bool isUniform(pnanovdb_coord_t at) {
    pnanovdb_uint32_t level = 0;
    pnanovdb_readaccessor_get_value_address_and_level(type_, buffer_, &accessor_, &at, &level);
    return level > 0;
  }

  /// Throws where the value is no number.
  double at(pnanovdb_coord_t place) {
    pnanovdb_uint32_t level = 0;
    const pnanovdb_address_t address =
        pnanovdb_readaccessor_get_value_address_and_level(type_, buffer_, &accessor_, &place, &level);
    const double value = read(address, place, level);
    if (!std::isfinite(value))
      throw std::runtime_error("voxel (" + std::to_string(place.x) + ", " + std::to_string(place.y) + ", " +
                               std::to_string(place.z) + ") is not finite");
    return value;
  }

  void place(GridHeader& header) const {
    const pnanovdb_map_handle_t map = pnanovdb_grid_get_map(buffer_, {});
    for (uint32_t row = 0; row < 3; ++row) {
      header.origin[row] = pnanovdb_map_get_vecd(buffer_, map, row);
      for (uint32_t axis = 0; axis < 3; ++axis)
        header.axes[axis * 3 + row] = pnanovdb_map_get_matd(buffer_, map, row * 3 + axis);
    }
  }

 private:
  double read(pnanovdb_address_t address, pnanovdb_coord_t place, uint32_t level) const {
    switch (type_) {
      case PNANOVDB_GRID_TYPE_DOUBLE:
        return pnanovdb_read_double(buffer_, address);
      case PNANOVDB_GRID_TYPE_FP4:
        return double(pnanovdb_root_fp4_read_float(buffer_, address, &place, level));
      case PNANOVDB_GRID_TYPE_FP8:
        return double(pnanovdb_root_fp8_read_float(buffer_, address, &place, level));
      case PNANOVDB_GRID_TYPE_FP16:
        return double(pnanovdb_root_fp16_read_float(buffer_, address, &place, level));
      case PNANOVDB_GRID_TYPE_FPN:
        return double(pnanovdb_root_fpn_read_float(buffer_, address, &place, level));
      default:
        return double(pnanovdb_read_float(buffer_, address));
    }
  }

  pnanovdb_buf_t buffer_;
  pnanovdb_grid_type_t type_;
  pnanovdb_root_handle_t root_{};
  pnanovdb_readaccessor_t accessor_{};
};

int brickOf(int voxel) { return voxel >> 3; }

/// Its box in bricks. Throws where that is larger than any grid in use, or its table than the room for it.
void measure(const Grid& grid, size_t room, GridHeader& header) {
  constexpr int64_t kMostSide = 1 << 15;
  constexpr int64_t kMostBricks = int64_t(1) << 28;
  constexpr int64_t kTileBricks = 512;  // along a side of a tile at the root
  constexpr int64_t kFewTiles = 64;
  const pnanovdb_coord_t low = grid.minimum();
  const pnanovdb_coord_t high = grid.maximum();
  const std::array<int, 3> first{low.x, low.y, low.z};
  const std::array<int, 3> last{high.x, high.y, high.z};
  int64_t all = 1;
  int64_t tiles = 1;  // the most that the box touches
  for (size_t axis = 0; axis < 3; ++axis) {
    const int64_t count =
        last[axis] < first[axis] ? 0 : int64_t(brickOf(last[axis])) - brickOf(first[axis]) + 1;
    if (count == 0) return;
    if (count > kMostSide || std::abs(int64_t(first[axis])) > (1 << 30))
      throw std::runtime_error("its grid reaches over " + std::to_string(count * kBrickSide) +
                               " voxels along an axis, more than is supported");
    header.minimum[axis] = brickOf(first[axis]) * kBrickSide;
    header.bricks[axis] = int(count);
    all *= count;
    tiles *= count / kTileBricks + 2;
  }
  if (all > kMostBricks || size_t(all) * sizeof(uint32_t) > room)
    throw std::runtime_error("its grid reaches over more voxels than fit into memory");
  if (grid.tiles() > kFewTiles + 4 * tiles)
    throw std::runtime_error("its grid has " + std::to_string(grid.tiles()) +
                             " tiles at its root, many more than its box has room for");
}

/// Calls work(brick, its first voxel) for each brick in the order of the table.
template <typename Work>
void forEachBrick(const GridHeader& header, const Work& work) {
  for (int z = 0; z < header.bricks[2]; ++z) {
    for (int y = 0; y < header.bricks[1]; ++y) {
      for (int x = 0; x < header.bricks[0]; ++x) {
        work(pnanovdb_coord_t{header.minimum[0] + x * kBrickSide, header.minimum[1] + y * kBrickSide,
                              header.minimum[2] + z * kBrickSide});
      }
    }
  }
}

/// The values of a brick; those below 0, which are no densities, become 0. Returns the largest.
double readBrick(Grid& grid, pnanovdb_coord_t first, std::array<double, kBrickVoxels>& values) {
  if (grid.isUniform(first)) {
    values.fill(std::max(0.0, grid.at(first)));
    return values[0];
  }
  for (int i = 0; i < int(kBrickVoxels); ++i) {
    const pnanovdb_coord_t place{first.x + (i & 7), first.y + ((i >> 3) & 7), first.z + (i >> 6)};
    values[size_t(i)] = std::max(0.0, grid.at(place));
  }
  return *std::ranges::max_element(values);
}

}  // namespace

void decodeGrid(std::span<uint8_t> bytes, WorkOutput& output) {
  Grid grid(bytes);
  GridHeader header;
  measure(grid, output.room.size(), header);
  grid.place(header);
  std::array<double, kBrickVoxels> values{};
  std::vector<uint32_t> table;
  forEachBrick(header, [&](pnanovdb_coord_t first) {
    const double largest = readBrick(grid, first, values);
    header.largest = std::max(header.largest, largest);
    table.push_back(largest > 0.0 ? uint32_t(++header.stored) : 0);
  });
  const size_t needed =
      sizeof header + table.size() * sizeof(uint32_t) + header.stored * kBrickVoxels * sizeof(uint16_t);
  if (needed > output.room.size())
    throw std::runtime_error("its grid takes " + std::to_string(needed / 1'000'000) +
                             " MB, more than the memory limit");
  output.append(asMessage(std::as_const(header)));
  output.append({reinterpret_cast<const uint8_t*>(table.data()), table.size() * sizeof(uint32_t)});
  size_t next = 0;
  forEachBrick(header, [&](pnanovdb_coord_t first) {
    if (table[next++] == 0) return;
    readBrick(grid, first, values);
    std::array<uint16_t, kBrickVoxels> halves;
    std::ranges::transform(values, halves.begin(),
                           [&](double v) { return glm::packHalf1x16(float(v / header.largest)); });
    output.append({reinterpret_cast<const uint8_t*>(halves.data()), sizeof halves});
  });
}

extern "C" void fragtraceWork(std::span<const uint8_t> input, WorkOutput& output) {
  if (input.empty()) return;
  const auto request = takeMessage<GridRequest>(input);
  const std::string name(request.name.data(), ::strnlen(request.name.data(), request.name.size()));
  if (request.list != 0) return listGrids(input, output);
  nanovdb::GridHandle<nanovdb::HostBuffer> grid =
      readBy(input, [&](std::istream& file) { return nanovdb::io::readGrid(file, name); });
  decodeGrid({grid.data(), grid.size()}, output);
}

}  // namespace fragtrace
