// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "image/image.h"

namespace fragtrace {

// Equirectangular maps averaged about each direction.

/// An equirectangular map in doubles, with each channel of a row separate, so that rows are summed as a
/// whole.
struct MapRows {
  using Row = std::array<std::vector<double>, 3>;  ///< red, green, blue
  int width = 0;
  std::vector<Row> rows;

  MapRows(int columns, int rowCount);
  int height() const { return int(rows.size()); }
};

/// The weight, at most 1, of light at an angle of this cosine. It falls with the angle.
using Lobe = std::function<double(double cosine)>;

/// The map averaged with a lobe about each direction. Weights below `least` do not count, and no weight
/// beyond `reach` (radians) is above it. The result has as many columns as the map; `polar` are the angles of
/// its rows from +Y. Uses all processors.
MapRows averagedMap(const MapRows& map, const std::vector<double>& polar, const Lobe& lobe, double least,
                    double reach);

/// The least blur that shows in a map of the size that it gets, degrees.
inline constexpr double kLeastBlur = 0.5;

/// An equirectangular map with R, G, B as seen through frosted glass: each direction is the mean of the map,
/// weighted by exp(-angle^2 / (2 sigma^2)), with sigma in degrees, at least kLeastBlur. It has as many texels
/// as its details need. Uses all processors.
Image blurredMap(const Image& map, double sigma);

// The sun of an environment map that is read from a file.

/// The brightest places of a map.
struct MapSun {
  float level = 0.0f;  ///< luminance from which on a place, filtered, is one of them
  double power = 0.0;  ///< luminance that they send to a disk of unit radius: pi times its integral over them
};

/// The places of an equirectangular map with R, G, B that light paths begin at: the brightest texels, which
/// take up at most 0.03 sr and are at least twice as bright as the mean. None if they give less than a fifth
/// of the map's light: camera paths find what is so even.
std::optional<MapSun> sunOfMap(const Image& map);

}  // namespace fragtrace
