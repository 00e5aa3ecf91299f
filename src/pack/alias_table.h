// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fragtrace {

/// One entry of an alias table: drawn uniformly, it stands for itself below the threshold and for its alias
/// above.
struct AliasEntry {
  float threshold = 1.0f;
  uint32_t alias = 0;
};

/// A table that draws index i with probability weights[i] / sum in constant time (Walker, 1977; Vose, 1991).
/// Weights are finite and not negative; when all are zero, every index is equally likely.
std::vector<AliasEntry> makeAliasTable(std::span<const double> weights);

}  // namespace fragtrace
