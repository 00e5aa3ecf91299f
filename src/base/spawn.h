// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

namespace fragtrace {

inline constexpr int kNoFile = -1;  ///< /dev/null

/// Starts a program, by its path or its name on PATH, with the words of its command line, the first of which
/// is its own name. Its files are pairs of a descriptor there and one of ours, or kNoFile; others are
/// inherited. Signals of the terminal do not reach it. Returns the error of posix_spawnp; 0 where it runs as
/// `process`.
int spawnProcess(const std::string& program, std::vector<std::string> words,
                 const std::vector<std::pair<int, int>>& files, pid_t& process);

}  // namespace fragtrace
