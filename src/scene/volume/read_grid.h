// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/vectors.h"
#include "scene/volume/grid.h"

namespace fragtrace {

// Colours of spectra.

/// Colour matching functions of the CIE's 1931 observer, as X, Y, Z at a wavelength in nanometres: the fit of
/// Wyman, Sloan and Shirley (Simple Analytic Approximations to the CIE XYZ Color Matching Functions, JCGT
/// 2(2), 2013).
glm::dvec3 observer(double nanometres);

/// Linear sRGB of X, Y, Z; colours outside of sRGB have negative parts.
glm::dvec3 srgbOf(const glm::dvec3& xyz);

// Grids of NanoVDB files (.nvdb), read by a worker process.

struct GridDescription {
  std::string name;
  std::string type;        ///< type of the values, by NanoVDB's name
  bool isDensity = false;  ///< the grid has plain numbers and is no level set: it may be a volume
  glm::ivec3 voxels{0};    ///< size of the box of the active voxels
  uint64_t activeVoxels = 0;
  double largest = 0.0;  ///< the largest value; listGrids() sets it and the next
  BoundsDouble box{};    ///< box of the bricks above 0, in the file's own space; may be empty
};

/// The grids of a file, of which there is one at least. Those of densities are decoded. Throws InputError,
/// which names the file.
std::vector<GridDescription> listGrids(const std::filesystem::path& path, uint64_t memoryBytes);

/// The grid that the source names; where it names none, `density`, or the first that may be a density. Where
/// the source emits, with the radiance of a black body at the grid `temperature` (kelvin) of the same file.
/// `file` holds the bytes of the file; if it is empty, they are read. Throws InputError, which names file and
/// grid, also where the grid and all that is read with it take more than so many bytes.
VolumeGrid readGrid(const VolumeSource& source, std::span<const uint8_t> file, uint64_t memoryBytes);

/// The grid that the worker sends (scene/volume/decode.h), which is not trusted more than the file is.
/// Throws std::runtime_error.
VolumeGrid gridOfAnswer(std::span<const uint8_t> answer);

}  // namespace fragtrace
