# SPDX-License-Identifier: MIT
# Copies a shader file for C++, with the value of each precise statement computed by a function of its own, in which the
# compiler fuses no product with a sum.
file(READ ${SOURCE} text)
string(REGEX REPLACE "precise ([a-z0-9]+ [a-zA-Z0-9]+) = ([^;]+);"
       "\\1 = [&]() __attribute__((noinline, optimize(\"fp-contract=off\"))) { return \\2; }();" text "${text}")
file(WRITE ${OUTPUT} "${text}")
