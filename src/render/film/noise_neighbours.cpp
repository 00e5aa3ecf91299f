// SPDX-License-Identifier: MIT
#include "render/film/noise_neighbours.h"

#include <algorithm>
#include <cmath>

#include "render/film/noise.h"

namespace fragtrace {

namespace {

constexpr int kCell = 8;  // pixels a side; neighbours are those in 3 x 3 cells
/// From this evidence on, a pixel counts for itself alone.
constexpr double kEnoughEvidence = 8.0;

/// The share of evidence that a pixel lacks, 0 to 1.
double lackOf(const FilmPixel& p) { return std::max(0.0, 1.0 - evidenceOf(p) / kEnoughEvidence); }

/// Sums over pixels, each weighted by its lack of evidence: the edge of a lamp says nothing about the wall.
struct Pooled {
  double samples = 0.0;
  double light = 0.0;    ///< sum of luminance
  double squares = 0.0;  ///< samples x their variance about the pixel's own mean

  void add(const FilmPixel& p) {
    if (p.samples < 2 || !canBeNoisy(p)) return;
    const double weight = lackOf(p) * p.samples;
    samples += weight;
    light += weight * p.luminance();
    squares += weight * p.m2 / (double(p.samples) - 1.0);
  }
  void add(const Pooled& other) {
    samples += other.samples;
    light += other.light;
    squares += other.squares;
  }
  /// The relative variance of one sample.
  double relative(double floor) const {
    if (!(samples > 0.0)) return 0.0;
    const double scale = std::abs(light) / samples + floor;
    return scale > 0.0 ? squares / samples / (scale * scale) : 0.0;
  }
};

/// Sums over cells.
struct Cells {
  glm::ivec2 size{0};
  std::vector<Pooled> sums;

  explicit Cells(const FilmPixels& film)
      : size((film.size + (kCell - 1)) / kCell), sums(size_t(size.x) * size_t(size.y)) {
    for (int y = 0; y < film.size.y; ++y) {
      for (int x = 0; x < film.size.x; ++x)
        at(x / kCell, y / kCell).add(film.pixels[size_t(y) * size_t(film.size.x) + size_t(x)]);
    }
  }
  Pooled& at(int x, int y) { return sums[size_t(y) * size_t(size.x) + size_t(x)]; }

  /// The relative variance over the cells around that one.
  double relative(int x, int y, double floor) {
    Pooled window;
    for (int ny = std::max(0, y - 1); ny <= std::min(size.y - 1, y + 1); ++ny) {
      for (int nx = std::max(0, x - 1); nx <= std::min(size.x - 1, x + 1); ++nx) window.add(at(nx, ny));
    }
    return window.relative(floor);
  }
};

}  // namespace

double evidenceOf(const FilmPixel& pixel) {
  const double mean = pixel.luminance();
  if (pixel.samples < 2 || mean == 0.0) return 0.0;
  const double n = pixel.samples;
  return n / (1.0 + pixel.m2 / ((n - 1.0) * mean * mean));
}

std::vector<double> drawnTowardsNeighbours(const FilmPixels& film, const std::vector<double>& variance,
                                           double floor) {
  Cells cells(film);
  std::vector<double> result(variance);
  for (int y = 0; y < film.size.y; ++y) {
    for (int x = 0; x < film.size.x; ++x) {
      const size_t i = size_t(y) * size_t(film.size.x) + size_t(x);
      const FilmPixel& p = film.pixels[i];
      const double lack = lackOf(p);
      if (p.samples < 2 || !canBeNoisy(p) || lack <= 0.0) continue;
      const double scale = std::pow(std::abs(p.luminance()) + floor, 2.0);
      result[i] += lack * (scale * cells.relative(x / kCell, y / kCell, floor) / p.samples - variance[i]);
    }
  }
  return result;
}

}  // namespace fragtrace
