// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace fragtrace {

/// From now on peakMemory() tells the largest resident size since; false where the system cannot do that.
bool resetPeakMemory();

/// Bytes; 0 where the system does not tell.
size_t peakMemory();

}  // namespace fragtrace
