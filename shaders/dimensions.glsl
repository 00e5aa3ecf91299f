// SPDX-License-Identifier: MIT
// The random numbers of a path: which dimension of its sampler each decision has.

/// Paths scatter, so that --bounces can end them.
const bool kScatters = kGi || kReflections || kRefraction;

/// The direction of the camera of a path with this time.
vec3 forwardAt(float time) {
  return kMovingCamera ? turnedWith(cameraAt(time), frame.cameraForward) : frame.cameraForward;
}

/// Paths have a time: the camera or surfaces move while the shutter is open.
const bool kTimed = kMovingCamera || kMoving;

const float kAboveAll = 1.0e6;  // local space
const uint kCameraDimensions = 0u;
const uint kChannelDimension = 2u;  // one number per path
const uint kLensDimensions = 4u;
const uint kBounceDimensions = 16u;  // a bounce uses 16 dimensions from 16 (bounce + 1) on
const uint kLobeDimension = 0u;
const uint kDirectionDimension = 1u;
const uint kRouletteDimension = 3u;
const uint kLightDimension = 4u;  // the light's dimensions are 4 to 7
const uint kReuseDimension = 8u;  // these are 8 to 10, at the first hit alone
const uint kGuidingDimension = 8u;  // behind the first hit
const uint kGlassDimension = 12u;
const uint kFlightDimension = 13u;
const uint kLevelDimension = 14u;
const uint kFlightDimensions = 0x80000000u;  // hashed; 4,096 per bounce
const uint kShadowFlights = 0x40000000u;      // shadow rays add this to kFlightDimensions

const int kLatestRoulette = 1000;  // the scattering from which on roulette decides at smooth glass in any stage

/// Dimensions of light paths; their bounces have the dimensions of camera paths.
const uint kAimDimensions = 0u;     // these are 0 and 1
const uint kEmitterPointDimensions = 4u;  // these are 4 and 5
const uint kEmitterDimension = 6u;
const uint kCasterDimension = 7u;
const uint kSplatDimension = 8u;    // dimension within a bounce
const uint kSplatLensDimensions = 9u;  // dimensions 9 and 10 within a bounce
const uint kPassedOnDimensions = 0x40000000u;  // hashed; one per single-sided surface
const uint kSurvivalDimension = 11u;   // dimension within a bounce

TreeFrame treeFrame() { return TreeFrame(frame.treeRounding, frame.leafCount); }

float pathRandom(Path p, uint offset) {
  return drawFloat(p.sampler, kBounceDimensions * uint(p.bounce + 1) + offset);
}

/// Red (0), green or blue: the one that is left once dispersion parts them.
int pathChannel(Path p) { return min(int(3.0 * drawFloat(p.sampler, kChannelDimension)), 2); }

/// The index of refraction of a solid for the channel of the path (KHR_materials_dispersion: they are apart by (n - 1)
/// / 40 x 20 / Abbe number).
float dispersedIor(Path p, uint material) {
  float ior = materialFloats(material, kMaterialSurface).z;
  if (!kDispersion || !p.oneChannel) return ior;
  float halfSpread = (ior - 1.0) * 0.025 * materialFloats(material, kMaterialClearcoat).w;
  return max(1.0, ior + float(pathChannel(p) - 1) * halfSpread);
}
