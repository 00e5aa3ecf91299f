// SPDX-License-Identifier: MIT
#include "pack/pack_environment.h"

#include <atomic>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "base/words.h"

namespace fragtrace {

namespace {

constexpr uint64_t kUnits = 65536;  // numbers of a step
constexpr size_t kMostChanges = 2;  // changes of the density within a step

/// Runs of constant density: the place where each begins, and the number that draws its beginning; the end
/// comes last.
struct Runs {
  std::vector<uint32_t> places;
  std::vector<uint64_t> numbers;

  void append(size_t place, uint64_t number) {
    places.push_back(uint32_t(place));
    numbers.push_back(number);
  }
};

/// The number that draws the beginning of each place, and the count of numbers. They follow the weights,
/// whose sum is given, with one number more for each weight that is not zero, so that none is left out.
std::vector<uint64_t> numbersOf(std::span<const float> weights, double sum, uint64_t count) {
  uint64_t positive = 0;
  for (float w : weights) positive += w > 0.0f ? 1 : 0;
  const double scale = double(count - positive) / sum;
  std::vector<uint64_t> numbers(weights.size() + 1);
  double before = 0.0;
  uint64_t more = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    before += double(weights[i]);
    more += weights[i] > 0.0f ? 1 : 0;
    numbers[i + 1] = uint64_t(int64_t(std::floor(before * scale + 0.5))) + more;
  }
  numbers.back() = count;
  return numbers;
}

/// The density changes at each of the places [first, last], all within one step of the table. Appends the two
/// places at which it changes most.
void appendChanges(Runs& runs, std::span<const float> weights, const std::vector<uint64_t>& numbers,
                   size_t first, size_t last) {
  static_assert(kMostChanges == 2);
  size_t one = first;
  size_t other = last;
  if (last - first >= kMostChanges) {
    const auto jump = [&](size_t i) { return std::abs(weights[i] - weights[i - 1]); };
    other = first + 1;
    if (jump(one) < jump(other)) std::swap(one, other);
    for (size_t i = first + 2; i <= last; ++i) {
      if (jump(i) > jump(one)) {
        other = std::exchange(one, i);
      } else if (jump(i) > jump(other)) {
        other = i;
      }
    }
    if (other < one) std::swap(one, other);
  }
  runs.append(one, numbers[one]);
  if (other != one) runs.append(other, numbers[other]);
}

Runs runsOf(std::span<const float> weights, const std::vector<uint64_t>& numbers) {
  Runs runs;
  runs.places.reserve(weights.size() + 1);
  runs.numbers.reserve(weights.size() + 1);
  runs.append(0, 0);
  const size_t count = weights.size();
  for (size_t i = 1; i < count;) {
    // A change at the beginning of a step takes no room in it.
    if (numbers[i] % kUnits == 0) {
      runs.append(i, numbers[i]);
      ++i;
      continue;
    }
    const uint64_t step = numbers[i] / kUnits;
    const size_t first = i;
    while (i < count && numbers[i] % kUnits != 0 && numbers[i] / kUnits == step) ++i;
    appendChanges(runs, weights, numbers, first, i - 1);
  }
  runs.append(count, numbers[count]);
  return runs;
}

/// The place that a number draws in a run that has numbers.
float placeAt(const Runs& runs, size_t run, uint64_t number) {
  const double part = double(number - runs.numbers[run]) / double(runs.numbers[run + 1] - runs.numbers[run]);
  return float(double(runs.places[run]) + part * double(runs.places[run + 1] - runs.places[run]));
}

void fillSteps(std::span<InversionStep> steps, const Runs& runs) {
  size_t run = 0;
  for (size_t k = 0; k < steps.size(); ++k) {
    const uint64_t begin = k * kUnits;
    const uint64_t end = begin + kUnits;
    while (runs.numbers[run + 1] <= begin) ++run;
    InversionStep& step = steps[k];
    step = {.first = placeAt(runs, run, begin)};
    // A single change is the second one.
    while (runs.numbers[run + 1] < end) {
      ++run;
      step.numbers = step.numbers >> 16 | uint32_t(runs.numbers[run] - begin) << 16;
      step.places = step.places >> 16 | runs.places[run] << 16;
    }
    step.last = placeAt(runs, run, end);
  }
}

/// Rows of the maps from which the levels are made: at least two texels for a standard deviation of the lobe.
constexpr std::array<int, layout::kLobeLevels> kRowsOfLevel{28, 28, 28, 36, 72, 144};

/// Weight of a texel of the map in a texel made of it.
struct Share {
  size_t texel;
  double weight;
  bool beyond = false;  ///< a row beyond a pole: half a turn away
};

/// Finds those of `count` columns or rows that make one of `parts`, by a tent twice as wide as the wider of
/// the two. So the middle of a sun stays where it is. Beyond the ends columns wrap around, and rows of a map
/// that gets finer repeat the last one.
std::vector<Share> sharesOf(int part, int parts, int count, bool rows) {
  const double middle = (part + 0.5) * count / parts;
  const double reach = std::max(1.0, double(count) / parts);
  std::vector<Share> shares;
  double sum = 0.0;
  for (int k = int(std::floor(middle - reach)); k <= int(std::ceil(middle + reach)); ++k) {
    double weight = reach - std::abs(k + 0.5 - middle);
    if (weight <= 0.0) continue;
    const bool inside = k >= 0 && k < count;
    const bool beyond = rows && count > parts && !inside;
    int texel = rows ? std::clamp(k, 0, count - 1) : ((k % count) + count) % count;
    if (beyond) texel = k < 0 ? -1 - k : 2 * count - 1 - k;
    // Means are over solid angle.
    if (rows && count > parts) weight *= std::sin(glm::pi<double>() * (texel + 0.5) / count);
    shares.push_back({size_t(texel), weight, beyond});
    sum += weight;
  }
  for (Share& share : shares) share.weight /= sum;
  return shares;
}

/// Resizes a map of this size, whose texels `radianceAt` gives by row and column.
template <typename RadianceAt>
MapRows resizedFrom(glm::ivec2 size, const RadianceAt& radianceAt, int height) {
  MapRows result(2 * height, height);
  std::vector<std::vector<Share>> columns;
  columns.reserve(size_t(result.width));
  for (int x = 0; x < result.width; ++x) columns.push_back(sharesOf(x, result.width, size.x, false));
  forEachIndex(size_t(height), [&](size_t y) {
    std::vector<glm::dvec3> line(size_t(size.x), glm::dvec3(0.0));
    for (const Share& share : sharesOf(int(y), height, size.y, true)) {
      const size_t turn = share.beyond ? line.size() / 2 : 0;
      for (size_t x = 0; x < line.size(); ++x)
        line[x] += share.weight * radianceAt(share.texel, x < turn ? x + line.size() - turn : x - turn);
    }
    for (size_t x = 0; x < columns.size(); ++x) {
      glm::dvec3 sum(0.0);
      for (const Share& share : columns[x]) sum += share.weight * line[share.texel];
      for (size_t channel = 0; channel < 3; ++channel) result.rows[y][channel][x] = sum[int(channel)];
    }
  });
  return result;
}

glm::dvec3 texelOf(const MapRows& map, size_t y, size_t x) {
  const MapRows::Row& row = map.rows[y];
  return {row[0][x], row[1][x], row[2][x]};
}

void appendMap(const MapRows& map, Words& texels) {
  for (const MapRows::Row& row : map.rows) {
    for (size_t x = 0; x < size_t(map.width); ++x) appendTexel(texels, {row[0][x], row[1][x], row[2][x]});
  }
  endMap(texels);
}

/// Reads a map of one colour.
MapRows onlyTexel(const Image& image) {
  MapRows map(1, 1);
  for (size_t channel = 0; channel < 3; ++channel) map.rows[0][channel][0] = double(image.values[channel]);
  return map;
}

/// Sums a map's texels over the solid angles that they have.
Irradiance irradianceOf(const MapRows& map) {
  constexpr double kPi = glm::pi<double>();
  // Moments of the radiance: integrals of 1, x, y, z, xy, yz, zx, x^2 - z^2 and y^2 times it.
  Irradiance moments{};
  for (int y = 0; y < map.height(); ++y) {
    // A direction is (sin a cos b, cos a, sin a sin b). These are integrals over the row's a of sin a times
    // the factors that depend on a.
    const double from = kPi * y / map.height();
    const double to = kPi * (y + 1) / map.height();
    const auto over = [&](const auto& antiderivative) { return antiderivative(to) - antiderivative(from); };
    const double one = over([](double a) { return -std::cos(a); });
    const double cosine = over([](double a) { return 0.5 * std::sin(a) * std::sin(a); });
    const double cosine2 = over([](double a) { return -std::pow(std::cos(a), 3) / 3.0; });
    const double sine = over([](double a) { return 0.5 * a - 0.25 * std::sin(2.0 * a); });
    const double both = over([](double a) { return std::pow(std::sin(a), 3) / 3.0; });
    const double sine2 = over([](double a) { return std::pow(std::cos(a), 3) / 3.0 - std::cos(a); });
    // These are sums over the row of the radiance times integrals over the texels' b of 1, cos b, sin b, cos
    // 2b, sin 2b.
    std::array<glm::dvec3, 5> sums{};
    for (int x = 0; x < map.width; ++x) {
      const glm::dvec3 radiance = texelOf(map, size_t(y), size_t(x));
      const double left = 2.0 * kPi * x / map.width - kPi;
      const double right = 2.0 * kPi * (x + 1) / map.width - kPi;
      sums[0] += radiance * (right - left);
      sums[1] += radiance * (std::sin(right) - std::sin(left));
      sums[2] += radiance * (std::cos(left) - std::cos(right));
      sums[3] += radiance * 0.5 * (std::sin(2.0 * right) - std::sin(2.0 * left));
      sums[4] += radiance * 0.5 * (std::cos(2.0 * left) - std::cos(2.0 * right));
    }
    const std::array<glm::dvec3, layout::kIrradianceRows> row{
        one * sums[0],  sine * sums[1],        cosine * sums[0], sine * sums[2],    both * sums[1],
        both * sums[2], 0.5 * sine2 * sums[4], sine2 * sums[3],  cosine2 * sums[0],
    };
    for (size_t i = 0; i < row.size(); ++i) moments[i] += row[i];
  }
  // A clamped cosine multiplies the bands of the harmonics by pi, 2 pi / 3 and pi / 4.
  return {0.25 * moments[0],        0.5 * moments[1],         0.5 * moments[2],
          0.5 * moments[3],         15.0 / 16.0 * moments[4], 15.0 / 16.0 * moments[5],
          15.0 / 16.0 * moments[6], 15.0 / 64.0 * moments[7], 5.0 / 64.0 * (3.0 * moments[8] - moments[0])};
}

}  // namespace

double makeInversionTable(std::span<float> weights, std::span<InversionStep> steps) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (sum <= 0.0) std::fill(weights.begin(), weights.end(), 1.0f);
  const uint64_t count = steps.size() * kUnits;
  const std::vector<uint64_t> numbers = numbersOf(weights, sum > 0.0 ? sum : double(weights.size()), count);
  const Runs runs = runsOf(weights, numbers);
  fillSteps(steps, runs);
  const double scale = double(weights.size()) / double(count);
  for (size_t run = 0; run + 1 < runs.places.size(); ++run) {
    const double share = double(runs.numbers[run + 1] - runs.numbers[run]) * scale;
    const auto pdf = float(share / double(runs.places[run + 1] - runs.places[run]));
    for (uint32_t i = runs.places[run]; i < runs.places[run + 1]; ++i) weights[i] = pdf;
  }
  return sum;
}

std::vector<InversionEntry> makeInversionEntries(std::span<const double> weights) {
  const size_t count = weights.size();
  std::vector<InversionEntry> entries(count);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  constexpr double kNumbers = 0x1p32;
  double before = 0.0;
  for (size_t i = 0; i < count; ++i) {
    before += sum > 0.0 ? weights[i] / sum : 1.0 / double(count);
    entries[i].end =
        i + 1 == count ? UINT32_MAX : uint32_t(std::clamp(before * kNumbers - 1.0, 0.0, kNumbers - 1.0));
  }
  const auto drawnBy = [&](uint64_t number, size_t from) {
    while (entries[from].end < number) ++from;
    return uint32_t(from);
  };
  for (size_t i = 0; i < count; ++i) {
    // The numbers whose product with the count carries i into the upper 32 bits.
    const uint64_t first = ((uint64_t(i) << 32) + count - 1) / count;
    const uint64_t next = ((uint64_t(i + 1) << 32) + count - 1) / count;
    entries[i].first = drawnBy(first, i == 0 ? 0 : entries[i - 1].last);
    entries[i].last = drawnBy(next - 1, entries[i].first);
  }
  return entries;
}

MapRows resized(const Image& image, int height) {
  const auto texel = [&](size_t y, size_t x) {
    const float* p = image.pixel(int(x), int(y));
    return glm::dvec3(p[0], p[1], p[2]);
  };
  return resizedFrom({image.width, image.height}, texel, height);
}

double exponentOfLevel(int level) { return 2.0 * std::pow(4.0, level) - 2.0; }

MapRows lobesOf(const MapRows& map, int level) {
  constexpr double kLeast = 1e-3;
  const double exponent = exponentOfLevel(level);
  // The lobe ends without a step, which a sun would show.
  const auto lobe = [&](double cosine) {
    return cosine > 0.0 ? std::pow(0.5 + 0.5 * cosine, 0.5 * exponent) * cosine - kLeast : -1.0;
  };
  // The lobe is below kLeast beyond `reach`, since cos(a / 2)^n < exp(-n a^2 / 8).
  const double reach = std::sqrt(-8.0 * std::log(kLeast) / std::max(exponent, 1.0));
  std::vector<double> polar;
  for (int y = 0; y <= map.height(); ++y) polar.push_back(glm::pi<double>() * y / map.height());
  return averagedMap(map, polar, lobe, 0.0, reach);
}

namespace {

/// The most words that appendEnvironmentLight() appends.
size_t mostLightWords() {
  size_t rows = layout::kIrradianceRows + layout::kLobeLevels;
  for (const int height : kRowsOfLevel) rows += size_t(height) * size_t(height + 1);
  return rows * 4;
}

/// Calls work(y) for each row, on all processors.
template <typename Work>
void forEachRow(int rows, const Work& work) {
  constexpr int kAtOnce = 16;
  std::atomic<int> next = 0;
  const uint32_t threads = std::clamp(processorCount(), 1u, uint32_t(std::max(1, rows / 64)));
  runOnThreads(threads, [&](uint32_t) {
    for (int y = next.fetch_add(kAtOnce); y < rows; y = next.fetch_add(kAtOnce)) {
      for (int k = y; k < std::min(rows, y + kAtOnce); ++k) work(k);
    }
  });
}

double sineOfRow(const Image& image, int y) { return std::sin(glm::pi<double>() * (y + 0.5) / image.height); }

/// Writes the radiance of a row's texels; returns the sum of their luminance.
double copyRow(const Image& image, int y, std::span<uint32_t> texels) {
  const float* p = image.pixel(0, y);
  double sum = 0.0;
  for (size_t i = 0; i < texels.size(); i += 2, p += image.channelCount()) {
    const glm::uvec2 texel = packTexel({p[0], p[1], p[2]});
    texels[i] = texel.x;
    texels[i + 1] = texel.y;
    sum += double(luminanceOfTexel(texel.x, texel.y));
  }
  return sum;
}

/// Luminance above a level.
void storeWeights(std::span<const uint32_t> texels, float level, std::span<float> weights) {
  for (size_t i = 0; i < weights.size(); ++i)
    weights[i] = std::max(0.0f, luminanceOfTexel(texels[2 * i], texels[2 * i + 1]) - level);
}

/// The mean, unless the map is so even that hardly any texel is brighter, and there is no sun.
float levelOf(const PackedEnvironment& packed, double mean, bool sun) {
  constexpr double kEven = 1.01;
  if (sun) return float(mean);
  for (size_t i = 0; i < packed.texels.size(); i += 2) {
    if (double(luminanceOfTexel(packed.texels[i], packed.texels[i + 1])) > kEven * mean) return float(mean);
  }
  return 0.0f;
}

void storeSteps(std::span<uint32_t> words, std::span<const InversionStep> steps) {
  std::memcpy(words.data(), steps.data(), steps.size_bytes());
}

void storeDensities(std::span<const float> densities, float factor, std::span<uint32_t> texels) {
  for (size_t i = 0; i < densities.size(); ++i)
    texels[2 * i + 1] = withDensity(texels[2 * i + 1], densities[i] * factor);
}

}  // namespace

void appendEnvironmentLight(const Image& image, Words& texels) {
  const bool even = image.width == 1 && image.height == 1;
  const MapRows finest = even ? onlyTexel(image) : resized(image, kRowsOfLevel.back());
  for (const glm::dvec3& factor : irradianceOf(finest)) appendRow(texels, glm::vec3(factor), 0.0f);
  std::vector<MapRows> levels;
  MapRows map = finest;
  for (int level = int(layout::kLobeLevels) - 1; level >= 0; --level) {
    const int height = kRowsOfLevel[size_t(level)];
    if (!even && map.height() > height) {
      const auto texel = [&](size_t y, size_t x) { return texelOf(map, y, x); };
      map = resizedFrom({map.width, map.height()}, texel, height);
    }
    levels.insert(levels.begin(), even ? map : lobesOf(map, level));
  }
  auto first = uint32_t(texels.size() / 4 + levels.size());
  for (const MapRows& level : levels) {
    texels.insert(texels.end(), {uint32_t(level.width), uint32_t(level.height()), first, 0u});
    first += uint32_t(level.width * level.height() + 1) / 2;
  }
  for (const MapRows& level : levels) appendMap(level, texels);
}

glm::vec3 upwardIrradiance(const Image& image) {
  // Between the middles of two rows the map is the mean of both by distance (shaders/environment.glsl).
  constexpr int kLeastSteps = 8192;  // relative error below 1e-6 of the cosine alone
  std::vector<glm::dvec3> rows(size_t(image.height), glm::dvec3(0.0));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* p = image.pixel(x, y);
      rows[size_t(y)] += glm::dvec3(p[0], p[1], p[2]) / double(image.width);
    }
  }
  glm::dvec3 sum(0.0);
  const int steps = (kLeastSteps / image.height + 1) * image.height;
  for (int i = 0; i < steps; ++i) {
    const double v = (i + 0.5) / steps;
    const double polar = glm::pi<double>() * v;
    const double place = std::clamp(v * image.height - 0.5, 0.0, double(image.height - 1));
    const auto row = std::min(size_t(place), rows.size() - 1);
    const glm::dvec3& next = rows[std::min(row + 1, rows.size() - 1)];
    sum += glm::mix(rows[row], next, place - double(row)) * std::max(0.0, std::cos(polar)) * std::sin(polar);
  }
  return glm::vec3(sum * (2.0 * glm::pi<double>() * glm::pi<double>() / steps));
}

void appendBackdrop(const Image& image, Words& texels) {
  texels.reserve(texels.size() + size_t(image.width) * size_t(image.height) * 2 + 2);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* p = image.pixel(x, y);
      appendTexel(texels, {p[0], p[1], p[2]});
    }
  }
  endMap(texels);
}

double powerOf(const SunDisc& sun) { return glm::pi<double>() * luminance(sun.irradiance); }

void appendSuns(const Environment& environment, double drawnPower, Words& texels) {
  const SunDisc sun = environment.sun.value_or(SunDisc());
  const double radius = layout::kSunRadius;
  const double power = powerOf(sun);
  // A sun that has set is never drawn.
  const double chance = power > 0.0 ? power / (power + drawnPower) : 0.0;
  const double pdf = (2.0 + kLimbPowers.g) / (2.0 * glm::pi<double>() * radius * radius);
  appendRow(texels, glm::vec4(sun.direction, chance));
  appendRow(texels, glm::vec4(sun.radiance, pdf));
  const MapSun none{std::numeric_limits<float>::infinity(), 0.0};
  appendRow(texels, glm::vec4(environment.mapSun.value_or(none).level, 0.0f, 0.0f, 0.0f));
}

PackedEnvironment packEnvironment(const Image& image, EnvironmentDraws draws, double sunPower) {
  PackedEnvironment packed;
  packed.size = {image.width, image.height};
  const auto rows = size_t(image.height);
  const auto width = size_t(image.width);
  const size_t rowWords = width * 2;
  const size_t stepCount = size_t(std::clamp(image.width / 2, 1, layout::kMostEnvironmentSteps));
  const size_t stepWords = stepCount * 4;
  const bool drawn = draws != EnvironmentDraws::Nothing;
  std::vector<float> densities;  // over each row
  // Step: make large arrays, whose pages are made at the same time.
  runOnThreads(2, [&](uint32_t part) {
    // The light of a map that is not drawn from, or suns, may be appended, which must not copy the whole
    // array.
    const size_t appended = drawn ? size_t(layout::kSunRows) * 4 : mostLightWords();
    if (part == 0) packed.texels.reserve(rows * rowWords + 2 + appended);
    if (part == 0) packed.texels.resize(rows * rowWords);
    if (part == 0) endMap(packed.texels);
    if (part == 1 && drawn) packed.inversion.resize(rows * 4 + rows * stepWords);
    if (part == 1 && drawn) densities.resize(rows * width);
  });
  const auto texelsOf = [&](int y) {
    return std::span(packed.texels).subspan(size_t(y) * rowWords, rowWords);
  };
  const auto densitiesOf = [&](int y) { return std::span(densities).subspan(size_t(y) * width, width); };

  // Step: copy the radiance.
  std::vector<double> sums(rows);
  forEachRow(image.height, [&](int y) {
    sums[size_t(y)] = copyRow(image, y, texelsOf(y)) / image.width * sineOfRow(image, y);
  });
  const double sum = std::accumulate(sums.begin(), sums.end(), 0.0);
  packed.power = 2.0 * glm::pi<double>() * glm::pi<double>() * glm::pi<double>() * sum / double(rows);
  packed.drawnPower = packed.power;
  if (!drawn) return packed;

  // Step: make each row's table, and the table of the rows.
  double sines = 0.0;
  for (int y = 0; y < image.height; ++y) sines += sineOfRow(image, y);
  const double mean = sum / sines + sunPower / (4.0 * glm::pi<double>() * glm::pi<double>());
  const std::span<uint32_t> inversion(packed.inversion);
  std::vector<float> pdfs(rows);
  const float level = draws == EnvironmentDraws::LightAndPaths ? levelOf(packed, mean, sunPower > 0.0) : 0.0f;
  forEachRow(image.height, [&](int y) {
    const std::span<float> row = densitiesOf(y);
    storeWeights(texelsOf(y), level, row);
    std::vector<InversionStep> steps(stepCount);
    pdfs[size_t(y)] = float(makeInversionTable(row, steps) / image.width * sineOfRow(image, y));
    storeSteps(inversion.subspan(rows * 4 + size_t(y) * stepWords, stepWords), steps);
  });
  if (sum > 0.0) packed.drawnPower *= std::accumulate(pdfs.begin(), pdfs.end(), 0.0) / sum;
  std::vector<InversionStep> steps(rows);
  makeInversionTable(pdfs, steps);
  storeSteps(inversion.first(rows * 4), steps);
  forEachRow(image.height, [&](int y) { storeDensities(densitiesOf(y), pdfs[size_t(y)], texelsOf(y)); });
  return packed;
}

}  // namespace fragtrace
