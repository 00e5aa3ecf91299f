// SPDX-License-Identifier: MIT
// Checks of option values whose messages quote the value and say what is wanted.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace fragtrace {

/// The number that a text is, as the command line reads it; none where it is no number.
std::optional<double> numberIn(const std::string& text);

/// The linear colour that a word is: R,G,B, each from 0 to `most`, or a name or digits of pageColor(). Throws
/// UsageError, whose message begins with `what`.
glm::vec3 colorIn(const std::string& what, const std::string& text, double most);

/// A whole number within these bounds. A message about it names the `form` that the word has, if it is given.
CLI::Validator wholeNumber(int64_t least, int64_t most, const std::string& form = "");

/// A number that is neither infinite nor NaN. `form` as above.
CLI::Validator realNumber(const std::string& form = "");

/// Does the same from `least` on.
CLI::Validator realNumberFrom(double least);

/// Does the same within these bounds.
CLI::Validator realNumber(double least, double most);

/// Pictures per second within these bounds, as a number or a fraction; the text becomes the plain number. The
/// rounded names of broadcast rates mean these: 23.976 is 24000/1001 (SMPTE ST 12-1).
CLI::Validator frameRate(double least, double most);

/// Accepts one of these names.
CLI::Validator oneOf(const std::vector<std::string>& names);

/// Bytes, as a number with or without a unit (MB or MiB); the text becomes the plain number.
CLI::Validator memorySize(uint64_t least);

}  // namespace fragtrace
