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

/// Returns true if standard output was closed before the program began. Then lines about written files are
/// left out, and a command that prints a result fails (checkPrinted).
bool standardOutputIsClosed();

/// Writes the file of startTimeline(), if there is one. Throws RenderError.
void writeTimeline();

/// Ends the process, once all is written, with this status. The system takes back at once what the driver and
/// its compiler would give back piece by piece, which takes 20 ms. Sanitizers look for leaks when the caller
/// returns, so there it comes back with the status.
int leave(int status);

}  // namespace fragtrace
