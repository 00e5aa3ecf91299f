// SPDX-License-Identifier: MIT
#include "base/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fragtrace {

Summary summarize(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const auto count = double(values.size());
  const auto quantile = [&](double q) { return values[size_t(std::ceil(q * count)) - 1]; };
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0.0;
  for (const double x : values) squares += (x - mean) * (x - mean);
  return {.median = quantile(0.5),
          .mean = mean,
          .stddev = std::sqrt(squares / std::max(1.0, count - 1)),
          .min = values.front(),
          .p95 = quantile(0.95)};
}

double logLogSlope(std::span<const double> xs, std::span<const double> ys) {
  const auto isUsable = [](double value) { return value > 0 && std::isfinite(value); };
  std::vector<double> u;
  std::vector<double> v;
  for (size_t i = 0; i < std::min(xs.size(), ys.size()); ++i) {
    if (!isUsable(xs[i]) || !isUsable(ys[i])) continue;
    u.push_back(std::log(xs[i]));
    v.push_back(std::log(ys[i]));
  }
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  if (u.empty() || std::ranges::min(u) == std::ranges::max(u)) return nothing;

  const double meanU = summarize(u).mean;
  const double meanV = summarize(v).mean;
  double products = 0;
  double squares = 0;
  for (size_t i = 0; i < u.size(); ++i) {
    products += (u[i] - meanU) * (v[i] - meanV);
    squares += (u[i] - meanU) * (u[i] - meanU);
  }
  return products / squares;
}

}  // namespace fragtrace
