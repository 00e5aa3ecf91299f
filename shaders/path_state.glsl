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

/// The AOV is a part of the radiance: what one kind of lobe scatters first, or what is emitted. Paths are traced to
/// their ends for it, as for the picture.
const bool kDiffusePart = kAov == kAovDiffuse;
const bool kLobePart = kDiffusePart || kAov == kAovSpecular;
const bool kEmittedPart = kAov == kAovEmission;
const bool kLightPart = kLobePart || kEmittedPart;
const bool kDrawsLight = kAov == kAovNone || kLightPart;

/// The camera sees by angles.
const bool kRoundCamera = kPanorama || kFisheye;

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
/// from 0 on. All camera rays of a sample take one where they first scatter; the last alone continues.
float lightSamplesAt(int scattering) { return scattering == 0 ? float(kCameraRays) : 1.0; }

/// A path's own ray.
struct Ray {
  vec3 origin;
  vec3 direction;
  float pdf;    // of the last scattering over solid angle; 0: a delta lobe or the camera
  uint medium;  // the solids that the ray is inside of, or kPrimitiveNone (media/solids.glsl)
  uint normal;  // normal of the surface that the ray left, as light sampling used it (kLightTree)
  uint cone;    // the width of the ray (kRayCones): packCone()
  float tie;    // part by which hits on fronts count as nearer: 0, kTie or -kTie (kCreases)
};

/// What it has met.
struct Hit {
  int slot;      // leaf slot, or -1
  float t;       // since the last scattering
  int instance;  // instance that shows the slot, or -1
  vec2 weights;  // barycentric (kWeights)
};

/// A shadow ray, and the light that it adds if it meets nothing.
struct Connection {
  vec3 origin;
  vec3 direction;
  float limit;
  uint medium;        // the solids that it is inside of (kDims)
  bool throughGlass;  // it passes glass that does not bend it (kThroughGlass)
  vec3 light;         // of a caught path's own ray, what glass has let pass
};

/// What paths from the camera keep for parts of the picture.
struct Eye {
  vec3 aovWeight;  // the share of the light still to come that belongs to the AOV (kLightPart)
  bool clear;      // nothing but alpha and light's way through glass has touched the path yet (kTransparentGlass)
  bool caught;     // the path has met the shadow catcher (kShadowCatcher)
  vec3 before;     // its radiance when it met the catcher behind glass (kTransparentGlass)
};

struct Path {
  int phase;
  int next;             // the phase that follows what the ray has met, and the shadow ray from there
  int bounce;           // scatterings so far, also one whose ray roulette ends
  int freeBounces;      // those at smooth glass (kTransmission) and in media, which --bounces does not limit
  int straightBounces;  // those that went straight through glass (kThroughGlass)
  int rays;             // of the sample, see tracedRays
  ivec2 pixel;          // the pixel in the film (kStoresReservoirs, kNeighbours), or the index of a light path's record
  Sampler sampler;
  float time;       // 0..1 while the shutter is open (kTimed)
  bool oneChannel;  // dispersion has left one of red, green and blue (kDispersion)
  bool cameraRay;   // nothing but alpha has touched the path yet
  bool covered;     // a camera ray has hit a surface
  int prefix;       // kPrefix* of caustics/form.glsl (kCaustics)
  vec3 radiance;
  vec3 throughput;
  float etaScale;  // the product of squared indices by which refraction has scaled radiance down
  Ray ray;
  Hit hit;
  Connection connection;
  Eye eye;
  Traversal traversal;
};

/// A path on which nothing has happened.
Path newPath(vec3 origin, vec3 direction, Sampler sampler) {
  Path p;
  p.phase = kPhaseBegin;
  p.next = kPhaseEnd;
  p.bounce = 0;
  p.freeBounces = 0;
  p.straightBounces = 0;
  p.rays = 0;
  p.pixel = ivec2(0);
  p.sampler = sampler;
  p.time = 0.0;
  p.oneChannel = false;
  p.cameraRay = true;
  p.covered = false;
  p.prefix = kPrefixNone;
  p.radiance = vec3(0.0);
  p.throughput = vec3(1.0);
  p.etaScale = 1.0;
  p.ray = Ray(origin, direction, 0.0, kPrimitiveNone, kNoNormal, 0u, 0.0);
  p.hit = Hit(-1, 0.0, -1, vec2(0.0));
  p.connection = Connection(vec3(0.0), vec3(0.0, 0.0, 1.0), 0.0, kPrimitiveNone, false, vec3(0.0));
  p.eye = Eye(vec3(kLobePart ? 0.0 : 1.0), true, false, vec3(0.0));
  p.traversal = startTraversal(kFarAway, frame.leafCount);
  return p;
}

/// A word holds the rays of a sample, its camera rays before this one, and how many of these have met a surface.
const int kEarlierRay = 1 << 24;
const int kCoveredRay = 1 << 28;
int tracedRays(Path p) { return p.rays & (kEarlierRay - 1); }
int earlierRays(Path p) { return kCameraRays > 1 ? p.rays >> 24 & 15 : 0; }

/// Camera rays of the sample that have met a surface, with this one.
int coveredRays(Path p) { return (p.rays >> 28) + (p.covered ? 1 : 0); }

/// The path with the hit of its ray.
Path withHit(Path p, Traversal hit) {
  p.hit = Hit(hit.slot, hit.t, hit.hitInstance, hit.weights);
  return p;
}
