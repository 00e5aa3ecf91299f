// SPDX-License-Identifier: MIT
// Tables that invert distributions in constant time. Neighbouring numbers draw neighbouring places, so
// stratified numbers give stratified places; an alias table would scatter them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fragtrace {

/// One of the equal steps of a table over [0, 1). The place drawn is linear in the number between the step's
/// ends and up to two places where the density changes (shaders/environment.glsl: invertTable).
struct InversionStep {
  float first = 0.0f;  ///< place at the beginning of the step
  float last = 0.0f;   ///< place at its end
  uint32_t numbers =
      0;  ///< where the density changes, of the step, in 65,536ths: first | second << 16, 0: nowhere
  uint32_t places = 0;  ///< the places there: first | second << 16
};
static_assert(sizeof(InversionStep) == 16);

/// Fills `steps` so that they draw a place in [0, weights.size()) by a density that is constant between whole
/// numbers, and replaces the weights by that density (its mean is 1). It is proportional to the weights,
/// unless the density changes more than twice within one step: it then changes where the weights differ most.
/// Weights are finite and not negative, and there are at most 65,535. If all are zero, places are drawn
/// evenly. Returns their sum.
double makeInversionTable(std::span<float> weights, std::span<InversionStep> steps);

/// The range of an index among 2^32 equally likely numbers, by its weight, with a guide table (Chen and Asau,
/// On Generating Random Variates from an Empirical Distribution, 1974).
struct InversionEntry {
  uint32_t first = 0;  ///< the index that the first number of the entry's equal share of the numbers draws
  uint32_t last = 0;   ///< index that its last number draws
  uint32_t end = 0;    ///< the last number that draws this index
};

/// One entry per index. Weights are finite and not negative; when all are zero, every index is equally
/// likely.
std::vector<InversionEntry> makeInversionEntries(std::span<const double> weights);

}  // namespace fragtrace
