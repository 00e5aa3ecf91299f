// SPDX-License-Identifier: MIT
#include "bench/report/axis.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace fragtrace {
namespace {

constexpr double kGreatest = 1e150;
constexpr double kLeastPositive = 1e-290;

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

Axis logarithmicAxis(double least, double greatest) {
  constexpr double kNarrowest = 4.99;  // a factor of 5, however it is rounded
  int low = stepBelow(least);
  int high = stepAbove(greatest);
  for (bool up = true; roundStep(high) / roundStep(low) < kNarrowest; up = !up) up ? ++high : --low;
  return {true, roundStep(low), roundStep(high), 0};
}

Axis linearAxis(double least, double greatest) {
  // So near to 0 that leaving it out would hide how large the values are.
  if (least > 0 && least <= 0.6 * greatest) least = 0;
  if (greatest < 0 && greatest >= 0.6 * least) greatest = 0;
  if (least == greatest) (greatest > 0 ? least : greatest) = 0;
  if (least == greatest) greatest = 1;
  // About six steps, and none that the values' own precision would swallow.
  const double span = std::max(greatest - least, 1e-9 * std::max(std::abs(least), std::abs(greatest)));
  const double step = roundStep(stepAbove(std::max(span, kLeastPositive) / 6));
  return {false, std::floor(least / step) * step, std::ceil(greatest / step) * step, step};
}

std::vector<Tick> logarithmicTicks(const Axis& axis) {
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

std::vector<Tick> linearTicks(const Axis& axis) {
  const double step = axis.step;
  // 1 is divided into fifths, 2 into quarters, 5 into fifths.
  const int parts = std::llround(step / std::pow(10.0, std::floor(std::log10(step)))) == 2 ? 4 : 5;
  const double first = std::round(axis.low / step);
  const int count = int(std::lround((axis.high - axis.low) / step)) * parts;
  std::vector<Tick> ticks;
  for (int i = 0; i <= count; ++i) ticks.push_back({(first + double(i) / parts) * step, i % parts == 0});
  return ticks;
}

/// At most nine digits, whatever the locale.
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

bool isShown(double value, bool isLogarithmic) {
  return std::abs(value) < kGreatest && (!isLogarithmic || value >= kLeastPositive);  // NaN compares false
}

Axis fitAxis(std::span<const double> values, bool isLogarithmic) {
  std::vector<double> shown;
  for (const double value : values)
    if (isShown(value, isLogarithmic)) shown.push_back(value);
  if (shown.empty()) return isLogarithmic ? Axis{true, 1, 10, 0} : Axis{false, 0, 1, 0.2};
  const auto [least, greatest] = std::ranges::minmax(shown);
  return isLogarithmic ? logarithmicAxis(least, greatest) : linearAxis(least, greatest);
}

double positionOn(const Axis& axis, double value) {
  if (!axis.isLogarithmic) return (value - axis.low) / (axis.high - axis.low);
  const double low = std::log(axis.low);
  return (std::log(value) - low) / (std::log(axis.high) - low);
}

std::vector<Tick> ticksOf(const Axis& axis) {
  return axis.isLogarithmic ? logarithmicTicks(axis) : linearTicks(axis);
}

std::string labelOf(const Axis& axis, double value) {
  if (value == 0) return "0";
  const double greatest = std::max(std::abs(axis.low), std::abs(axis.high));
  const double least = axis.isLogarithmic ? axis.low : greatest;
  constexpr double kRounding = 1e-9;
  if (least >= 1e-4 * (1 - kRounding) && greatest <= 1e5 * (1 + kRounding)) return decimal(value);
  const int exponent = int(std::floor(std::log10(std::abs(value) * (1 + kRounding))));
  const std::string mantissa = decimal(value / std::pow(10.0, exponent));
  const std::string power = "10" + superscript(exponent);
  return axis.isLogarithmic && mantissa == "1" ? power : mantissa + "\u00d7" + power;
}

}  // namespace fragtrace
