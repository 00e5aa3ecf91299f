// SPDX-License-Identifier: MIT
// Checks of option values whose messages quote the value and say what is wanted.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace fragtrace {

/// A whole number within these bounds.
CLI::Validator wholeNumber(int64_t least, int64_t most);

/// Neither infinite nor NaN, which the library's ranges let pass.
CLI::Validator finiteNumber();

/// The same from 0 on, in seconds.
CLI::Validator finiteSeconds();

/// Bytes, as a number with or without a unit (MB or MiB); the text becomes the plain number.
CLI::Validator memorySize(uint64_t least);

}  // namespace fragtrace
