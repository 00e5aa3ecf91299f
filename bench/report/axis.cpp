// SPDX-License-Identifier: MIT
#include "bench/report/axis.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>

namespace fragtrace {
namespace {

constexpr double kGreatest = 1e150;
constexpr double kLeast = 1e-290;

/// The k-th of ..., 0.5, 1, 2, 5, 10, ...; 1 is the 0th.
double roundStep(int k) {
  constexpr std::array kMantissas{1.0, 2.0, 5.0};
  const int decade = int(std::floor(k / 3.0));
  return kMantissas[size_t(k - 3 * decade)] * std::pow(10.0, decade);
}

/// The last of them that is at most the value.
int stepBelow(double value) {
  int k = 3 * int(std::floor(std::log10(value))) - 1;
  while (roundStep(k + 1) <= value) ++k;
  return k;
}

int stepAbove(double value) {
  const int k = stepBelow(value);
  return roundStep(k) < value ? k + 1 : k;
}

/// Writes a number with at most nine digits. The locale does not matter.
std::string decimal(double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 9);
  return {text.data(), end.ptr};
}

std::string superscript(int value) {
  constexpr std::array kDigits{"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                               "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string result;
  for (const char c : std::to_string(value)) result += c == '-' ? "\u207b" : kDigits[size_t(c - '0')];
  return result;
}

}  // namespace

bool isShown(double value) { return value >= kLeast && value < kGreatest; }  // NaN compares false

Axis fitAxis(std::span<const double> values) {
  constexpr double kNarrowest = 4.99;  // a factor of 5, however it is rounded
  std::vector<double> shown;
  std::ranges::copy_if(values, std::back_inserter(shown), isShown);
  if (shown.empty()) return {};
  const auto [least, greatest] = std::ranges::minmax(shown);
  int low = stepBelow(least);
  int high = stepAbove(greatest);
  for (bool up = true; roundStep(high) / roundStep(low) < kNarrowest; up = !up) up ? ++high : --low;
  return {roundStep(low), roundStep(high)};
}

double positionOn(const Axis& axis, double value) {
  const double low = std::log(axis.low);
  return (std::log(value) - low) / (std::log(axis.high) - low);
}

std::vector<Tick> ticksOf(const Axis& axis) {
  const double decades = std::log10(axis.high) - std::log10(axis.low) - 1e-6;  // however it is rounded
  const int stride = std::max(1, int(std::ceil(decades / 9)));
  std::vector<Tick> ticks;
  for (int n = int(std::floor(std::log10(axis.low))); n <= int(std::ceil(std::log10(axis.high))); ++n) {
    for (int m = 1; m <= 9; ++m) {
      const double value = m * std::pow(10.0, n);
      if (value < axis.low || value > axis.high || (m > 1 && decades > 6)) continue;
      const bool isStep = decades <= 3 && (m == 2 || m == 5);
      ticks.push_back({value, isStep || (m == 1 && n % stride == 0)});
    }
  }
  return ticks;
}

std::string labelOf(const Axis& axis, double value) {
  constexpr double kRounding = 1e-9;
  if (axis.low >= 1e-4 * (1 - kRounding) && axis.high <= 1e5 * (1 + kRounding)) return decimal(value);
  const int exponent = int(std::floor(std::log10(value * (1 + kRounding))));
  const std::string mantissa = decimal(value / std::pow(10.0, exponent));
  const std::string power = "10" + superscript(exponent);
  return mantissa == "1" ? power : mantissa + "\u00d7" + power;
}

}  // namespace fragtrace
