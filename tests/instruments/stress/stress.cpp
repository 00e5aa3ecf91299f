// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/stress.h"

#include "tests/instruments/stress/rows.h"

namespace fragtrace {

std::vector<StressRow> stressRows() {
  std::vector<StressRow> rows;
  for (const RayAttack& attack : rayAttacks()) {
    rows.push_back({std::string("rays ") + attack.name, attack.sentence, attack.limit, true,
                    [&attack](const StressSetting& setting) { return attackByRays(setting, attack); }});
  }
  rows.push_back({"shell", "a black shell of 80,000 triangles, from inside", 0.0, true, lookOutOfBlackShell});
  rows.push_back(
      {"shell far", "the same at (148376, 1234, -223423), not recentred", 0.0, true, lookOutOfFarShell});
  rows.push_back(
      {"shell white", "paths inside a white shell in a bright world", 0.0, true, scatterInWhiteShell});
  rows.push_back({"shell shared", "paths inside spiky white shells that share their mesh", 0.0, true,
                  scatterInSharedShells});
  rows.push_back({"strips", "paths inside white wedges cut into slivers", 0.0, true, scatterInStrips});
  rows.push_back({"boxes", "paths inside white boxes, right-angled or nearly so", 0.0, true, scatterInBoxes});
  rows.push_back({"skins", "paths inside white boxes with see-through skins on their walls", 0.0, true,
                  scatterInSkinnedBoxes});
  // These leak (docs/design/ray-origins.md). The limits are four times what was measured, or 1 of a million.
  rows.push_back({"leaks uneven", "paths inside spiky white shells, unevenly scaled instances of one mesh",
                  1e-6, true, scatterInUnevenShells});
  rows.push_back({"leaks cut", "paths inside white prisms that are cut at random into triangles of all sizes",
                  1e-6, true, scatterInCutMeshes});
  rows.push_back(
      {"leaks long", "the same in prisms 10,000 times as long as wide", 5e-3, true, scatterInLongPrisms});
  rows.push_back({"leaks crossed", "paths inside white boxes whose walls are crossed by sheets", 3e-6, true,
                  scatterInCrossedBoxes});
  rows.push_back({"bad normals", "missing, backwards and tilted normals in a white furnace", 0.0, false,
                  shadeBadNormals});
  // Mirror directions along the surface: a few paths do not come back with all of their light
  // (docs/measurements/numerics.md).
  rows.push_back({"bad tangents", "paths by a steep map over tangents that do not fit, in a white furnace",
                  1e-4, false, shadeBadTangents});
  rows.push_back({"glass", "nested, touching, of index 1, from inside, in a white furnace", 0.0, false,
                  lookThroughGlass});
  rows.push_back({"contact shadow", "the foot of a wall, from close by", 0.0, false, lookAtContactShadow});
  for (size_t i = 0; i < kFormNames.size(); ++i) {
    const std::string name(kFormNames[i]);
    rows.push_back({"scenes " + name, "random scenes, " + name + ": pictures that differ", 0.0, false,
                    [i](const StressSetting& setting) { return drawForms(setting, Form(i)); }});
    rows.push_back({"hits " + name, "random scenes, " + name + ": pixels that show something else", 1e-3,
                    false, [i](const StressSetting& setting) { return hitForms(setting, Form(i)); }});
  }
  rows.push_back({"tree identical", "a million identical triangles, 64 samples per pixel, beside one", 0.0,
                  false, drawIdentical});
  rows.push_back({"tree shrinking", "50,000 triangles from 1 to 1e-6, rays against double precision",
                  1.0 / 20000.0, false, castAtShrinking});
  rows.push_back({"film", "16 million samples of 1/3 in a pixel", 0.0, false, addThirds});
  rows.push_back({"no numbers", "files with NaN, infinity or the largest float", 0.0, false, drawNoNumbers});
  return rows;
}

}  // namespace fragtrace
