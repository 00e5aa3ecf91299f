// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

namespace fragtrace {

inline constexpr int kNoFile = -1;  ///< /dev/null

/// Starts a program, by its path or its name on PATH, with the words of its command line, the first of which
/// is its own name. Each pair of `files` is a descriptor of the new process and one of ours that it gets, or
/// kNoFile. Other descriptors are inherited. Signals of the terminal do not reach it. Sets `process`. Returns
/// the error of posix_spawnp, or 0 if the program was started.
int spawnProcess(const std::string& program, std::vector<std::string> words,
                 const std::vector<std::pair<int, int>>& files, pid_t& process);

}  // namespace fragtrace
