// SPDX-License-Identifier: MIT
// The frame that the programs of this project share around their work.
#pragma once

#include <functional>

namespace fragtrace {

using MainFunction = std::function<int(int argc, const char* const* argv)>;

/// Prepares streams and signals, runs the function, and turns what it throws (errors.h) into a message and an
/// exit status, which main() returns.
int runProgram(const MainFunction& run, int argc, char** argv);

}  // namespace fragtrace
