// SPDX-License-Identifier: MIT

/// Luminance of linear sRGB (ITU-R BT.709), as src/base/vectors.h has it.
float luminance(vec3 color) { return dot(color, vec3(float(0.2126), float(0.7152), float(0.0722))); }
