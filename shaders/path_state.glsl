// SPDX-License-Identifier: MIT
// The state of one camera path, and how it is kept from one draw to the next.

const int kPhaseExtend = 0;  // the path's ray is being traced
const int kPhaseShade = 1;   // it has hit something; light slot `lightSlot` is next
const int kPhaseShadow = 2;  // the shadow ray of that slot is being traced
const int kPhaseEnd = 3;     // the sample is complete
const int kPhaseCut = 4;     // so it is, because the path has scattered as often as it may

const float kTie = 9.5367431640625e-7;  // 2^-20: 16 roundings of a distance

struct Path {
  int phase;
  int after;       // the phase that follows once the shadow ray is settled
  int lightSlot;
  int bounce;      // scatterings so far
  int clear;       // of these, at smooth glass (kTransmission)
  int crossings;   // meetings with surfaces, where there is alpha; see nextCrossing
  Sampler numbers;
  bool oneChannel; // dispersion has left one of red, green and blue (kDispersion)
  bool cameraRay;  // nothing but alpha has touched the path yet
  float alpha;     // 1 once a camera ray has hit a surface, else 0
  vec3 radiance;
  vec3 throughput;
  float compression;  // undoes the radiance compression inside glass
  float density;        // of the last scattering over solid angle; 0: a single direction or the camera
  uint medium;          // material of the solid the ray is inside of, or kPrimitiveNone
  vec3 origin;
  vec3 direction;
  float tie;          // of the traversal that the ray begins (kCreases)
  vec3 shadowOrigin;
  vec3 shadowDirection;
  float shadowLimit;
  vec3 contribution;  // added if the shadow ray meets nothing
  int hitSlot;        // what the ray has hit, or -1
  float hitT;         // since the last scattering
  int hitInstance;  // that shows it, or -1
  vec2 hitWeights;  // barycentric (kWeights)
  Traversal traversal;
};

const int kPathRows = int(kInstances ? kTwoLevelPathStateRows : kPathStateRows);

layout(std430, binding = kPathStatesBinding) restrict buffer PathStatesBlock { uvec4 pathStates[]; };

void savePath(Path p, int index) {
  int r = index * kPathRows;
  uint flags = (p.cameraRay ? 1u : 0u) | (p.oneChannel ? 2u : 0u) | (p.alpha > 0.0 ? 4u : 0u);
  pathStates[r] = uvec4(uint(p.phase) | uint(p.after) << 4 | flags << 8, uint(p.lightSlot), uint(p.bounce), uint(p.crossings));
  pathStates[r + 1] = uvec4(floatBitsToUint(p.radiance), uint(p.clear));
  pathStates[r + 2] = uvec4(floatBitsToUint(p.throughput), floatBitsToUint(p.compression));
  pathStates[r + 3] = uvec4(floatBitsToUint(p.origin), floatBitsToUint(p.density));
  pathStates[r + 4] = uvec4(floatBitsToUint(p.direction), floatBitsToUint(p.traversal.past));
  pathStates[r + 5] = uvec4(floatBitsToUint(p.shadowOrigin), floatBitsToUint(p.shadowLimit));
  pathStates[r + 6] = uvec4(floatBitsToUint(p.shadowDirection), p.medium);
  pathStates[r + 7] = uvec4(floatBitsToUint(p.contribution), uint(p.hitSlot));
  pathStates[r + 8] = uvec4(floatBitsToUint(p.hitT), p.numbers.key, p.numbers.index, floatBitsToUint(p.tie));
  Traversal t = p.traversal;
  pathStates[r + 9] = uvec4(uint(t.node), floatBitsToUint(t.t), uint(t.slot), uint(kHeatmap ? t.visits : t.pastSlot));
  pathStates[r + 10] = uvec4(floatBitsToUint(p.hitWeights), floatBitsToUint(t.weights));
  if (kIterative || kLiterals) return;
  Stack s = t.stack;
  pathStates[r + 11] = uvec4(ivec4(s.s0, s.s1, s.s2, s.s3));
  pathStates[r + 12] = uvec4(ivec4(s.s4, s.s5, s.s6, s.s7));
  if (kStackSize > 8) pathStates[r + 13] = uvec4(ivec4(s.s8, s.s9, s.s10, s.s11));
  if (kStackSize > 12) pathStates[r + 14] = uvec4(ivec4(s.s12, s.s13, s.s14, s.s15));
  if (kStackSize > 16) {
    pathStates[r + 15] = uvec4(ivec4(s.s16, s.s17, s.s18, s.s19));
    pathStates[r + 16] = uvec4(ivec4(s.s20, s.s21, s.s22, s.s23));
  }
  if (kStackSize > 24) {
    pathStates[r + 17] = uvec4(ivec4(s.s24, s.s25, s.s26, s.s27));
    pathStates[r + 18] = uvec4(ivec4(s.s28, s.s29, s.s30, s.s31));
  }
  if (kInstances) pathStates[r + 19] = uvec4(ivec4(p.hitInstance, t.instance, t.hitInstance, 0));
  if (kStackSize > 32) {
    pathStates[r + 20] = uvec4(ivec4(s.s32, s.s33, s.s34, s.s35));
    pathStates[r + 21] = uvec4(ivec4(s.s36, s.s37, s.s38, s.s39));
    pathStates[r + 22] = uvec4(ivec4(s.s40, s.s41, s.s42, s.s43));
    pathStates[r + 23] = uvec4(ivec4(s.s44, s.s45, s.s46, s.s47));
  }
}

Stack loadStack(int r) {
  Stack s = emptyStack();
  ivec4 a = ivec4(pathStates[r]);
  s.s0 = a.x; s.s1 = a.y; s.s2 = a.z; s.s3 = a.w;
  a = ivec4(pathStates[r + 1]);
  s.s4 = a.x; s.s5 = a.y; s.s6 = a.z; s.s7 = a.w;
  if (kStackSize > 8) {
    a = ivec4(pathStates[r + 2]);
    s.s8 = a.x; s.s9 = a.y; s.s10 = a.z; s.s11 = a.w;
  }
  if (kStackSize > 12) {
    a = ivec4(pathStates[r + 3]);
    s.s12 = a.x; s.s13 = a.y; s.s14 = a.z; s.s15 = a.w;
  }
  if (kStackSize > 16) {
    a = ivec4(pathStates[r + 4]);
    s.s16 = a.x; s.s17 = a.y; s.s18 = a.z; s.s19 = a.w;
    a = ivec4(pathStates[r + 5]);
    s.s20 = a.x; s.s21 = a.y; s.s22 = a.z; s.s23 = a.w;
  }
  if (kStackSize > 24) {
    a = ivec4(pathStates[r + 6]);
    s.s24 = a.x; s.s25 = a.y; s.s26 = a.z; s.s27 = a.w;
    a = ivec4(pathStates[r + 7]);
    s.s28 = a.x; s.s29 = a.y; s.s30 = a.z; s.s31 = a.w;
  }
  if (kStackSize > 32) {
    a = ivec4(pathStates[r + 9]);
    s.s32 = a.x; s.s33 = a.y; s.s34 = a.z; s.s35 = a.w;
    a = ivec4(pathStates[r + 10]);
    s.s36 = a.x; s.s37 = a.y; s.s38 = a.z; s.s39 = a.w;
    a = ivec4(pathStates[r + 11]);
    s.s40 = a.x; s.s41 = a.y; s.s42 = a.z; s.s43 = a.w;
    a = ivec4(pathStates[r + 12]);
    s.s44 = a.x; s.s45 = a.y; s.s46 = a.z; s.s47 = a.w;
  }
  return s;
}

Path loadPath(int index) {
  int r = index * kPathRows;
  Path p;
  uvec4 a = pathStates[r];
  uint flags = a.x >> 8;
  p.phase = int(a.x & 0xfu);
  p.after = int(a.x >> 4 & 0xfu);
  p.cameraRay = (flags & 1u) != 0u;
  p.oneChannel = (flags & 2u) != 0u;
  p.alpha = (flags & 4u) != 0u ? 1.0 : 0.0;
  p.lightSlot = int(a.y);
  p.bounce = int(a.z);
  p.crossings = int(a.w);
  a = pathStates[r + 1];
  p.radiance = uintBitsToFloat(a.xyz);
  p.clear = int(a.w);
  vec4 f = uintBitsToFloat(pathStates[r + 2]);
  p.throughput = f.xyz;
  p.compression = f.w;
  f = uintBitsToFloat(pathStates[r + 3]);
  p.origin = f.xyz;
  p.density = f.w;
  f = uintBitsToFloat(pathStates[r + 4]);
  p.direction = f.xyz;
  p.traversal.past = f.w;
  f = uintBitsToFloat(pathStates[r + 5]);
  p.shadowOrigin = f.xyz;
  p.shadowLimit = f.w;
  a = pathStates[r + 6];
  p.shadowDirection = uintBitsToFloat(a.xyz);
  p.medium = a.w;
  a = pathStates[r + 7];
  p.contribution = uintBitsToFloat(a.xyz);
  p.hitSlot = int(a.w);
  a = pathStates[r + 8];
  p.hitT = uintBitsToFloat(a.x);
  p.numbers.key = a.y;
  p.numbers.index = a.z;
  p.numbers.reversed = reverseBits(a.z);
  p.tie = uintBitsToFloat(a.w);
  p.traversal.tie = p.phase == kPhaseExtend ? p.tie : 0.0;
  a = pathStates[r + 9];
  p.traversal.node = int(a.x);
  p.traversal.t = uintBitsToFloat(a.y);
  p.traversal.slot = int(a.z);
  p.traversal.visits = int(a.w);
  p.traversal.pastSlot = int(a.w);
  f = uintBitsToFloat(pathStates[r + 10]);
  p.hitWeights = f.xy;
  p.traversal.weights = f.zw;
  p.hitInstance = -1;
  p.traversal.instance = -1;
  p.traversal.hitInstance = -1;
  if (kInstances) {
    ivec4 shown = ivec4(pathStates[r + 19]);
    p.hitInstance = shown.x;
    p.traversal.instance = shown.y;
    p.traversal.hitInstance = shown.z;
  }
  p.traversal.steps = 0;
  p.traversal.stack = emptyStack();
  if (!kIterative && !kLiterals) p.traversal.stack = loadStack(r + 11);
  return p;
}
