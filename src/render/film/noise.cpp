// SPDX-License-Identifier: MIT
#include "render/film/noise.h"

#include <algorithm>
#include <cmath>

namespace fragtrace {

namespace {

// Pixels help to estimate the noise of their neighbours: a pixel to which few samples brought light knows too
// little about its own.

constexpr int kCell = 8;  // pixels per side; neighbours are those in 3 x 3 cells
/// From this evidence on, a pixel counts for itself alone.
constexpr double kEnoughEvidence = 8.0;

/// Returns the effective number k of a pixel's samples: n / (1 + (deviation / mean)^2). The n samples tell as
/// much as k samples that all bring the same light. So if k of n samples see a lamp and the others see
/// nothing, the result is k.
double evidenceOf(const FilmPixel& pixel) {
  const double mean = pixel.luminance();
  if (pixel.samples < 2 || mean == 0.0) return 0.0;
  const double n = pixel.samples;
  return n / (1.0 + pixel.m2 / ((n - 1.0) * mean * mean));
}

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

/// Pulls `variance`, that of each pixel's mean by its own samples, towards that of its neighbours: the less
/// evidence the pixel has, the more. `floor` is that of relative errors (noise.h), and the shared variance is
/// relative. So a caustic that most samples miss also counts in the pixels whose samples have all missed it.
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

constexpr int kWindow = 16;  // pixels per side of one cell of the windows' grid; a window is 3 x 3 cells
/// The ratio of the whole picture weighs as much as this many pixels of a window.
constexpr double kPrior = 24.0;

/// Sums over pixels, by which a ratio of variances and its reliability are known.
struct Sums {
  double differences = 0.0;  ///< squared differences of the halves
  double independent = 0.0;  ///< the sum that independent samples would give
  double squares = 0.0;      ///< sum of the squares of the terms of `independent`

  void add(const Sums& other) {
    differences += other.differences;
    independent += other.independent;
    squares += other.squares;
  }
};

/// Summed over cells of kWindow x kWindow pixels.
struct Grid {
  glm::ivec2 size{0};
  std::vector<Sums> cells;

  explicit Grid(glm::ivec2 picture)
      : size((picture + (kWindow - 1)) / kWindow), cells(size_t(size.x) * size_t(size.y)) {}
  Sums& at(int x, int y) { return cells[size_t(y) * size_t(size.x) + size_t(x)]; }
};

/// The ratio of the variance that the sampler leaves to that of independent samples: the window's own ratio,
/// pulled towards the whole picture's. The fewer pixels the window has, the stronger the pull.
double sharesOf(const Sums& window, double overall) {
  if (window.independent <= 0.0) return overall;
  const double pixels = window.independent * window.independent / std::max(window.squares, 1e-300);
  const double prior = window.independent * kPrior / pixels;
  return (window.differences + prior * overall) / (window.independent + prior);
}

}  // namespace

double floorOf(const FilmPixels& film) {
  double sum = 0.0;
  for (const FilmPixel& p : film.pixels) sum += p.luminance();
  return 0.01 * sum / double(std::max<size_t>(1, film.pixels.size()));
}

std::vector<double> independentVariance(const FilmPixels& film) {
  std::vector<double> variance(film.pixels.size());
  std::ranges::transform(film.pixels, variance.begin(), &FilmPixel::variance);
  return drawnTowardsNeighbours(film, variance, floorOf(film));
}

std::vector<double> varianceOfMean(const Halves& halves) {
  const glm::ivec2 size = halves.a.size;
  const double floor = floorOf(halves.a);
  Grid grid(size);
  Sums whole;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const size_t i = size_t(y) * size_t(size.x) + size_t(x);
      const FilmPixel& a = halves.a.pixels[i];
      const FilmPixel& b = halves.b.pixels[i];
      if (a.samples == 0 || b.samples == 0) continue;
      const double apart = a.luminance() - b.luminance();
      const double independent = a.variance() + b.variance();
      // Differences are relative to the pixel's own brightness, so that the brightest do not outweigh the
      // rest.
      const double scale =
          1.0 / std::max(1e-300, std::pow(0.5 * (a.luminance() + b.luminance()) + floor, 2.0));
      const Sums own{apart * apart * scale, independent * scale, independent * independent * scale * scale};
      grid.at(x / kWindow, y / kWindow).add(own);
      whole.add(own);
    }
  }
  // The whole picture's ratio is pulled towards 1, that of independent samples, since one pixel tells
  // nothing.
  const double overall = whole.independent > 0.0 ? sharesOf(whole, 1.0) : 1.0;

  std::vector<double> shares(grid.cells.size());
  for (int y = 0; y < grid.size.y; ++y) {
    for (int x = 0; x < grid.size.x; ++x) {
      Sums window;
      for (int ny = std::max(0, y - 1); ny <= std::min(grid.size.y - 1, y + 1); ++ny) {
        for (int nx = std::max(0, x - 1); nx <= std::min(grid.size.x - 1, x + 1); ++nx)
          window.add(grid.at(nx, ny));
      }
      shares[size_t(y) * size_t(grid.size.x) + size_t(x)] = sharesOf(window, overall);
    }
  }

  const FilmPixels both = pooled(halves.a, halves.b);
  std::vector<double> variance(halves.a.pixels.size());
  for (size_t i = 0; i < variance.size(); ++i) {
    const FilmPixel& a = halves.a.pixels[i];
    const FilmPixel& b = halves.b.pixels[i];
    const double samples = std::max(1.0, double(a.samples) + b.samples);
    variance[i] =
        (a.variance() * a.samples * a.samples + b.variance() * b.samples * b.samples) / (samples * samples);
  }
  variance = drawnTowardsNeighbours(both, variance, floorOf(both));
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const size_t i = size_t(y) * size_t(size.x) + size_t(x);
      variance[i] *= shares[size_t(y / kWindow) * size_t(grid.size.x) + size_t(x / kWindow)];
    }
  }
  return variance;
}

std::vector<double> observedVariance(const FilmPixels& quarter, const FilmPixels& half,
                                     const FilmPixels& whole) {
  const double floor = floorOf(whole);
  std::vector<double> observed(whole.pixels.size());
  double first = 0.0;
  double second = 0.0;
  for (size_t i = 0; i < observed.size(); ++i) {
    const double middle = half.pixels[i].luminance();
    const double end = whole.pixels[i].luminance();
    observed[i] = (middle - end) * (middle - end);
    const double weight = 1.0 / std::max(1e-300, std::pow(std::abs(end) + floor, 2.0));
    first += weight * std::pow(quarter.pixels[i].luminance() - middle, 2.0);
    second += weight * observed[i];
  }
  // If the variance falls as N^-p, the squared distance from half to whole is on average 2^p - 1 times the
  // variance, and these distances fall as 2^p. Independent samples have p = 1; beyond 2 the ratio is one of
  // small numbers.
  const double ratio = second > 0.0 ? std::clamp(first / second, 2.0, 4.0) : 2.0;
  for (double& value : observed) value /= ratio - 1.0;
  return observed;
}

std::vector<double> relativeErrors(const FilmPixels& pooled, const std::vector<double>& variance) {
  const double floor = floorOf(pooled);
  std::vector<double> errors(pooled.pixels.size());
  for (size_t i = 0; i < errors.size(); ++i) {
    const double scale = std::abs(pooled.pixels[i].luminance()) + floor;
    errors[i] = scale > 0.0 ? std::sqrt(std::max(0.0, variance[i])) / scale : 0.0;
  }
  return errors;
}

GoalDistance distanceTo(double goal, const FilmPixels& film, const std::vector<double>& errors,
                        bool catcher) {
  std::vector<double> noisy;
  std::vector<double> lit;
  std::vector<double> filled;
  std::vector<double> shadow;
  for (size_t i = 0; i < errors.size(); ++i) {
    if (!canBeNoisy(film.pixels[i])) continue;
    noisy.push_back(errors[i]);
    if (film.pixels[i].luminance() != 0.0) lit.push_back(errors[i]);
    if (!catcher) continue;
    (film.pixels[i].alpha >= film.pixels[i].samples ? filled : shadow).push_back(errors[i]);
  }
  GoalDistance distance;
  for (const std::vector<double>* some : {&noisy, &lit, &filled, &shadow}) {
    if (some->empty()) continue;
    const auto under = std::ranges::count_if(*some, [&](double e) { return e <= goal; });
    distance.error = std::max(distance.error, quantileOf(*some, kPartUnderGoal));
    distance.share = std::min(distance.share, double(under) / double(some->size()));
  }
  return distance;
}

double quantileOf(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + std::ptrdiff_t(std::ceil(part * double(values.size()))) - 1;
  std::nth_element(values.begin(), std::max(values.begin(), at), values.end());
  return *std::max(values.begin(), at);
}

}  // namespace fragtrace
