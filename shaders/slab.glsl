// SPDX-License-Identifier: MIT
// The slab test of four boxes, on the bits of distances. Signed integers order non-negative floats as floats do, and
// order negative ones below them. The test needs no more, as its near limit is 0. This is cheaper than a float's
// minimum on llvmpipe, which handles NaN. No NaN comes here, since 1 / d is finite.
vec4 slabMin(vec4 a, vec4 b) { return intBitsToFloat(min(floatBitsToInt(a), floatBitsToInt(b))); }
vec4 slabMax(vec4 a, vec4 b) { return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b))); }

/// 32 units in the last place cover the rounding that grows with the distance (docs/design/numerics.md).
bvec4 slabHits(vec4 near, vec4 far) { return lessThanEqual(floatBitsToInt(near), floatBitsToInt(far) + 32); }

ivec4 slabOrder(vec4 near) { return floatBitsToInt(near); }
