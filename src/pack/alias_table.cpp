// SPDX-License-Identifier: MIT
#include "pack/alias_table.h"

#include <numeric>

namespace fragtrace {

std::vector<AliasEntry> makeAliasTable(std::span<const double> weights) {
  const size_t count = weights.size();
  std::vector<AliasEntry> table(count);
  for (size_t i = 0; i < count; ++i) table[i].alias = uint32_t(i);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (sum <= 0.0) return table;

  std::vector<double> scaled(count);
  std::vector<uint32_t> small;
  std::vector<uint32_t> large;
  for (size_t i = 0; i < count; ++i) {
    scaled[i] = weights[i] * double(count) / sum;
    (scaled[i] < 1.0 ? small : large).push_back(uint32_t(i));
  }
  while (!small.empty() && !large.empty()) {
    const uint32_t low = small.back();
    const uint32_t high = large.back();
    small.pop_back();
    table[low] = {float(scaled[low]), high};
    scaled[high] -= 1.0 - scaled[low];
    if (scaled[high] < 1.0) {
      large.pop_back();
      small.push_back(high);
    }
  }
  return table;
}

}  // namespace fragtrace
