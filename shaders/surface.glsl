// SPDX-License-Identifier: MIT
// From a hit (a leaf slot and a ray) to everything shading needs to know of the point.

struct Surface {
  vec3 position;
  float positionError;   // bound on its rounding error, local space
  vec3 geometricNormal;  // unit, on the side the ray comes from
  vec3 shadingNormal;    // unit, on the side the ray comes from; normal map not yet applied
  vec4 tangent;          // unit, w handedness; (0, 0, 0, 0) when there is none
  vec4 texcoords;        // TEXCOORD_0, TEXCOORD_1
  vec4 color;            // vertex colour
  uint material;
  bool front;            // the ray comes from the front (a solid's outside)
  bool emitter;          // a triangle that light sampling can choose
};

vec4 interpolate(vec4 a, vec4 b, vec4 c, vec2 weights) {
  return (1.0 - weights.x - weights.y) * a + weights.x * b + weights.y * c;
}

vec4 readNormalAt(int i) { return uintBitsToFloat(readNormals(i)); }
vec4 readTexcoordsAt(int i) { return uintBitsToFloat(readTexcoords(i)); }
vec4 readTangentAt(int i) { return uintBitsToFloat(readTangents(i)); }
vec4 readColorAt(int i) { return uintBitsToFloat(readColors(i)); }

/// v turned by a unit quaternion.
vec3 rotateBy(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

/// Row of the face in a leaf slot.
uvec4 faceRow(int slot, int row) { return kLiterals ? literalFace(slot, row) : readFaces(slot * int(kFaceRows) + row); }

/// Returns true if the word of a face (row 0) is that of a sphere.
bool isSphereFace(uint word) { return kSpheres && (!kTriangles || (word & kFaceSphere) != 0u); }

/// Row of the creases of a leaf slot; the frame knows how many leaves there are.
uvec4 insetRow(int slot) {
  return kLiterals ? literalInset(slot, 0) : readFaces(frame.leafCount * 2 * int(kFaceRows) + slot);
}

Surface sphereSurface(uvec4 face, uvec4 place, vec3 origin, vec3 direction, float t) {
  Surface s;
  vec3 center = uintBitsToFloat(place.xyz);
  float radius = uintBitsToFloat(place.w);
  vec3 normal = normalize(origin + t * direction - center);
  s.position = center + radius * normal;
  s.front = dot(origin - center, origin - center) > radius * radius && dot(normal, direction) < 0.0;
  s.geometricNormal = normal;
  s.shadingNormal = normal;
  vec3 axis = uintBitsToFloat(face.xyz);
  vec4 rotation = vec4(axis, sqrt(max(0.0, 1.0 - dot(axis, axis))));
  vec3 q = rotateBy(vec4(-rotation.xyz, rotation.w), normal);
  vec2 uv = vec2(atan(q.z, q.x) * (0.5 * kInversePi) + 0.5, acos(clamp(q.y, -1.0, 1.0)) * kInversePi);
  float ring = length(q.xz);
  // dP/du; the map is mirrored seen from outside, so that the bitangent, -dP/dv, has handedness -1.
  s.tangent = vec4(rotateBy(rotation, ring > 0.0 ? vec3(-q.z, 0.0, q.x) / ring : vec3(1.0, 0.0, 0.0)), -1.0);
  s.texcoords = vec4(uv, uv);
  s.color = vec4(1.0);
  return s;
}

/// A triangle on its way through a segment (kMoving).
struct MovingTriangle {
  Corners at;
  float part;  // 0..1 of the segment
};

/// The number of leaf slots in the segments before the one of a path's time.
int slotsBefore(float time) { return 2 * frame.segments.z * momentAt(time, frame.segments.x).segment; }

/// Converts a leaf slot of the first segment to the slot of the same triangle in the segment of a path's time.
int slotInSegment(int slot, float time) { return slot + slotsBefore(time); }

/// Converts a leaf slot to that of the same triangle in the first segment, by which lamps are listed.
int slotInFirst(int slot, float time) { return slot - slotsBefore(time); }

/// The triangle of a leaf slot at a time of the path.
MovingTriangle movingTriangle(int slot, float time) {
  Moment moment = momentAt(time, frame.segments.x);
  MovingTriangle m;
  m.at = cornersIn(loadMovingLeaf(slot / 2, moment.part), slot % 2 == 1);
  m.part = moment.part;
  return m;
}

/// A moving one has the point of its weights, which lies in its plane wherever that is.
Surface triangleSurface(uvec4 face, uvec4 place, vec3 origin, vec3 direction, float t, vec2 w, MovingTriangle moving) {
  Surface s;
  s.geometricNormal = uintBitsToFloat(face.xyz);
  s.position = pointOnPlane(origin, direction, t, s.geometricNormal, uintBitsToFloat(place.x));
  if (kMoving) {
    Corners at = moving.at;
    s.geometricNormal = vec3(planeThrough(at.v0, at.v1, at.v2));
    s.position = (1.0 - w.x - w.y) * at.v0 + w.x * at.v1 + w.y * at.v2;
  }
  s.front = dot(s.geometricNormal, direction) < 0.0;
  s.shadingNormal = s.geometricNormal;
  ivec3 v = ivec3(place.yzw);
  ivec3 to = v + frame.segments.w;
  if (kVertexNormals && (face.w & kFaceFlat) == 0u) {
    vec3 n = interpolate(readNormalAt(v.x), readNormalAt(v.y), readNormalAt(v.z), w).xyz;
    if (kMoving) {
      vec4 end = interpolate(readNormalAt(to.x), readNormalAt(to.y), readNormalAt(to.z), w);
      n = mix(n, vec3(end), moving.part);
    }
    // A normal that points backwards is reversed: the order of the vertices decides which side is the front.
    float squared = dot(n, n);
    float side = dot(n, s.geometricNormal) < 0.0 ? -1.0 : 1.0;
    s.shadingNormal = squared > 0.0 ? n * (side * inversesqrt(squared)) : s.geometricNormal;
  }
  s.texcoords = vec4(0.0);
  if (kTexcoords) s.texcoords = interpolate(readTexcoordsAt(v.x), readTexcoordsAt(v.y), readTexcoordsAt(v.z), w);
  s.tangent = vec4(0.0);
  if (kTangents) {
    vec4 first = readTangentAt(v.x);
    s.tangent = vec4(interpolate(first, readTangentAt(v.y), readTangentAt(v.z), w).xyz, first.w);
    if (kMoving) {
      vec4 end = interpolate(readTangentAt(to.x), readTangentAt(to.y), readTangentAt(to.z), w);
      s.tangent = vec4(mix(s.tangent.xyz, end.xyz, moving.part), first.w);
    }
  }
  s.color = vec4(1.0);
  if (kVertexColors) s.color = interpolate(readColorAt(v.x), readColorAt(v.y), readColorAt(v.z), w);
  return s;
}

vec3 unitOrZero(vec3 v) {
  float squared = dot(v, v);
  return squared > 0.0 ? v * inversesqrt(squared) : v;
}

/// A surface of an instance's mesh, taken into local space.
Surface inLocalSpace(Surface s, int instance) {
  InstanceSpace space = loadInstanceSpace(instance);
  InstanceReturn back = loadInstanceReturn(instance);
  s.position = timesRows(back.row0, back.row1, back.row2, s.position) + space.place;
  s.positionError = offsetOutOfMesh(back, s.positionError);
  s.geometricNormal = unitOrZero(normalOutOfMesh(space, s.geometricNormal));
  s.shadingNormal = unitOrZero(normalOutOfMesh(space, s.shadingNormal));
  s.tangent = vec4(unitOrZero(timesRows(back.row0, back.row1, back.row2, s.tangent.xyz)),
                   s.tangent.w * back.handedness);
  return s;
}

/// The point that a ray of a path with this time hits on the primitive of a leaf slot (shown by an instance, or -1), at
/// distance t and with barycentric weights.
Surface surfaceAt(int slot, int instance, vec3 origin, vec3 direction, float t, vec2 weights, float time) {
  countSurfaces(1u);
  if (kRayCones) coveredAreas = vec2(0.0);
  uvec4 face = faceRow(slot, 0);
  uvec4 place = faceRow(slot, 1);
  bool shown = kInstances && instance >= 0;
  if (shown) {
    MeshRay r = rayInMesh(instance, origin, direction);
    float longer = length(r.direction);
    origin = r.origin;
    direction = r.direction / longer;
    t = (t - r.start) * longer;
  }
  bool isSphere = isSphereFace(face.w);
  float error = uintBitsToFloat((face.w >> kFaceErrorShift) << kFloatErrorShift);
  MovingTriangle moving;
  if (kMoving) {
    moving = movingTriangle(slot, time);
    if (isSphere) place = floatBitsToUint(vec4(moving.at.v0, moving.at.v1.x));
  }
  Surface s;
  if (kTriangles) s = triangleSurface(face, place, origin, direction, t, weights, moving);
  if (kCreases && !isSphere) {
    uvec4 inset = insetRow(slot);
    float times = insetTimes(t, error);
    if (shown) {
      InstanceReturn back = loadInstanceReturn(instance);
      times *= offsetOutOfMesh(back, error) * back.stretchBack / error;
    }
    vec3 middle = uintBitsToFloat(inset.xyz);
    if (kMoving) middle = (moving.at.v0 + moving.at.v1 + moving.at.v2) / 3.0f;
    s.position = insetFromCreases(s.position, weights, middle, inset.w, times);
  }
  if (isSphere) s = sphereSurface(face, place, origin, direction, t);
  s.positionError = error;
  if (shown) s = inLocalSpace(s, instance);
  s.emitter = !isSphere;
  s.material = face.w & kFaceMaterialMask;
  if (!s.front) {
    s.geometricNormal = -s.geometricNormal;
    s.shadingNormal = -s.shadingNormal;
  }
  return s;
}

/// The normal of a texture, in tangent space. A blue below the middle would point into the surface. The specification
/// does not allow it; here it counts as the middle.
vec3 texturedNormal(uvec4 slot, float scale, vec4 texcoords) {
  vec3 texel = sampleTexture(slot, texcoords, false).rgb * 2.0 - 1.0;
  return vec3(texel.xy * scale, max(texel.z, 0.0));
}

/// A normal of tangent space in the space of the scene; the handedness of the frame is that of the front.
vec3 normalFromMap(Surface s, vec3 mapped) {
  vec3 normal = s.shadingNormal;
  vec3 tangent = s.tangent.xyz - normal * dot(normal, s.tangent.xyz);
  float squared = dot(tangent, tangent);
  if (squared <= 0.0) return normal;
  float side = s.front ? 1.0 : -1.0;
  tangent *= inversesqrt(squared);
  vec3 bitangent = cross(normal * side, tangent) * s.tangent.w;
  vec3 result = mapped.x * side * tangent + mapped.y * side * bitangent + mapped.z * normal;
  float length2 = dot(result, result);
  return length2 > 0.0 ? result * inversesqrt(length2) : normal;
}

/// The shading normal after normal texture and Perlin map.
vec3 mappedNormal(Surface s) {
  if (!kNormalMaps) return s.shadingNormal;
  vec3 mapped = vec3(0.0, 0.0, 1.0);
  uvec4 slot = slotNormals(s.material);
  if ((slot.z & kTexturePresent) != 0u) {
    mapped = texturedNormal(slot, materialFloats(s.material, kMaterialMaps).x, s.texcoords);
  }
  vec4 perlin = materialFloats(s.material, kMaterialPerlin);
  if (kPerlinNormals && perlin.y != 0.0) mapped = perlinNormal(s.texcoords.xy, perlin.x, perlin.y, int(perlin.z));
  return normalFromMap(s, mapped);
}

/// A frame round the normal whose first axis lies along a direction of tangent and bitangent; any where there are no
/// tangents.
Frame3 frameAlong(Surface s, vec3 normal, vec2 direction) {
  vec3 tangent = s.tangent.xyz - normal * dot(normal, s.tangent.xyz);
  float squared = dot(tangent, tangent);
  if (squared <= 0.0) return frameAround(normal);
  tangent *= inversesqrt(squared);
  vec3 bitangent = cross(s.front ? normal : -normal, tangent) * s.tangent.w;
  Frame3 f;
  f.tangent = direction.x * tangent + direction.y * bitangent;
  f.bitangent = cross(normal, f.tangent);
  f.normal = normal;
  return f;
}

/// A shading normal from which the direction towards the viewer is above the horizon: one that points away is turned
/// just far enough.
vec3 facingNormal(vec3 shadingNormal, vec3 wo) {
  float cosine = dot(shadingNormal, wo);
  const float least = 0.001;
  return cosine >= least ? shadingNormal : normalize(shadingNormal + (least - cosine) * wo);
}

/// A delta direction that a bent normal has sent to the wrong side of the surface, folded back onto the right one, so
/// that it is not lost.
vec3 ontoSide(vec3 direction, vec3 geometricNormal, bool below) {
  float height = dot(direction, geometricNormal);
  return (height < 0.0) == below ? direction : direction - 2.0 * height * geometricNormal;
}

/// A shading normal about which the mirror image of `wo` lies above the surface: where it would not, the image is
/// lifted to just above the horizon, and the normal is what mirrors one into the other. Both normals are unit and on
/// the side of `wo`.
vec3 reflectingNormal(vec3 shadingNormal, vec3 geometricNormal, vec3 wo) {
  vec3 image = mirrorDirection(wo, shadingNormal);
  float height = dot(image, geometricNormal);
  float least = min(0.01, 0.5 * dot(wo, geometricNormal));
  return height >= least ? shadingNormal : normalize(wo + normalize(image + (least - height) * geometricNormal));
}
