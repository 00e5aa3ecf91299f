// SPDX-License-Identifier: MIT
// Minimum and maximum for the slab test, on the bits. Signed integers order non-negative floats as floats do, and order
// negative ones below them. The test needs no more, as its near limit is 0. This is cheaper than a float's minimum on
// llvmpipe, which handles NaN. No NaN comes here, since 1 / d is finite.
float slabMin(float a, float b) { return intBitsToFloat(min(floatBitsToInt(a), floatBitsToInt(b))); }
float slabMax(float a, float b) { return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b))); }
