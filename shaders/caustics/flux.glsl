// SPDX-License-Identifier: MIT
// Light paths carry flux, which shading normals weight differently from radiance (Veach, Robust Monte Carlo Methods
// for Light Transport Simulation, 1997, section 5.3).

/// Smaller cosines count as this. Their quotients are rounding errors, of any size, and hardly any flux is so flat.
const float kLeastCosine = 1e-4f;

/// The factor of a scattering of flux: |wi.Ns| |wo.Ng| / (|wi.Ng| |wo.Ns|) with wi towards the lamp and wo towards the
/// camera. Both arguments hold the cosines to Ng, then to Ns. It is 1 where Ns is Ng.
float fluxFactor(vec2 wi, vec2 wo) {
  vec2 arriving = max(abs(wi), vec2(kLeastCosine));
  vec2 leaving = max(abs(wo), vec2(kLeastCosine));
  return (arriving.y / arriving.x) * (leaving.x / leaving.y);
}
