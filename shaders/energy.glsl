// SPDX-License-Identifier: MIT
// The energy that single scattering loses between GGX facets, from the table behind the materials (src/pack/ggx_energy.cpp): one row a cell with
// the loss at its corners, then one row a cell of the average loss.

/// 1 - albedo of a surface whose facets reflect all, seen at `cosine`.
float ggxLoss(float cosine, float alpha) {
  if (!kCompensation) return 0.0;
  const int cells = int(kEnergyCells);
  float x = sqrt(clamp(cosine, 0.0, 1.0)) * float(cells);
  float y = sqrt(clamp(alpha, 0.0, 1.0)) * float(cells);
  int i = min(int(x), cells - 1);
  int j = min(int(y), cells - 1);
  vec4 corners = uintBitsToFloat(readMaterials(int(frame.lightChoice.z) + j * cells + i));
  return mix(mix(corners.x, corners.y, x - float(i)), mix(corners.z, corners.w, x - float(i)), y - float(j));
}

/// Its cosine-weighted mean over all directions.
float ggxAverageLoss(float alpha) {
  if (!kCompensation) return 0.0;
  const int cells = int(kEnergyCells);
  float y = sqrt(clamp(alpha, 0.0, 1.0)) * float(cells);
  int j = min(int(y), cells - 1);
  vec4 ends = uintBitsToFloat(readMaterials(int(frame.lightChoice.z) + cells * cells + j));
  return mix(ends.x, ends.y, y - float(j));
}
