// SPDX-License-Identifier: MIT

/// Luminance of linear sRGB (ITU-R BT.709). src/base/vectors.h computes the same.
float luminance(vec3 color) { return dot(color, vec3(float(0.2126), float(0.7152), float(0.0722))); }
