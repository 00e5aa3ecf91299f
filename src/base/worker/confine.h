// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace fragtrace {

/// Leaves the process the system calls that decoding takes: memory without new code, threads of its own, the
/// clock, and reading and writing of files that are open. All others fail: it opens no file, no socket and no
/// process from now on. Returns why that is not so, such as a kernel that refuses; empty: it is so.
std::string confine();

}  // namespace fragtrace
