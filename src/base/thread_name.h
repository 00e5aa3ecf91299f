// SPDX-License-Identifier: MIT
#pragma once

#include <pthread.h>

namespace fragtrace {

/// Names this thread for profilers and debuggers: at most 15 characters. Main threads keep the program's
/// name, by which ps and killall know the process.
inline void nameThread(const char* name) { ::pthread_setname_np(::pthread_self(), name); }

}  // namespace fragtrace
