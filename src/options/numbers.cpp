// SPDX-License-Identifier: MIT
#include "options/numbers.h"

#include <charconv>
#include <cmath>
#include <string>

namespace fragtrace {

namespace {

template <typename Number>
bool parseWhole(const std::string& text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && rest == end;
}

/// With a unit or without; false for anything else.
bool parseSize(std::string text, uint64_t& bytes) {
  if (text.starts_with('-')) return false;
  try {
    return CLI::AsSizeValue(true)(text).empty() && parseWhole(text, bytes);
  } catch (const CLI::Error&) {
    return false;
  }
}

}  // namespace

CLI::Validator wholeNumber(int64_t least, int64_t most) {
  const std::string wanted = "whole number from " + std::to_string(least) + " to " + std::to_string(most);
  return CLI::Validator(
      [=](const std::string& text) -> std::string {
        int64_t value = 0;
        const bool good = parseWhole(text, value) && value >= least && value <= most;
        return good ? "" : "'" + text + "' is no " + wanted;
      },
      "");
}

CLI::Validator finiteNumber() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        double value = 0.0;
        return CLI::detail::lexical_cast(text, value) && !std::isfinite(value) ? "not a finite number" : "";
      },
      "");
}

CLI::Validator finiteSeconds() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        double seconds = 0.0;
        const bool isNumber = CLI::detail::lexical_cast(text, seconds);
        return isNumber && std::isfinite(seconds) && seconds >= 0.0 ? "" : "is no finite number from 0 on";
      },
      "SECONDS");
}

CLI::Validator memorySize(uint64_t least) {
  const std::string wanted =
      "no size from " + std::to_string(least / 1'000'000) + "MB on, such as 500MB or 2GiB";
  return CLI::Validator(
      [=](std::string& text) -> std::string {
        uint64_t bytes = 0;
        if (!parseSize(text, bytes) || bytes < least) return "'" + text + "' is " + wanted;
        text = std::to_string(bytes);
        return "";
      },
      "");
}

}  // namespace fragtrace
