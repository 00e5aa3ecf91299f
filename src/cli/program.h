// SPDX-License-Identifier: MIT
// The frame that the programs of this project share around their work.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace fragtrace {

using MainFunction = std::function<int(int argc, const char* const* argv)>;

/// Prepares streams and signals, runs the function, and turns what it throws (errors.h) into a message and an
/// exit status, which main() returns.
int runProgram(const MainFunction& run, int argc, char** argv);

/// The path of a program that ownFile() (base/plugin.h) finds. Throws RenderError where it is missing:
/// `user` is the command that needs it.
std::filesystem::path ownProgram(const std::string& name, const std::string& user);

}  // namespace fragtrace
