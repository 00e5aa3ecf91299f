// SPDX-License-Identifier: MIT
// Light that reaches a rough surface through casters comes from few directions. Light paths bring it where the camera
// sees the surface. A camera path that reaches the surface through glass or by a mirror (form.glsl) has to find these
// directions. Path guiding (Vorba et al. 2014) tells it where light paths came from. A cell of space has a few lobes:
// cones that are aimed at a point, the virtual image of a lamp, so that they fit wherever in the cell they begin
// (Ruppert et al., Robust Fitting of Parallax-Aware Mixtures for Path Guiding, 2020). src/pack/guiding.h fits them.

#include "caustics/guiding_cell.glsl"

/// A cone of directions.
struct GuidingLobe {
  vec3 focus;    // local space
  float spread;  // 1 minus the cosine of half its angle
  bool away;     // light comes from opposite the focus, on which it converges
  float upTo;    // the share of this lobe and of those before it; 0: there is no lobe
};

/// This part of a lobe's directions is drawn from a cone of kGuidingSkirts times its solid angle.
const float kGuidingSkirt = 0.15f;
const float kGuidingSkirts = 16.0f;

GuidingLobe guidingLobe(uint cell, int index) {
  uvec4 row = readLights(int(frame.punctualCount) * int(kLightRows) + int(cell) * kGuidingLobes + index);
  GuidingLobe lobe;
  lobe.focus = uintBitsToFloat(uvec3(row));
  lobe.spread = uintBitsToFloat(row.w & kGuidingSpreadMask);
  lobe.away = (row.w & kGuidingAway) != 0u;
  lobe.upTo = float(row.w & kGuidingShareMask) / float(kGuidingShareMask);
  return lobe;
}

/// Returns true if light paths have met surfaces in the cell.
bool hasGuiding(uint cell) { return guidingLobe(cell, 0).upTo > 0.0f; }

/// The axis of a lobe as seen from a point.
vec3 axisOf(GuidingLobe lobe, vec3 point) {
  vec3 towards = lobe.away ? point - lobe.focus : lobe.focus - point;
  float size = length(towards);
  return size > 0.0f ? towards / size : vec3(0.0f, 0.0f, 1.0f);
}

/// The pdf over solid angle with which guidingDirection() draws a direction.
float guidingPdf(vec3 point, uint cell, vec3 direction) {
  float sum = 0.0f;
  float before = 0.0f;
  for (int i = 0; i < kGuidingLobes; ++i) {
    GuidingLobe lobe = guidingLobe(cell, i);
    if (lobe.upTo <= before) break;
    vec3 apart = axisOf(lobe, point) - direction;
    float down = 0.5f * dot(apart, apart);
    float wide = min(2.0f, kGuidingSkirts * lobe.spread);
    float inner = down <= lobe.spread ? (1.0f - kGuidingSkirt) / lobe.spread : 0.0f;
    float outer = down <= wide ? kGuidingSkirt / wide : 0.0f;
    sum += (lobe.upTo - before) * (inner + outer);
    before = lobe.upTo;
  }
  return sum / (2.0f * kPi);
}

/// A direction from which light paths came to the surfaces of a cell that has lobes. choice picks the lobe, uv the
/// direction.
vec3 guidingDirection(vec3 point, uint cell, float choice, vec2 uv) {
  GuidingLobe lobe = guidingLobe(cell, 0);
  float before = 0.0f;
  for (int i = 1; i < kGuidingLobes; ++i) {
    if (choice < lobe.upTo) break;
    GuidingLobe next = guidingLobe(cell, i);
    if (next.upTo <= lobe.upTo) break;
    before = lobe.upTo;
    lobe = next;
  }
  bool skirt = choice - before < kGuidingSkirt * (lobe.upTo - before);
  float spread = skirt ? min(2.0f, kGuidingSkirts * lobe.spread) : lobe.spread;
  return normalize(toWorld(frameAround(axisOf(lobe, point)), sampleCone(spread, uv)));
}
