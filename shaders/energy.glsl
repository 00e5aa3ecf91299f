// SPDX-License-Identifier: MIT
// Tables behind the materials (src/pack/energy_tables.cpp): the energy that single scattering loses between GGX facets,
// and the albedo of rough glass. Each has one row per cell with the values at its corners, over the roots of cosine and
// alpha. The first table continues with one row per cell of the average loss.

/// Returns a value of a table that begins `first` rows behind the energy table, or before it.
float energyTableAt(int first, float cosine, float alpha) {
  const int cells = int(kEnergyCells);
  float x = sqrt(clamp(cosine, 0.0, 1.0)) * float(cells);
  float y = sqrt(clamp(alpha, 0.0, 1.0)) * float(cells);
  int i = min(int(x), cells - 1);
  int j = min(int(y), cells - 1);
  vec4 corners = uintBitsToFloat(readMaterials(int(frame.energyRow) + first + j * cells + i));
  return mix(mix(corners.x, corners.y, x - float(i)), mix(corners.z, corners.w, x - float(i)), y - float(j));
}

/// 1 - albedo of a surface whose facets reflect everything, seen at `cosine`.
float ggxLoss(float cosine, float alpha) { return energyTableAt(0, cosine, alpha); }

/// The cosine-weighted mean of the loss over all directions.
float ggxAverageLoss(float alpha) {
  const int cells = int(kEnergyCells);
  float y = sqrt(clamp(alpha, 0.0, 1.0)) * float(cells);
  int j = min(int(y), cells - 1);
  vec4 ends = uintBitsToFloat(readMaterials(int(frame.energyRow) + cells * cells + j));
  return mix(ends.x, ends.y, y - float(j));
}

/// The albedo of rough solid glass under single scattering, seen at `cosine` from its front or from behind it. The
/// tables of all indices of refraction follow the other tables, two for each index.
float glassAlbedo(int table, bool front, float cosine, float alpha) {
  const int rows = int(kEnergyCells * kEnergyCells);
  int first = rows + int(kEnergyCells) + (2 * table + (front ? 0 : 1)) * rows;
  return energyTableAt(first, cosine, alpha);
}
