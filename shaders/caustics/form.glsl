// SPDX-License-Identifier: MIT
// The form of a path decides if it is found from the camera or from the lamp. In Heckbert's notation (E the camera, D a
// rough surface, S a delta lobe, L a lamp or the sun) light paths bring the light of E D S+ L and of E D (D|S)* D S+ L,
// where all of the S+ next to the lamp are casters. Camera paths leave out exactly these. Straight passages through
// thin walls may lie anywhere but next to the camera. A glossy caster is a D to the camera and to the lamp's path on
// its way, and an S where a run of casters begins.

/// Light paths begin at the sun of the sky or of the map, too.
const bool kSunPaths = kCaustics && (kSun || kMapSun) && kEnvironmentSampling;

/// A scattering next to the camera counts as a delta lobe if its direction is drawn with a larger pdf, in 1/sr, from
/// the camera's side. A lamp's path that meets so narrow a lobe by chance would leave a bright dot.
const float kNarrow = 5.0;

const int kPrefixNone = 0;     // camera path: another form; light path: no caster yet
const int kPrefixDiffuse = 1;  // the last surface was rough (from the lamp: one of them after the run of casters)
const int kPrefixCaustic = 2;  // casters since (from the lamp: since the start)
const int kPrefixSmooth = 3;   // delta lobes since, not all of casters (from the camera)
const int kPrefixGuided = 4;   // as kPrefixNone (from the camera); guiding drew the last direction of a rough surface

/// Returns true if no light path brings what a camera path meets from now on.
bool isGuidable(int prefix) { return prefix == kPrefixNone || prefix == kPrefixGuided; }

/// The prefix of a camera path after a scattering. straight: it went straight through a thin wall. caster: the lobe
/// makes caustics: it is a delta lobe or that of a glossy caster.
int cameraPrefix(int prefix, bool first, bool delta, bool straight, bool caster) {
  if (first) return delta ? kPrefixNone : kPrefixDiffuse;
  if (straight || isGuidable(prefix)) return prefix;
  if (caster && prefix != kPrefixSmooth) return kPrefixCaustic;
  return delta ? kPrefixSmooth : kPrefixDiffuse;
}

/// The prefix of a light path after a scattering.
int lightPrefix(int prefix, bool delta, bool straight) {
  if (straight) return prefix;
  if (prefix == kPrefixNone) return kPrefixCaustic;
  return delta ? prefix : kPrefixDiffuse;
}

/// Returns true if a light path may scatter so: at casters alone until a rough surface follows them.
bool lightScatters(int prefix, bool delta, bool straight, bool caster) {
  bool goesOn = delta ? straight || prefix == kPrefixDiffuse : prefix != kPrefixNone;
  return caster || goesOn;
}
