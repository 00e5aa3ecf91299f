// SPDX-License-Identifier: MIT
// The state of one path.

const int kPhaseBegin = 0;    // the path has a ray, which is to be traced
const int kPhasePass = 1;     // its ray continues behind the surface that it has met
const int kPhaseExtend = 2;   // its ray is being traced
const int kPhaseMeet = 3;     // its ray is traced
const int kPhaseConnect = 4;  // the shadow ray of a light sample is being traced
const int kPhaseEnd = 5;      // the path is complete
const int kPhaseCut = 6;      // the same, because it has scattered more than --bounces times
const int kPhaseNone = 7;     // there is no path: the pixel's next path has yet to begin (wavefront)

const float kTie = 9.5367431640625e-7;  // 2^-20: 16 roundings of a distance

/// The AOV is a number of a part of the scene. Such numbers have no mean: they are those of the pixel's middle.
const bool kIdAov = kAov == kAovObject || kAov == kAovMaterial;

/// The AOV is a part of the radiance. Paths are traced to their ends for it, as for the picture.
const bool kLightPart = kAov == kAovEmission || kAov == kAovDiffuse || kAov == kAovSpecular;
const bool kDrawsLight = kAov == kAovNone || kLightPart;

/// Light may be scattered between surfaces (media/).
const bool kMedia = (kScattering || kFog || kDensityGrid) && kDrawsLight;

/// Light may be lost between surfaces.
const bool kDims = (kAbsorption || kMedia) && kDrawsLight;

/// A shadow ray is dimmed once it is traced: only then is known what it has passed.
const bool kDimsLate = kMedia || (kDims && kPassing && !kLightPaths);

/// Light may go straight through smooth glass, and shadow rays with it.
const bool kThroughGlass = kThinGlass || kMatchedGlass;

/// Glass throws a clear shadow on the catcher: light goes through it there as if it were not bent.
const bool kClearShadows = kShadowCatcher && kTransmission && kDrawsLight;

/// The light samples that global illumination takes in a sample where its paths scatter for the time with this index,
/// from 0 on. All camera rays of a sample take one where they first scatter; the last alone goes on.
float lightSamplesAt(int scattering) { return kCameraRays > 1 && scattering == 0 ? float(kCameraRays) : 1.0; }

struct Path {
  int phase;
  int next;        // the phase that follows what the ray has met, and the shadow ray from there
  int lightSampleIndex;
  int bounce;      // scatterings so far, also one whose ray roulette ends
  int freeBounces;  // the part of `bounce` at smooth glass (kTransmission) and in media, which --bounces does not limit
  int straightBounces;  // the part of `bounce` that went straight through glass (kThroughGlass)
  int rays;        // of the sample, see tracedRays
  ivec2 pixel;     // the pixel in the film (kStoresReservoirs, kNeighbours), or the index of a light path's record
  Sampler sampler;
  float time;      // 0..1 while the shutter is open (kTimed)
  bool oneChannel; // dispersion has left one of red, green and blue (kDispersion)
  bool cameraRay;  // nothing but alpha has touched the path yet
  bool clear;      // nothing but alpha and light's way through glass has touched the path yet (kTransparentGlass)
  bool caught;     // the path has met the shadow catcher (kShadowCatcher)
  vec3 before;     // its radiance when it met the catcher behind glass (kTransparentGlass)
  bool throughGlass;  // the shadow ray passes glass that does not bend it (kThroughGlass)
  int prefix;         // kPrefix* of caustics/form.glsl (kCaustics)
  bool covered;    // a camera ray has hit a surface
  vec3 radiance;
  vec3 throughput;
  float etaScale;       // the product of squared indices by which refraction has scaled radiance down
  float pdf;            // pdf of the last scattering over solid angle; 0: a delta lobe or the camera
  uint normal;          // normal of the surface that the ray left, as light sampling used it (kLightTree)
  uint medium;          // the solids that the ray is inside of, or kPrimitiveNone (media/solids.glsl)
  vec3 origin;
  vec3 direction;
  uint cone;          // the width of the ray (kRayCones): packCone()
  float tie;          // part by which hits on fronts count as nearer: 0, kTie or -kTie (kCreases)
  vec3 shadowOrigin;
  vec3 shadowDirection;
  float shadowLimit;
  uint shadowMedium;  // the solids that the shadow ray is inside of, as `medium` (kDims)
  vec3 aovWeight;       // the share of the light still to come that belongs to the AOV (kLightPart)
  vec3 contribution;  // added if the shadow ray meets nothing; of a caught path's own ray, what glass has let pass
  int hitSlot;        // slot that the ray has hit, or -1
  float hitT;         // since the last scattering
  int hitInstance;  // instance that shows the slot, or -1
  vec2 hitWeights;  // barycentric (kWeights)
  Traversal traversal;
};

/// A path on which nothing has happened; its ray is still to be set.
Path newPath() {
  Path p;
  p.phase = kPhaseBegin;
  p.next = kPhaseEnd;
  p.lightSampleIndex = 0;
  p.bounce = 0;
  p.freeBounces = 0;
  p.straightBounces = 0;
  p.rays = 0;
  p.pixel = ivec2(0);
  p.time = 0.0;
  p.oneChannel = false;
  p.cameraRay = true;
  p.clear = true;
  p.caught = false;
  p.before = vec3(0.0);
  p.throughGlass = false;
  p.prefix = kPrefixNone;
  p.covered = false;
  p.radiance = vec3(0.0);
  p.throughput = vec3(1.0);
  p.etaScale = 1.0;
  p.pdf = 0.0;
  p.normal = kNoNormal;
  p.medium = kPrimitiveNone;
  p.cone = 0u;
  p.tie = 0.0;
  p.shadowOrigin = vec3(0.0);
  p.shadowDirection = vec3(0.0, 0.0, 1.0);
  p.shadowLimit = 0.0;
  p.shadowMedium = kPrimitiveNone;
  p.aovWeight = vec3(kAov == kAovDiffuse || kAov == kAovSpecular ? 0.0 : 1.0);
  p.contribution = vec3(0.0);
  p.hitSlot = -1;
  p.hitT = 0.0;
  p.hitInstance = -1;
  p.hitWeights = vec2(0.0);
  p.traversal = startTraversal(kFarAway, frame.leafCount);
  return p;
}

/// A word holds the rays of a sample, its camera rays before this one, and how many of these have met a surface.
const int kEarlierRay = 1 << 24;
const int kCoveredRay = 1 << 28;
int tracedRays(Path p) { return kCameraRays > 1 ? p.rays & (kEarlierRay - 1) : p.rays; }
int earlierRays(Path p) { return kCameraRays > 1 ? p.rays >> 24 & 15 : 0; }

/// Camera rays of the sample that have met a surface, with this one.
int coveredRays(Path p) { return (kCameraRays > 1 ? p.rays >> 28 : 0) + (p.covered ? 1 : 0); }

/// The path with the hit of its ray.
Path withHit(Path p, Traversal hit) {
  p.hitSlot = hit.slot;
  p.hitInstance = hit.hitInstance;
  p.hitT = hit.t;
  p.hitWeights = hit.weights;
  return p;
}
