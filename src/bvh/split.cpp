// SPDX-License-Identifier: MIT
#include "bvh/split.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace fragtrace {
namespace {

constexpr uint32_t kBinCount = 32;
constexpr uint32_t kParallelSize = 1u << 16;  // fewer primitives are binned faster by one thread

// Twice the centroid; in double, where no sum of floats overflows.
double doubleCenter(const Bounds& box, int axis) {
  return double(box.minimum[axis]) + double(box.maximum[axis]);
}

// One side of a split, as the surface area heuristic sees it.
struct Side {
  Bounds bounds;
  uint32_t count = 0;
  uint32_t singles = 0;

  void include(const Bounds& box, bool single) {
    bounds.include(box);
    ++count;
    singles += single ? 1 : 0;
  }
  void include(const Side& side) {
    bounds.include(side.bounds);
    count += side.count;
    singles += side.singles;
  }
  // Area times leaves (MacDonald and Booth 1990, Heuristics for Ray Tracing Using Space Subdivision). Both
  // triangles of a leaf are tested side by side, so a leaf costs the same whether it holds one or two.
  double cost() const {
    const uint32_t leaves = (count + singles + 1) / 2;
    return areaOf(bounds) * leaves;
  }
};

// The best split seen so far. Boxes without area all cost 0: then the more even split wins.
struct Best {
  double cost = std::numeric_limits<double>::infinity();
  uint32_t larger = 0;
  int axis = -1;
  uint32_t position = 0;

  void offer(double newCost, uint32_t leftCount, uint32_t rightCount, int newAxis, uint32_t newPosition) {
    const uint32_t newLarger = std::max(leftCount, rightCount);
    if (newCost < cost || (newCost == cost && newLarger < larger))
      *this = {newCost, newLarger, newAxis, newPosition};
  }
};

struct CenterRange {
  glm::dvec3 minimum{std::numeric_limits<double>::infinity()};
  glm::dvec3 maximum{-std::numeric_limits<double>::infinity()};
};

CenterRange centerRangeOf(std::span<const BuildItem> items, uint32_t threadCount) {
  std::vector<CenterRange> partial(threadCount);
  runOnThreads(threadCount, [&](uint32_t thread) {
    CenterRange range;
    const size_t end = items.size() * (thread + 1) / threadCount;
    for (size_t i = items.size() * thread / threadCount; i < end; ++i) {
      const glm::dvec3 center = glm::dvec3(items[i].bounds.minimum) + glm::dvec3(items[i].bounds.maximum);
      range.minimum = glm::min(range.minimum, center);
      range.maximum = glm::max(range.maximum, center);
    }
    partial[thread] = range;
  });
  for (const CenterRange& range : partial) {
    partial[0].minimum = glm::min(partial[0].minimum, range.minimum);
    partial[0].maximum = glm::max(partial[0].maximum, range.maximum);
  }
  return partial[0];
}

// Maps a centroid to its bin. An axis on which all centroids agree has scale 0, and all lie in bin 0.
struct Binning {
  glm::dvec3 minimum;
  glm::dvec3 scale{0.0};

  explicit Binning(const CenterRange& range) : minimum(range.minimum) {
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = range.maximum[axis] - range.minimum[axis];
      if (extent > 0.0) scale[axis] = kBinCount / extent;
    }
  }
  uint32_t binOf(const Bounds& box, int axis) const {
    const double position = (doubleCenter(box, axis) - minimum[axis]) * scale[axis];
    return std::min(uint32_t(position), kBinCount - 1);
  }
};

using Bins = std::array<std::array<Side, kBinCount>, 3>;

Bins fillBins(std::span<const BuildItem> items, const Binning& binning, uint32_t firstSingle,
              uint32_t threadCount) {
  std::vector<Bins> partial(threadCount);
  runOnThreads(threadCount, [&](uint32_t thread) {
    Bins& bins = partial[thread];
    const size_t end = items.size() * (thread + 1) / threadCount;
    for (size_t i = items.size() * thread / threadCount; i < end; ++i) {
      const BuildItem& item = items[i];
      for (int axis = 0; axis < 3; ++axis) {
        bins[axis][binning.binOf(item.bounds, axis)].include(item.bounds, item.primitive >= firstSingle);
      }
    }
  });
  for (uint32_t thread = 1; thread < threadCount; ++thread) {
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t bin = 0; bin < kBinCount; ++bin)
        partial[0][axis][bin].include(partial[thread][axis][bin]);
    }
  }
  return partial[0];
}

// Offers every cut between two of `sides`, which stand in order along the axis.
void offerCuts(std::span<const Side> sides, int axis, uint64_t childCapacity, Best& best) {
  std::array<Side, std::max(kBinCount, kSweepSize)> right;
  const size_t count = sides.size();
  assert(count <= right.size());
  right[count - 1] = sides[count - 1];
  for (size_t i = count - 1; i-- > 1;) {
    right[i] = sides[i];
    right[i].include(right[i + 1]);
  }
  Side left;
  for (size_t cut = 1; cut < count; ++cut) {
    left.include(sides[cut - 1]);
    if (left.count == 0 || right[cut].count == 0) continue;
    if (std::max(left.count, right[cut].count) > childCapacity) continue;
    best.offer(left.cost() + right[cut].cost(), left.count, right[cut].count, axis, uint32_t(cut));
  }
}

// Cuts in the middle by count along the longest axis: always possible, and halves the range.
uint32_t splitAtMedian(std::span<BuildItem> items, const CenterRange& range) {
  const glm::dvec3 extent = range.maximum - range.minimum;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
  uint32_t middle = uint32_t(items.size() / 2);
  if (middle % 2 == 1 && items.size() > 2) ++middle;  // an even number fills leaves of two
  std::nth_element(items.begin(), items.begin() + middle, items.end(),
                   [&](const BuildItem& a, const BuildItem& b) {
                     const double centerA = doubleCenter(a.bounds, axis);
                     const double centerB = doubleCenter(b.bounds, axis);
                     return centerA != centerB ? centerA < centerB : a.primitive < b.primitive;
                   });
  return middle;
}

uint32_t splitByBins(std::span<BuildItem> items, const SplitRules& rules, uint64_t childCapacity,
                     uint32_t threadCount) {
  const CenterRange range = centerRangeOf(items, threadCount);
  const Binning binning(range);
  const Bins bins = fillBins(items, binning, rules.firstSingle, threadCount);
  Best best;
  for (int axis = 0; axis < 3; ++axis) offerCuts(bins[axis], axis, childCapacity, best);
  if (best.axis < 0) return splitAtMedian(items, range);
  const auto middle = std::partition(items.begin(), items.end(), [&](const BuildItem& item) {
    return binning.binOf(item.bounds, best.axis) < best.position;
  });
  return uint32_t(middle - items.begin());
}

uint32_t splitBySweep(std::span<BuildItem> items, const SplitRules& rules, uint64_t childCapacity) {
  using Key = std::pair<double, uint32_t>;  // centroid, index in items
  const size_t count = items.size();
  std::array<std::array<Key, kSweepSize>, 3> order;
  std::array<Side, kSweepSize> sides;
  Best best;
  for (int axis = 0; axis < 3; ++axis) {
    for (uint32_t i = 0; i < count; ++i) order[axis][i] = {doubleCenter(items[i].bounds, axis), i};
    std::sort(order[axis].begin(), order[axis].begin() + count);
    for (uint32_t i = 0; i < count; ++i) {
      const BuildItem& item = items[order[axis][i].second];
      sides[i] = {item.bounds, 1, item.primitive >= rules.firstSingle ? 1u : 0u};
    }
    offerCuts({sides.data(), count}, axis, childCapacity, best);
  }
  assert(best.axis >= 0);  // the cut in the middle is never over capacity
  std::array<BuildItem, kSweepSize> sorted;
  for (uint32_t i = 0; i < count; ++i) sorted[i] = items[order[best.axis][i].second];
  std::copy_n(sorted.begin(), count, items.begin());
  return best.position;
}

}  // namespace

uint32_t splitItems(std::span<BuildItem> items, const SplitRules& rules, uint64_t childCapacity,
                    uint32_t threadCount) {
  assert(items.size() >= 2 && items.size() <= 2 * childCapacity);
  if (items.size() <= kSweepSize) return splitBySweep(items, rules, childCapacity);
  const uint32_t useful = items.size() < kParallelSize ? 1 : std::max(threadCount, 1u);
  return splitByBins(items, rules, childCapacity, useful);
}

}  // namespace fragtrace
