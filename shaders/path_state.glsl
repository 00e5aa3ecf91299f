// SPDX-License-Identifier: MIT
// The state of one camera path, and how it is kept from one draw to the next.

const int kPhaseExtend = 0;  // the path's ray is being traced
const int kPhaseShade = 1;   // it has hit something; light slot `lightSlot` is next
const int kPhaseShadow = 2;  // the shadow ray of that slot is being traced
const int kPhaseEnd = 3;     // the sample is complete
const int kPhaseCut = 4;     // so it is, because the path has scattered as often as it may

const int kPhasePass = 6;    // of `after` alone: the ray goes on behind the thin wall that it has met

const float kTie = 9.5367431640625e-7;  // 2^-20: 16 roundings of a distance

// Of camera paths whose light light paths bring (shaders/caustics/):
const int kChainNone = 0;
const int kChainRough = 1;   // scattered by a rough surface first, and only straight through thin walls since
const int kChainSingle = 2;  // and by casters of caustics since, each a single direction

struct Path {
  int phase;
  int after;       // the phase that follows once the shadow ray is settled
  int lightSlot;
  int bounce;      // scatterings so far
  int clear;       // of these, at smooth glass (kTransmission)
  int walls;       // of these, straight through thin walls (kThinGlass)
  int crossings;   // meetings with surfaces, where there is alpha; see nextCrossing
  ivec2 pixel;     // of the film (kLightRecords, kNeighbours)
  Sampler numbers;
  bool oneChannel; // dispersion has left one of red, green and blue (kDispersion)
  bool cameraRay;  // nothing but alpha has touched the path yet
  bool caught;     // it has met the shadow catcher (kShadowCatcher)
  bool throughWalls;  // the shadow ray passes thin walls (kThinGlass)
  int chain;          // how far it is one whose end light paths find, kChain* (kCaustics)
  bool clearFirst;    // of a light path: it has met smooth glass first (kLightPaths)
  float alpha;     // 1 once a camera ray has hit a surface, else 0
  vec3 radiance;
  vec3 throughput;
  float compression;  // undoes the radiance compression inside glass
  float density;        // of the last scattering over solid angle; 0: a single direction or the camera
  uint normal;          // of the surface that it left, as light sampling took it (kLightTree)
  uint medium;          // material of the solid the ray is inside of, or kPrimitiveNone
  vec3 origin;
  vec3 direction;
  float tie;          // of the traversal that the ray begins (kCreases)
  vec3 shadowOrigin;
  vec3 shadowDirection;
  float shadowLimit;
  // of the light that is still to come, how much belongs to the part that is drawn (kLightPart); of a light path, where
  // in the picture the camera sees its end (kLightPaths)
  vec3 part;
  vec3 contribution;  // added if the shadow ray meets nothing
  int hitSlot;        // what the ray has hit, or -1
  float hitT;         // since the last scattering
  int hitInstance;  // that shows it, or -1
  vec2 hitWeights;  // barycentric (kWeights)
  Traversal traversal;
};

/// What is drawn is a part of the radiance.
const bool kLightPart = kFeature == kFeatureEmission || kFeature == kFeatureDiffuse || kFeature == kFeatureSpecular;

/// Path.part is kept from draw to draw.
const bool kPartRow = kLightPart || kLightPaths;

const int kPathRows = int(kInstances ? kTwoLevelPathStateRows : kPathStateRows) + (kPartRow ? 1 : 0);
const int kInstanceRow = 11;  // in scenes of instances
const int kStackRow = kInstances ? 12 : 11;

layout(std430, binding = kPathStatesBinding) restrict buffer PathStatesBlock { uvec4 pathStates[]; };

void saveStack(Stack s, int r) {
  pathStates[r] = uvec4(s.e0);
  pathStates[r + 1] = uvec4(s.e1);
  if (kStackSize > 8) pathStates[r + 2] = uvec4(s.e2);
  if (kStackSize > 12) pathStates[r + 3] = uvec4(s.e3);
  if (kStackSize > 16) pathStates[r + 4] = uvec4(s.e4);
  if (kStackSize > 20) pathStates[r + 5] = uvec4(s.e5);
  if (kStackSize > 24) pathStates[r + 6] = uvec4(s.e6);
  if (kStackSize > 28) pathStates[r + 7] = uvec4(s.e7);
  if (kStackSize > 32) pathStates[r + 8] = uvec4(s.e8);
  if (kStackSize > 36) pathStates[r + 9] = uvec4(s.e9);
  if (kStackSize > 40) pathStates[r + 10] = uvec4(s.e10);
  if (kStackSize > 44) pathStates[r + 11] = uvec4(s.e11);
}

Stack loadStack(int r) {
  Stack s = emptyStack();
  s.e0 = ivec4(pathStates[r]);
  s.e1 = ivec4(pathStates[r + 1]);
  if (kStackSize > 8) s.e2 = ivec4(pathStates[r + 2]);
  if (kStackSize > 12) s.e3 = ivec4(pathStates[r + 3]);
  if (kStackSize > 16) s.e4 = ivec4(pathStates[r + 4]);
  if (kStackSize > 20) s.e5 = ivec4(pathStates[r + 5]);
  if (kStackSize > 24) s.e6 = ivec4(pathStates[r + 6]);
  if (kStackSize > 28) s.e7 = ivec4(pathStates[r + 7]);
  if (kStackSize > 32) s.e8 = ivec4(pathStates[r + 8]);
  if (kStackSize > 36) s.e9 = ivec4(pathStates[r + 9]);
  if (kStackSize > 40) s.e10 = ivec4(pathStates[r + 10]);
  if (kStackSize > 44) s.e11 = ivec4(pathStates[r + 11]);
  return s;
}

/// Both counts in a word: roulette ends a path long before either is 65,535.
uint clearOf(Path p) { return uint(p.clear) | (kThinGlass ? uint(p.walls) << 16 : 0u); }

Path withClear(Path p, uint word) {
  p.clear = int(kThinGlass ? word & 0xffffu : word);
  p.walls = int(kThinGlass ? word >> 16 : 0u);
  return p;
}

void savePath(Path p, int index) {
  int r = index * kPathRows;
  uint flags = (p.cameraRay ? 1u : 0u) | (p.oneChannel ? 2u : 0u) | (p.alpha > 0.0 ? 4u : 0u) | (p.caught ? 8u : 0u) |
               (p.throughWalls ? 16u : 0u) | (kCaustics ? uint(p.chain) << 5 : 0u) |
               (kLightPaths && p.clearFirst ? 128u : 0u);
  uint slot = uint(p.lightSlot) | (kLightTree ? p.normal << 8 : 0u);
  pathStates[r] = uvec4(uint(p.phase) | uint(p.after) << 4 | flags << 8, slot, uint(p.bounce), uint(p.crossings));
  pathStates[r + 1] = uvec4(floatBitsToUint(p.radiance), clearOf(p));
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
  if (kInstances) pathStates[r + kInstanceRow] = uvec4(ivec4(p.hitInstance, t.instance, t.hitInstance, 0));
  if (!kIterative && !kLiterals) saveStack(t.stack, r + kStackRow);
  if (kPartRow) pathStates[r + kPathRows - 1] = uvec4(floatBitsToUint(p.part), 0u);
}

/// Without `past` and `tie`, which lie with the path.
Traversal loadTraversal(int r) {
  Traversal t;
  uvec4 a = pathStates[r + 9];
  t.node = int(a.x);
  t.t = uintBitsToFloat(a.y);
  t.slot = int(a.z);
  t.visits = int(a.w);
  t.pastSlot = int(a.w);
  t.weights = uintBitsToFloat(pathStates[r + 10].zw);
  t.instance = -1;
  t.hitInstance = -1;
  if (kInstances) {
    ivec4 shown = ivec4(pathStates[r + kInstanceRow]);
    t.instance = shown.y;
    t.hitInstance = shown.z;
  }
  t.steps = 0;
  t.both = false;
  t.stack = emptyStack();
  if (!kIterative && !kLiterals) t.stack = loadStack(r + kStackRow);
  return t;
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
  p.caught = (flags & 8u) != 0u;
  p.throughWalls = (flags & 16u) != 0u;
  p.chain = int(kCaustics ? flags >> 5 & 3u : 0u);
  p.clearFirst = kLightPaths && (flags & 128u) != 0u;
  p.lightSlot = int(kLightTree ? a.y & 0xffu : a.y);
  p.normal = kLightTree ? a.y >> 8 : kNoNormal;
  p.bounce = int(a.z);
  p.crossings = int(a.w);
  a = pathStates[r + 1];
  p.radiance = uintBitsToFloat(a.xyz);
  p = withClear(p, a.w);
  vec4 f = uintBitsToFloat(pathStates[r + 2]);
  p.throughput = f.xyz;
  p.compression = f.w;
  f = uintBitsToFloat(pathStates[r + 3]);
  p.origin = f.xyz;
  p.density = f.w;
  f = uintBitsToFloat(pathStates[r + 4]);
  p.direction = f.xyz;
  float past = f.w;
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
  p.pixel = ivec2(0);
  p.numbers.key = a.y;
  p.numbers.index = a.z;
  p.numbers.reversed = reverseBits(a.z);
  p.tie = uintBitsToFloat(a.w);
  p.hitWeights = uintBitsToFloat(pathStates[r + 10].xy);
  p.hitInstance = kInstances ? int(pathStates[r + kInstanceRow].x) : -1;
  p.part = kPartRow ? uintBitsToFloat(pathStates[r + kPathRows - 1].xyz) : vec3(1.0);
  p.traversal = loadTraversal(r);
  p.traversal.past = past;
  p.traversal.both = kLightPaths && p.phase == kPhaseExtend;
  p.traversal.tie = p.phase == kPhaseExtend ? p.tie : 0.0;
  return p;
}
