// SPDX-License-Identifier: MIT
#include "rays.glsl"

void main() { traceRay(ivec2(gl_FragCoord.xy), true); }
