// SPDX-License-Identifier: MIT
// `bench` is a program of its own, which lies beside this one.
#pragma once

namespace fragtrace {

inline constexpr const char* kBenchSentence = "measure speed and error";  ///< of --help

/// Where the command is `bench`, this process becomes that program, with the words that follow. Else it comes
/// back. Throws RenderError where the program is missing.
void becomeBenchProgram(int argc, const char* const* argv);

}  // namespace fragtrace
