// SPDX-License-Identifier: MIT
// Equirectangular maps averaged about each direction.
#pragma once

#include <array>
#include <functional>
#include <vector>

namespace fragtrace {

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

/// Angles of the middles of rows from +Y.
std::vector<double> middlesOfRows(int rows);

}  // namespace fragtrace
