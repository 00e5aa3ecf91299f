// SPDX-License-Identifier: MIT
// The cells of guiding. Also read by src/pack/guiding.cpp.

/// The cell that a point lies in. Cells are cubes about the caster that is nearest in units of its radius. They are an
/// eighth of the radius wide, and twice as wide with each doubling of the distance. Their numbers are hashes: cells of
/// the same number share their lobes.
uint guidingCell(vec3 point) {
  int nearest = 0;
  float least = float(1e30);
  for (int i = 0; i < casterCount; ++i) {
    vec3 apart = point - vec3(casters[i]);
    float distance = dot(apart, apart) / (casters[i].w * casters[i].w);
    nearest = distance < least ? i : nearest;
    least = min(least, distance);
  }
  float doublings = clamp(ceil(0.5f * log2(least)), 0.0f, 60.0f);
  float scale = 8.0f * exp2(-doublings) / casters[nearest].w;
  vec3 number = scale * (point - vec3(casters[nearest]));
  ivec3 cell = ivec3(floor(clamp(number, vec3(-1e6f), vec3(1e6f))));
  uint key = mixBits(uint(nearest) * 64u + uint(doublings));
  return mixBits(uint(cell.x) * 0x9e3779b1u ^ uint(cell.y) * 0x85ebca6bu ^ uint(cell.z) * 0xc2b2ae35u ^ key) %
         kGuidingCells;
}
