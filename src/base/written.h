// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>

namespace fragtrace {

/// Set before the first file takes its place, for a handler of signals that says what is there.
inline volatile std::sig_atomic_t filesMayBeWritten = 0;

}  // namespace fragtrace
