// SPDX-License-Identifier: MIT
// sRGB, IEC 61966-2-1.

vec3 encoded(vec3 linear) {
  return mix(1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, 12.92 * linear,
             lessThanEqual(linear, vec3(0.0031308)));
}
