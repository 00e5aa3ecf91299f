// SPDX-License-Identifier: MIT
#include "view/live/pick_text.h"

#include "view/shown_text.h"

namespace fragtrace {

std::vector<std::string> pickLines(const Scene& scene, const Pick& pick) {
  std::vector<std::string> lines;
  lines.push_back("node " + pick.node);
  if (!pick.mesh.empty())
    lines.push_back("mesh " + pick.mesh + ", triangle " + std::to_string(pick.triangle));
  lines.push_back(
      formatted("at %.4g, %.4g, %.4g; %.4g m away", pick.point.x, pick.point.y, pick.point.z, pick.distance));
  lines.push_back(formatted("normal %.3f, %.3f, %.3f", pick.normal.x, pick.normal.y, pick.normal.z));
  if (pick.material >= scene.materials.size()) return lines;
  const Material& material = scene.materials[pick.material];
  lines.push_back("material " + std::to_string(pick.material) +
                  (material.name.empty() ? "" : ": " + material.name));
  return lines;
}

}  // namespace fragtrace
