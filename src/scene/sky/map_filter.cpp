// SPDX-License-Identifier: MIT
#include "scene/sky/map_filter.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"

namespace fragtrace {

namespace {

/// Adds row `from` of a map to the sums of a row at another angle from +Y, whose texels are as wide. So the
/// weight of a texel depends only on the number of columns in between. Returns the sum of the weights.
double addRow(const MapRows::Row& source, double from, double to, const Lobe& lobe, double least,
              MapRows::Row& sums) {
  double weights = 0.0;
  const int width = int(source[0].size());
  const double level = std::cos(from) * std::cos(to);
  const double sine = std::sin(from);
  const double round = sine * std::sin(to);
  for (int apart = 0; apart <= width / 2; ++apart) {
    const double cosine = level + round * std::cos(2.0 * glm::pi<double>() * apart / width);
    const double weight = sine * lobe(std::clamp(cosine, -1.0, 1.0));
    if (weight < sine * least) break;
    for (const int side : {-1, 1}) {
      if (side == 1 && (apart == 0 || 2 * apart == width)) break;
      const int shift = (side * apart + width) % width;
      for (size_t channel = 0; channel < sums.size(); ++channel) {
        const double* in = source[channel].data();
        double* out = sums[channel].data();
        for (int x = 0; x < width - shift; ++x) out[x] += weight * in[x + shift];
        for (int x = width - shift; x < width; ++x) out[x] += weight * in[x + shift - width];
      }
      weights += weight;
    }
  }
  return weights;
}

}  // namespace

MapRows::MapRows(int columns, int rowCount) : width(columns), rows(size_t(rowCount)) {
  for (Row& row : rows) row.fill(std::vector<double>(size_t(columns), 0.0));
}

MapRows averagedMap(const MapRows& map, const std::vector<double>& polar, const Lobe& lobe, double least,
                    double reach) {
  const std::vector<double> middles = middlesOfRows(map.height());
  MapRows result(map.width, int(polar.size()));
  forEachIndex(polar.size(), [&](size_t y) {
    MapRows::Row& row = result.rows[y];
    double weights = 0.0;
    for (size_t other = 0; other < middles.size(); ++other) {
      if (std::abs(middles[other] - polar[y]) > reach) continue;
      weights += addRow(map.rows[other], middles[other], polar[y], lobe, least, row);
    }
    for (std::vector<double>& channel : row) {
      for (double& value : channel) value /= weights;
    }
  });
  return result;
}

std::vector<double> middlesOfRows(int rows) {
  std::vector<double> middles;
  middles.reserve(size_t(rows));
  for (int y = 0; y < rows; ++y) middles.push_back(glm::pi<double>() * (y + 0.5) / rows);
  return middles;
}

}  // namespace fragtrace
