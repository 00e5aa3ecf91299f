// SPDX-License-Identifier: MIT
// Minimum and maximum for the slab test, on the bits: signed integers order non-negative floats as floats do, and a
// negative one always below them, which is all the test needs as its near limit is 0. Cheaper than a float's
// minimum on llvmpipe, which takes care of NaN; no NaN comes here, since 1 / d is finite.
float slabMin(float a, float b) { return intBitsToFloat(min(floatBitsToInt(a), floatBitsToInt(b))); }
float slabMax(float a, float b) { return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b))); }
