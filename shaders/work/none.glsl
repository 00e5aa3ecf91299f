// SPDX-License-Identifier: MIT
// The functions of work/count.glsl in programs that count nothing.
#include "work/kinds.glsl"

void forgetWork() {}
void beginWork(int pixel) {}
void keepWork(int pixel) {}
void endWork(int pixel) {}
