// SPDX-License-Identifier: MIT
#include "pack/inversion_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fragtrace {

namespace {

constexpr uint64_t kUnits = 65536;  // numbers of a step
constexpr size_t kMostChanges = 2;  // of the density within a step

/// Parts of constant density: where each begins, and the number that draws its beginning; the end stands behind.
struct Runs {
  std::vector<uint32_t> places;
  std::vector<uint64_t> numbers;

  void append(size_t place, uint64_t number) {
    places.push_back(uint32_t(place));
    numbers.push_back(number);
  }
};

/// Sums of the weights before each place, and of their squares.
struct Sums {
  std::vector<double> weights;
  std::vector<double> squares;

  /// The second moment of weight over density, of places that are drawn evenly.
  double cost(size_t from, size_t to) const {
    const double sum = weights[to] - weights[from];
    return sum > 0.0 ? double(to - from) * (squares[to] - squares[from]) / sum : 0.0;
  }
  double gain(size_t from, size_t at, size_t to) const {
    return from < at && at < to ? cost(from, to) - cost(from, at) - cost(at, to) : -INFINITY;
  }
  /// Where two even parts cost least; `to` when there is but one place.
  size_t split(size_t from, size_t to) const {
    size_t best = to;
    double least = INFINITY;
    for (size_t at = from + 1; at < to; ++at) {
      const double both = cost(from, at) + cost(at, to);
      if (both < least) {
        least = both;
        best = at;
      }
    }
    return best;
  }
};

Sums sumsOf(std::span<const float> weights) {
  Sums sums;
  sums.weights.resize(weights.size() + 1);
  sums.squares.resize(weights.size() + 1);
  for (size_t i = 0; i < weights.size(); ++i) {
    const auto w = double(weights[i]);
    sums.weights[i + 1] = sums.weights[i] + w;
    sums.squares[i + 1] = sums.squares[i] + w * w;
  }
  return sums;
}

/// The number that draws the beginning of each place, and the count of numbers: by the weights, and one number more
/// for each that is not zero, so that none is left out.
std::vector<uint64_t> numbersOf(std::span<const float> weights, const Sums& sums, uint64_t count) {
  const auto positive = uint64_t(std::count_if(weights.begin(), weights.end(), [](float w) { return w > 0.0f; }));
  const double scale = double(count - positive) / sums.weights.back();
  std::vector<uint64_t> numbers(weights.size() + 1);
  uint64_t more = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    more += weights[i] > 0.0f ? 1 : 0;
    numbers[i + 1] = uint64_t(sums.weights[i + 1] * scale) + more;
  }
  numbers.back() = count;
  return numbers;
}

/// Appends those of the places [first, last], at which the density changes within one step, that matter most.
void appendChanges(Runs& runs, const Sums& sums, const std::vector<uint64_t>& numbers, size_t first, size_t last) {
  if (last + 1 - first <= kMostChanges) {
    for (size_t i = first; i <= last; ++i) runs.append(i, numbers[i]);
    return;
  }
  const size_t from = first - 1;
  const size_t to = last + 1;
  const size_t middle = sums.split(from, to);
  const size_t before = sums.split(from, middle);
  const size_t after = sums.split(middle, to);
  const bool left = sums.gain(from, before, middle) > sums.gain(middle, after, to);
  const size_t other = left ? before : after;
  for (size_t i : {std::min(middle, other), std::max(middle, other)}) runs.append(i, numbers[i]);
}

Runs runsOf(std::span<const float> weights, const Sums& sums, const std::vector<uint64_t>& numbers) {
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
    appendChanges(runs, sums, numbers, first, i - 1);
  }
  runs.append(count, numbers[count]);
  return runs;
}

/// The place that a number draws, of a run that has numbers.
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

}  // namespace

double makeInversionTable(std::span<float> weights, std::span<InversionStep> steps) {
  Sums sums = sumsOf(weights);
  const double sum = sums.weights.back();
  if (sum <= 0.0) {
    std::fill(weights.begin(), weights.end(), 1.0f);
    sums = sumsOf(weights);
  }
  const uint64_t count = steps.size() * kUnits;
  const std::vector<uint64_t> numbers = numbersOf(weights, sums, count);
  const Runs runs = runsOf(weights, sums, numbers);
  fillSteps(steps, runs);
  const double scale = double(weights.size()) / double(count);
  for (size_t run = 0; run + 1 < runs.places.size(); ++run) {
    const double share = double(runs.numbers[run + 1] - runs.numbers[run]) * scale;
    const auto density = float(share / double(runs.places[run + 1] - runs.places[run]));
    for (uint32_t i = runs.places[run]; i < runs.places[run + 1]; ++i) weights[i] = density;
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
    entries[i].end = i + 1 == count ? UINT32_MAX : uint32_t(std::clamp(before * kNumbers - 1.0, 0.0, kNumbers - 1.0));
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

}  // namespace fragtrace
