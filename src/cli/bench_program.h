// SPDX-License-Identifier: MIT
// `bench` is a program of its own, which lies beside this one.
#pragma once

#include <span>

namespace fragtrace {

inline constexpr const char* kBenchSentence = "measure speed and error";  ///< of --help

/// Replaces this process by that program if the command is `bench`, with the words that follow; else returns.
/// The program's name comes first.
/// Throws RenderError if the program is missing.
void becomeBenchProgram(std::span<const char* const> asked);

}  // namespace fragtrace
