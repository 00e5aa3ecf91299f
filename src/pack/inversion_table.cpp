// SPDX-License-Identifier: MIT
#include "pack/inversion_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

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

}  // namespace fragtrace
