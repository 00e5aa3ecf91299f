// SPDX-License-Identifier: MIT
// Counts the work of samples (--count-work); other programs have the empty functions of work/none.glsl. A lane counts
// into variables of its own. The counts of a sample reach the sums when it is complete, so that one that begins again
// counts once. Where it waits, they are kept by its pixel in the tile.
// work/kinds.glsl is written by src/shader/assemble.cpp: kWorkCount, the lane's variables work[], and a function for
// each kind, such as countSurfaces(number).
#include "work/kinds.glsl"

layout(std430, binding = kWorkBinding) restrict buffer WorkBlock {
  uint workSums[2 * kWorkCount];  // 64 bits each, the lower half first
  uint workKept[];                // kWorkCount for each pixel of the tile
};

void forgetWork() {
  for (int i = 0; i < kWorkCount; ++i) work[i] = 0u;
}

uint workOf(int kind) {
  uint number = 0u;
  for (int i = 0; i < kWorkCount; ++i) number = i == kind ? work[i] : number;
  return number;
}

/// Returns the number of kinds in a form that compilers do not know, so that they keep the loops. llvmpipe takes
/// seconds to compile them otherwise.
int kindsOfWork() { return min(kWorkCount, workKept.length()); }

/// The sample of a pixel begins.
void beginWork(int pixel) {
  forgetWork();
  for (int i = 0; i < kindsOfWork(); ++i) workKept[pixel * kWorkCount + i] = 0u;
}

/// The sample of a pixel waits.
void keepWork(int pixel) {
  for (int i = 0; i < kindsOfWork(); ++i) workKept[pixel * kWorkCount + i] += workOf(i);
  forgetWork();
}

/// The sample of a pixel is complete.
void endWork(int pixel) {
  for (int i = 0; i < kindsOfWork(); ++i) {
    uint number = workKept[pixel * kWorkCount + i] + workOf(i);
    uint before = atomicAdd(workSums[2 * i], number);
    if (before + number < before) atomicAdd(workSums[2 * i + 1], 1u);
  }
  forgetWork();
}
