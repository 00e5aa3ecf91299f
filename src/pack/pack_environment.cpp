// SPDX-License-Identifier: MIT
#include "pack/pack_environment.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numeric>
#include <thread>

#include "base/parallel.h"
#include "base/vectors.h"
#include "base/words.h"
#include "pack/environment_light.h"
#include "pack/environment_texel.h"
#include "pack/inversion_table.h"

namespace fragtrace {

namespace {

/// Calls work(y) for each row, on all processors.
template <typename Work>
void forEachRow(int rows, const Work& work) {
  constexpr int kAtOnce = 16;
  std::atomic<int> next = 0;
  const uint32_t threads =
      std::clamp(std::thread::hardware_concurrency(), 1u, uint32_t(std::max(1, rows / 64)));
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
