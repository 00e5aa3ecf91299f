// SPDX-License-Identifier: MIT
#pragma once

/// FRAGTRACE_HEAP_LOG names a file that gets, every five seconds of calls, the megabytes of the heap that are
/// in use. The resident memory also holds what the allocator keeps: AddressSanitizer's quarantine, free
/// lists, pages not given back. Not from two threads at once.
void logHeap();
