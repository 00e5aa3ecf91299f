// SPDX-License-Identifier: MIT
// FNV-1a (Fowler, Noll and Vo), 64 bits. It distinguishes contents and finds damage, but does not protect
// against malice.
#pragma once

#include <cstdint>

namespace fragtrace {

inline constexpr uint64_t kHashStart = 0xcbf29ce484222325u;

/// The hash of what `hash` stands for, followed by these values: bytes for FNV-1a itself, or larger words.
template <typename Values>
uint64_t hashOf(const Values& values, uint64_t hash = kHashStart) {
  for (const auto value : values) hash = (hash ^ uint64_t(value)) * 0x100000001b3u;
  return hash;
}

}  // namespace fragtrace
