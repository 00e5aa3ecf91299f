// SPDX-License-Identifier: MIT
#include "stress/stress.h"

#include "stress/rays.h"
#include "stress/shading.h"
#include "stress/shell.h"

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
  rows.push_back({"bad normals", "missing, backwards and tilted normals in a white furnace", 0.0, false,
                  shadeBadNormals});
  rows.push_back({"bad tangents", "a steep map over tangents that do not fit, in a white furnace", 0.0, false,
                  shadeBadTangents});
  rows.push_back({"glass", "nested, touching, of index 1, from inside, in a white furnace", 0.0, false,
                  lookThroughGlass});
  rows.push_back({"contact shadow", "the foot of a wall, from close by", 0.0, false, lookAtContactShadow});
  return rows;
}

}  // namespace fragtrace
