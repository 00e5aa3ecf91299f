// SPDX-License-Identifier: MIT
// Random numbers as a pure function of pixel, sample, dimension and seed.

/// A bijective mix of 32 bits (Wellons, 2018: lowbias32).
uint mixBits(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

/// The key of one path; every random number of the path derives from it.
uint pathKey(uint pixelX, uint pixelY, uint sampleIndex, uint seed) {
  return mixBits(pixelX + mixBits(pixelY + mixBits(sampleIndex + mixBits(seed))));
}

/// Uniform in [0, 1), 24 bits, for one dimension of a path.
float randomFloat(uint key, uint dimension) {
  uint bits = mixBits(key ^ mixBits(dimension + 0x9e3779b9u));
  return float(bits >> 8) * 5.9604644775390625e-8f;
}
