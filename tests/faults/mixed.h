// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// A number whose bits depend on all bits of another (Steele, Lea and Flood, Fast Splittable Pseudorandom
/// Number Generators, 2014).
inline uint64_t mixed(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}
