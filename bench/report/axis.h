// SPDX-License-Identifier: MIT
// The axes of a chart, which are logarithmic: their ranges, ticks and labels.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace fragtrace {

/// A range of positive values, low < high.
struct Axis {
  double low = 1;
  double high = 10;
};

struct Tick {
  double value = 0;
  bool isLabelled = false;  ///< the others are for the light grid only
};

/// True for what an axis can show: numbers from 1e-290 on and below 1e150, which keeps all sums finite.
bool isShown(double value);

/// The axis that holds all values that can be shown. It ends at 1, 2 or 5 times powers of 10 and spans a
/// factor of 5 at least. Without any value it is 1 to 10.
Axis fitAxis(std::span<const double> values);

/// Returns the position of a value on the axis: 0 at low, 1 at high. The axis can show the value.
double positionOn(const Axis& axis, double value);

/// In increasing order, from low to high: the decades, while there is room with labels at 2 and 5 and further
/// ticks between.
std::vector<Tick> ticksOf(const Axis& axis);

/// Plain decimals where the whole axis lies within 0.0001 and 100000, elsewhere powers of ten with exponents
/// in Unicode's superscripts. UTF-8.
std::string labelOf(const Axis& axis, double value);

}  // namespace fragtrace
