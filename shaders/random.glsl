// SPDX-License-Identifier: MIT
// Random numbers as a pure function of pixel, sample, dimension and seed.

#include "mix_bits.glsl"

/// The key from which all random numbers of a pixel derive.
uint pixelKey(uint pixelX, uint pixelY, uint seed) { return mixBits(pixelX + mixBits(pixelY + mixBits(seed))); }

/// Returns the same for one path.
uint pathKey(uint key, uint sampleIndex) { return mixBits(key + mixBits(sampleIndex)); }

/// 32 bits for one dimension of a path.
uint randomBits(uint key, uint dimension) { return mixBits(key ^ mixBits(dimension + 0x9e3779b9u)); }

/// 32 bits as a number in [0, 1), of which 24 count.
float unitFloat(uint bits) { return float(bits >> 8) * 5.9604644775390625e-8f; }

/// Uniform in [0, 1), for one dimension of a path.
float randomFloat(uint key, uint dimension) { return unitFloat(randomBits(key, dimension)); }

/// The numbers of one path come from the key of pixel and seed (kSobol), else the path's own key, and the sample's
/// index with its bits reversed.
struct Sampler {
  uint key;
  uint reversed;
};

/// An Owen scramble of numbers whose bits are reversed: each bit is flipped by a hash of those below it (Laine and
/// Karras, Stratified Sampling for Stochastic Transparency, 2011; constants of Vegdahl, 2021).
uint owenScramble(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Second dimension of the Sobol sequence, bits reversed: the polynomial of the index over GF(2) shifted by one, since
/// its generator matrix is Pascal's triangle.
uint sobolSecond(uint x) {
  x ^= x >> 16;
  x ^= (x & 0xff00ff00u) >> 8;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xccccccccu) >> 2;
  return x ^ ((x & 0xaaaaaaaau) >> 1);
}

Sampler makeSampler(uint key, uint sampleIndex) {
  Sampler s;
  s.key = kSobol ? key : pathKey(key, sampleIndex);
  s.reversed = bitfieldReverse(sampleIndex);
  return s;
}

uint dimensionSeed(Sampler s, uint dimension) { return randomBits(s.key, dimension); }

/// The sample's index, shuffled within blocks of powers of two, so that numbers of different dimensions are independent
/// (Burley, Practical Hash-based Owen Scrambling, 2020).
uint shuffledIndex(Sampler s, uint seed) { return bitfieldReverse(owenScramble(s.reversed, seed)); }

/// 32 bits for one dimension. Over the samples of a pixel they are an Owen-scrambled van der Corput sequence, or
/// independent.
uint drawBits(Sampler s, uint dimension) {
  uint seed = dimensionSeed(s, dimension);
  return kSobol ? bitfieldReverse(owenScramble(shuffledIndex(s, seed), mixBits(seed + 1u))) : seed;
}

/// Uniform in [0, 1).
float drawFloat(Sampler s, uint dimension) { return unitFloat(drawBits(s, dimension)); }

/// Two 32-bit numbers that are stratified together, Owen-scrambled Sobol points; uses `dimension` and `dimension + 1`.
uvec2 drawPairBits(Sampler s, uint dimension) {
  uint seed = dimensionSeed(s, dimension);
  uint other = dimensionSeed(s, dimension + 1u);
  if (!kSobol) return uvec2(seed, other);
  uint index = shuffledIndex(s, seed);
  return uvec2(bitfieldReverse(owenScramble(index, mixBits(seed + 1u))),
               bitfieldReverse(owenScramble(sobolSecond(index), other)));
}

/// Returns the same as numbers in [0, 1).
vec2 drawPair(Sampler s, uint dimension) {
  uvec2 bits = drawPairBits(s, dimension);
  return vec2(unitFloat(bits.x), unitFloat(bits.y));
}

/// 32 bits, independent from sample to sample.
uint hashBits(Sampler s, uint dimension) {
  return randomBits(mixBits(s.key + bitfieldReverse(s.reversed)), dimension);
}

/// Returns the same as a number in [0, 1).
float hashFloat(Sampler s, uint dimension) { return unitFloat(hashBits(s, dimension)); }
