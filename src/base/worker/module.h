// SPDX-License-Identifier: MIT
// A module of the worker process: a shared object with one function, which does one kind of work.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>

namespace fragtrace {

/// The place for a result, and how much of it is used.
struct WorkOutput {
  std::span<uint8_t> room;
  uint64_t used = 0;

  void append(std::span<const uint8_t> bytes) {
    if (bytes.size() > room.size() - used) throw std::runtime_error("it is larger than what its header says");
    std::ranges::copy(bytes, room.begin() + std::ptrdiff_t(used));
    used += bytes.size();
  }
};

/// A module answers an empty input with nothing, and does all that its first use would spend time on. It may
/// throw any std::exception, whose text becomes the reply's reason.
using WorkFunction = void(std::span<const uint8_t> input, WorkOutput& output);
inline constexpr const char* kWorkFunction = "fragtraceWork";
extern "C" WorkFunction fragtraceWork;

}  // namespace fragtrace
