// SPDX-License-Identifier: MIT
#include "options/numbers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/text.h"
#include "image/display/page_color.h"
#include "options/library/option_facts.h"
#include "options/option_text.h"

namespace fragtrace {

namespace {

/// Reads a size with a unit or without. Returns none for anything else.
std::optional<uint64_t> sizeIn(std::string text) {
  if (text.starts_with('-')) return std::nullopt;
  try {
    return CLI::AsSizeValue(true)(text).empty() ? numberOfAll<uint64_t>(text) : std::nullopt;
  } catch (const CLI::Error&) {
    return std::nullopt;
  }
}

/// Says why a text is no finite number; empty: it is one.
std::string whyNoNumber(const std::string& text) {
  const std::optional<double> value = numberIn(text);
  if (!value) return "'" + text + "' is no number";
  return std::isfinite(*value) ? "" : "'" + text + "' is not a finite number";
}

}  // namespace

std::optional<double> numberIn(const std::string& text) {
  double value = 0.0;
  return CLI::detail::lexical_cast(text, value) ? std::optional(value) : std::nullopt;
}

glm::vec3 colorIn(const std::string& what, const std::string& text, double most) {
  if (const std::optional<glm::vec3> named = pageColor(text)) return *named;
  const auto refuse = [&](const std::string& why) { throw UsageError(what + ": " + why); };
  if (text.starts_with('#')) refuse("'" + text + "' is no colour such as #ff8000 or #f80");
  const std::vector<std::string> parts = CLI::detail::split(text, ',');
  const std::optional<double> first = numberIn(CLI::detail::trim_copy(parts.front()));
  if (parts.size() == 1 && !first)
    refuse("'" + text + "' is no name of a colour, #rrggbb or linear R,G,B" +
           didYouMean(text, pageColorNames()));
  if (parts.size() != 3) refuse("takes a name, #rrggbb or three numbers, as in 1,1,1 for white");
  glm::vec3 color;
  for (size_t c = 0; c < 3; ++c) {
    const std::string part = CLI::detail::trim_copy(parts[c]);
    if (const std::string why = whyNoNumber(part); !why.empty()) refuse(why + ", as in 1,1,1 for white");
    const double value = *numberIn(part);
    if (!(value >= 0.0 && value <= most)) refuse("a colour is in the range 0 to " + exactText(most));
    color[int(c)] = float(value);
  }
  return color;
}

CLI::Validator wholeNumber(int64_t least, int64_t most, const std::string& form) {
  const std::string wanted = "whole number from " + std::to_string(least) + " to " + std::to_string(most) +
                             (form.empty() ? "" : ", as in " + form);
  return withFacts({.least = double(least), .most = double(most)}, [=](const std::string& text) {
    const auto value = numberOfAll<int64_t>(CLI::detail::trim_copy(text));
    const bool good = value && *value >= least && *value <= most;
    return good ? std::string() : "'" + text + "' is no " + wanted;
  });
}

CLI::Validator realNumber(const std::string& form) {
  return CLI::Validator(
      [=](const std::string& text) {
        const std::string reason = whyNoNumber(text);
        return reason.empty() || form.empty() ? reason : reason + ", as in " + form;
      },
      "");
}

CLI::Validator realNumberFrom(double least) {
  return withFacts({.least = least}, [=](const std::string& text) {
    const std::optional<double> value = numberIn(text);
    if (!value) return whyNoNumber(text);
    const bool good = std::isfinite(*value) && *value >= least;
    return good ? std::string() : "'" + text + "' is no finite number from " + shortText(least) + " on";
  });
}

CLI::Validator realNumber(double least, double most) {
  const std::string bounds = shortText(least) + " to " + shortText(most);
  return withFacts({.least = least, .most = most}, [=](const std::string& text) {
    std::string wrong = whyNoNumber(text);
    if (!wrong.empty()) return wrong;
    const double value = *numberIn(text);
    return value >= least && value <= most ? "" : "'" + text + "' is not in the range " + bounds;
  });
}

CLI::Validator frameRate(double least, double most) {
  return withFacts({.least = least, .most = most}, [=, bounds = realNumber(least, most)](std::string& text) {
    if (const size_t bar = text.find('/'); bar != std::string::npos) {
      const std::optional<double> above = numberIn(text.substr(0, bar));
      const std::optional<double> below = numberIn(text.substr(bar + 1));
      if (!above || !below || *below == 0.0) return "'" + text + "' is no fraction such as 30000/1001";
      text = exactText(*above / *below);
    }
    if (std::string wrong = bounds(text); !wrong.empty()) return wrong;
    for (const double whole : {24.0, 30.0, 48.0, 60.0, 120.0}) {
      const double rate = whole * 1000.0 / 1001.0;
      if (std::abs(*numberIn(text) - rate) < 2e-6 * rate) text = exactText(rate);
    }
    return std::string();
  });
}

CLI::Validator oneOf(const std::vector<std::string>& names) {
  return withFacts({.choices = names}, [names](const std::string& text) {
    return std::ranges::find(names, text) != names.end() ? std::string() : whyNoneOf(text, names);
  });
}

CLI::Validator memorySize(uint64_t least) {
  const std::string wanted =
      "no size from " + std::to_string(least / 1'000'000) + "MB on, such as 500MB or 2GiB";
  return CLI::Validator(
      [=](std::string& text) -> std::string {
        const std::optional<uint64_t> bytes = sizeIn(text);
        if (!bytes || *bytes < least) return "'" + text + "' is " + wanted;
        text = std::to_string(*bytes);
        return "";
      },
      "");
}

}  // namespace fragtrace
