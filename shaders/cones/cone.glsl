// SPDX-License-Identifier: MIT
// Ray cones (Akenine-Moeller et al., Improved Shader and Texture Level of Detail Using Ray Cones, JCGT 10(1), 2021): a
// path knows how wide its ray is, and textures answer with the mean over that width. Variants without cones do not have
// this file.

/// A cone has the width `x` at its ray's origin and gains `y` in a unit of length. The square of `y` is a solid angle.
/// Both are numbers of 16 bits.
uint packCone(vec2 cone) {
  uvec2 bits = floatBitsToUint(cone);
  return (bits.x & 0xffff0000u) | bits.y >> 16;
}

vec2 unpackCone(uint cone) { return uintBitsToFloat(uvec2(cone & 0xffff0000u, cone << 16)); }

/// The cone of a camera ray: it holds its pixel.
uint cameraCone(Path p) {
  float pixel = 2.0 * length(frame.cameraRight) / float(frame.pictureSize.x);
  if (kRoundCamera) return packCone(vec2(0.0, pixel));
  if (frame.orthographic != 0.0) return packCone(vec2(pixel, 0.0));
  // A pixel at the border is farther away and seen at an angle.
  float cosine = max(dot(p.ray.direction, forwardAt(p.time)), 0.0);
  return packCone(vec2(0.0, pixel * cosine * sqrt(cosine)));
}

/// The width of the path's ray where it has hit.
float coneWidth(Path p) {
  vec2 cone = unpackCone(p.ray.cone);
  return cone.x + cone.y * p.hit.t;
}

/// The cone of a ray that leaves the path's hit. pdf: by which the direction was drawn; 0: it follows from that of the
/// ray. A cone holds a 16th of the lobe that drew its ray: the cones of 16 samples hold all of it.
uint coneBehind(Path p, float bent, float pdf) {
  float width = coneWidth(p);
  float spread = unpackCone(p.ray.cone).y + bent * width;
  if (pdf > 0.0) spread = max(spread, sqrt(1.0 / 16.0 / pdf));
  return packCone(vec2(width, spread));
}

/// The vertices of the triangle that the path's ray has hit, in local space.
Corners cornersHit(Path p) {
  Corners c = kMoving ? movingTriangle(p.hit.slot, p.time).at
                      : cornersIn(loadLeaf(p.hit.slot / 2), p.hit.slot % 2 == 1);
  if (kInstances && p.hit.instance >= 0) {
    InstanceReturn back = loadInstanceReturn(p.hit.instance);
    c.v0 = timesRows(back.row0, back.row1, back.row2, c.v0);
    c.v1 = timesRows(back.row0, back.row1, back.row2, c.v1);
    c.v2 = timesRows(back.row0, back.row1, back.row2, c.v2);
  }
  return c;
}

bool hasHitSphere(Path p) { return kSpheres && isSphereFace(faceRow(p.hit.slot, 0).w); }

/// The radius of the sphere that the path's ray has hit.
float radiusHit(Path p) {
  if (kMoving) return movingTriangle(p.hit.slot, p.time).at.v1.x;
  return uintBitsToFloat(faceRow(p.hit.slot, 1).w);
}

/// The angle by which the normal turns in a unit of length, on average over the edges.
float curvatureHit(Path p) {
  if (hasHitSphere(p)) return 1.0 / radiusHit(p);
  if (!kVertexNormals || (faceRow(p.hit.slot, 0).w & kFaceFlat) != 0u) return 0.0;
  ivec3 v = ivec3(faceRow(p.hit.slot, 1).yzw);
  vec3 n0 = unitOrZero(readNormalAt(v.x).xyz);
  vec3 n1 = unitOrZero(readNormalAt(v.y).xyz);
  vec3 n2 = unitOrZero(readNormalAt(v.z).xyz);
  Corners at = cornersHit(p);
  vec3 turns = vec3(length(n1 - n0), length(n2 - n1), length(n0 - n2));
  vec3 edges = vec3(length(at.v1 - at.v0), length(at.v2 - at.v1), length(at.v0 - at.v2));
  return length(turns) / max(length(edges), 1e-30);
}

/// The cone of the ray that a surface scatters. A mirror turns a ray by twice the angle of its normal, glass by about
/// half of it.
uint scatteredCone(Path p, float pdf, bool transmitted) {
  return coneBehind(p, (transmitted ? 0.5 : 2.0) * curvatureHit(p), pdf);
}

/// The areas in both sets of texture coordinates of a unit of area of the surface that the path's ray has hit.
vec2 texcoordAreas(Path p) {
  if (hasHitSphere(p)) {
    float radius = radiusHit(p);
    return vec2(0.25 * kInversePi / (radius * radius));
  }
  if (!kTexcoords) return vec2(0.0);
  ivec3 v = ivec3(faceRow(p.hit.slot, 1).yzw);
  vec4 first = readTexcoordsAt(v.x);
  vec4 a = readTexcoordsAt(v.y) - first;
  vec4 b = readTexcoordsAt(v.z) - first;
  Corners at = cornersHit(p);
  float area = length(cross(at.v1 - at.v0, at.v2 - at.v0));
  return abs(a.xz * b.yw - a.yw * b.xz) / max(area, 1e-30);
}

/// Lets textures answer with the mean over the part of the surface that the path's cone covers. By chance it is
/// up to two levels of area larger, so that their mean is that of both levels between which it lies.
void coverSurface(Path p, Surface s) {
  float width = coneWidth(p);
  float cosine = max(abs(dot(s.geometricNormal, p.ray.direction)), 1e-3);
  float chance = pathRandom(p, kLevelDimension);
  coveredAreas = texcoordAreas(p) * (width * width / cosine * exp2(2.0 * chance));
}
