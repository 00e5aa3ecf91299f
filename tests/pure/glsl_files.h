// SPDX-License-Identifier: MIT
// The pure shader files in the order of trace.glsl. No include guard: glsl.h includes this once a precision.
// clang-format off
#include "random.glsl"
#include "sampling.glsl"
#include "luminance.glsl"
#include "pixel_filter.glsl"
#include "camera.glsl"
#include "intersect.glsl"
#include "stack.glsl"
#include "tree.glsl"
#include "tree/state.glsl"
#include "tree/ray.glsl"
#include "tree/leaf.glsl"
#include "traverse.glsl"
bool letsPass(Traversal, vec3, vec3) { return false; }
#include "perlin.glsl"
#include "fresnel.glsl"
#include "ggx.glsl"
#include "iridescence.glsl"
#include "bsdf.glsl"
#include "layers.glsl"
#include "phong.glsl"
// clang-format on
