// SPDX-License-Identifier: MIT
// Statistics of a series of measurements.
#pragma once

#include <span>
#include <vector>

namespace fragtrace {

/// A summary in the unit of the values. Quantiles are nearest rank: the ceil(q n)-th smallest of n values.
struct Summary {
  double median = 0;
  double mean = 0;
  double stddev = 0;  ///< standard deviation of the sample, with n - 1; 0 for one value
  double min = 0;
  double p95 = 0;  ///< the quantile of q = 0.95
};

/// The values may be in any order, without NaN. The summary of no values is zero.
Summary summarize(std::vector<double> values);

/// Returns the slope of the line that fits (log x, log y) best by least squares of the errors in log y: the
/// exponent p of y ~ x^p. Points that are not positive and finite in both are left out. So is what the longer
/// list has beyond the shorter one. Returns NaN if fewer than two different x remain.
double logLogSlope(std::span<const double> xs, std::span<const double> ys);

}  // namespace fragtrace
