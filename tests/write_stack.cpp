// SPDX-License-Identifier: MIT
// Writes the shader's stack at its largest, which glsl.h compiles as stack.glsl.
#include <cstdio>

#include "shader/stack_text.h"

int main() { std::puts(fragtrace::stackText(12).c_str()); }
