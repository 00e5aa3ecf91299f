// SPDX-License-Identifier: MIT
// The axes of a chart: their ranges, ticks and labels.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace fragtrace {

/// A range of finite values, low < high; both above 0 on a logarithmic axis.
struct Axis {
  bool isLogarithmic = false;
  double low = 0;
  double high = 1;
  double step = 0.2;  ///< from one labelled tick to the next; linear only
};

struct Tick {
  double value = 0;
  bool isLabelled = false;  ///< the others are for the light grid only
};

/// True for what an axis can show: numbers below 1e150 (which keeps all sums finite), and on a logarithmic
/// axis only those from 1e-290 on.
bool isShown(double value, bool isLogarithmic);

/// The axis that holds all values that can be shown, from tick to tick. A linear one begins at 0 where that
/// is near, a logarithmic one ends at 1, 2 or 5 times powers of 10 and spans a factor of 5 at least. Without
/// any value it is 0 to 1, or 1 to 10.
Axis fitAxis(std::span<const double> values, bool isLogarithmic);

/// Where a value lies: 0 at low, 1 at high. The value is one that can be shown.
double positionOn(const Axis& axis, double value);

/// In increasing order, from low to high. Logarithmic: the decades, while there is room with labels at 2 and
/// 5 and further ticks between.
std::vector<Tick> ticksOf(const Axis& axis);

/// Plain decimals where the whole axis lies within 0.0001 and 100000 (a linear one: where its larger end
/// does), elsewhere powers of ten with exponents in Unicode's superscripts. UTF-8.
std::string labelOf(const Axis& axis, double value);

}  // namespace fragtrace
