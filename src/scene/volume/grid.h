// SPDX-License-Identifier: MIT
// A grid of densities, as a cloud or smoke is stored, in bricks of voxels.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fragtrace {

inline constexpr int kBrickSide = 8;
inline constexpr size_t kBrickVoxels = size_t(kBrickSide) * kBrickSide * kBrickSide;

/// A voxel's value is that at its index; between these, values are interpolated linearly, and outside of all
/// bricks they are 0.
struct VolumeGrid {
  glm::ivec3 minimum{0};  ///< index of the first voxel of the first brick, a multiple of kBrickSide
  glm::ivec3 bricks{0};   ///< numbers of bricks along X, Y, Z
  std::vector<uint32_t>
      table;  ///< a brick, X fastest: 1 + its number among those that are stored; 0: it is empty
  std::vector<uint16_t> values;  ///< half floats, kBrickVoxels a stored brick, X fastest: parts of `largest`
  std::vector<uint16_t>
      radiance;             ///< half floats, R, G, B a voxel of `values`: parts of `brightest`; empty: none
  double largest = 0.0;     ///< density
  double brightest = 0.0;   ///< radiance, cd/m^2
  glm::dmat4 toWorld{1.0};  ///< the matrix from indices of voxels to the file's own space

  bool empty() const { return values.empty(); }

  /// The table's entry of a brick, counted along X, Y, Z; 0 outside of all bricks.
  uint32_t entryOf(const glm::ivec3& brick) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (brick[axis] < 0 || brick[axis] >= bricks[axis]) return 0;
    }
    return table[(size_t(brick.z) * size_t(bricks.y) + size_t(brick.y)) * size_t(bricks.x) + size_t(brick.x)];
  }
};

/// The largest value by which media scatter forward, or back.
inline constexpr double kMostAnisotropy = 0.99;

/// A grid's file, place and medium, as options or a scene ask for it.
struct VolumeSource {
  std::filesystem::path file;          ///< .nvdb; empty: there is none
  std::optional<std::string> grid;     ///< its name; none: the first of densities
  std::optional<glm::dvec3> position;  ///< place of the file's origin, metres
  std::optional<double> scale;         ///< metres a unit of the file's space; none: 1
  std::optional<double> density;       ///< extinction of a density of 1, 1/m; none: 1
  std::optional<glm::vec3> color;      ///< albedo of one scattering; none: 1
  std::optional<double> anisotropy;    ///< mean cosine of a scattering; above 0 forward; none: 0
  std::optional<double> emission;      ///< factor of a black body's radiance (readGrid()); none: 0

  bool emits() const { return emission.value_or(0.0) > 0.0; }
  bool operator==(const VolumeSource&) const = default;
};

inline constexpr double kLeastVolumeScale = 1e-9;
inline constexpr double kMostVolumeScale = 1e9;
inline constexpr double kMostVolumeFactor = 1e12;  ///< largest factor of density and emission

/// File and grid of FILE.nvdb or FILE.nvdb:GRID.
VolumeSource volumeFile(const std::string& text);

/// A grid in the scene.
struct Volume {
  VolumeSource source{};
  std::vector<uint8_t> file{};             ///< its bytes, where the scene's loader has read it
  std::shared_ptr<const VolumeGrid> grid;  ///< null: there is none
  glm::dmat4 toWorld{1.0};                 ///< the matrix from the file's space, metres

  /// Returns the matrix from indices of voxels to world space, metres.
  glm::dmat4 voxelsToWorld() const { return toWorld * grid->toWorld; }
  /// The corners of the box of its bricks, in world space, metres.
  std::array<glm::dvec3, 8> corners() const;
};

}  // namespace fragtrace
