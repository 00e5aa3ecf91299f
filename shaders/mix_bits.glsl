// SPDX-License-Identifier: MIT
// Also read by src/image/display/tone_map.cpp.

/// A bijective mix of 32 bits (Wellons, 2018: lowbias32).
uint mixBits(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}
