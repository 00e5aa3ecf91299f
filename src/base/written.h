// SPDX-License-Identifier: MIT
// Notes for handlers of signals, which may call few functions.
#pragma once

#include <array>
#include <csignal>

namespace fragtrace {

/// Set before the first file takes its place, for a handler that says what is there.
inline volatile std::sig_atomic_t filesMayBeWritten = 0;

/// The path of the part that is being written, for a handler that removes it; empty if there is none.
inline std::array<char, 4096> partBeingWritten{};

}  // namespace fragtrace
