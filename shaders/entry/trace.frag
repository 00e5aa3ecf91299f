// SPDX-License-Identifier: MIT
#include "trace.glsl"

void main() { tracePixel(ivec2(gl_FragCoord.xy)); }
