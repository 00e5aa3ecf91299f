// SPDX-License-Identifier: MIT
// Spatial reuse: a first program stores the light sample of each pixel (kStoresReservoirs), and a second one lets
// pixels take those of pixels near them (kNeighbours).

layout(binding = kReservoirTextures) uniform sampler2D reservoirSurfaces;
layout(binding = kReservoirTextures + 1u) uniform sampler2D reservoirLights;

Reservoir reservoirAt(ivec2 pixel) {
  return reservoirOf(texelFetch(reservoirSurfaces, pixel, 0), texelFetch(reservoirLights, pixel, 0));
}

/// The pixel of neighbour `index`: one in each of as many sectors of a disc that is turned by chance, 16 pixels away at
/// most.
ivec2 neighbourOf(ivec2 pixel, int index, vec2 uv) {
  float angle = 2.0 * kPi * (float(index) + uv.x) / float(kReuseNeighbours);
  float radius = 16.0 * sqrt(fract(uv.y + float(index) * 0.61803399));
  return pixel + ivec2(floor(radius * vec2(cos(angle), sin(angle)) + 0.5));
}

/// The light sample of the pixel's first surface: its own or one of its neighbours'. own: the reservoir that the first
/// program stored.
LightSample lightOfNeighbours(Path p, Reservoir own, vec3 point, uint normal) {
  vec2 uv = drawPair(p.sampler, kBounceDimensions + kReuseDimension);
  Reuse reuse = beginReuse(drawFloat(p.sampler, kBounceDimensions + kReuseDimension + 2u));
  float ownTarget = own.weight > 0.0 ? targetOf(own.light, own.surface) : 0.0;
  ivec2 size = textureSize(reservoirSurfaces, 0);
  for (int i = 0; i < int(kReuseNeighbours); ++i) {
    ivec2 there = neighbourOf(p.pixel, i, uv);
    Reservoir near = reservoirAt(clamp(there, ivec2(0), size - 1));
    near.known = near.known && there == clamp(there, ivec2(0), size - 1);
    reuse = addNeighbour(reuse, own, ownTarget, near);
  }
  return endReuse(reuse, own, ownTarget, point, normal);
}
