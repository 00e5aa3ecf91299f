// SPDX-License-Identifier: MIT
// Statistics of a series of measurements.
#pragma once

#include <span>
#include <vector>

namespace fragtrace {

/// In the unit of the values. Quantiles are nearest rank: the ceil(q n)-th smallest of n values.
struct Summary {
  double median = 0;
  double mean = 0;
  double stddev = 0;  ///< standard deviation of the sample, with n - 1; 0 for one value
  double min = 0;
  double p95 = 0;  ///< the quantile of q = 0.95
};

/// In any order, without NaN; all zero when there are none.
Summary summarize(std::vector<double> values);

/// The slope of the line through (log x, log y) that has the least squares of errors in log y: the exponent p
/// of y ~ x^p. Points that are not positive and finite in both are left out, as are those of the longer
/// list that have no partner; NaN where what remains has fewer than two different x.
double logLogSlope(std::span<const double> xs, std::span<const double> ys);

}  // namespace fragtrace
