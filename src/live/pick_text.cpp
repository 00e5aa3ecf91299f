// SPDX-License-Identifier: MIT
#include "live/pick_text.h"

#include <cstdio>

namespace fragtrace {

namespace {

template <typename... Values>
std::string text(const char* format, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

void addMaterial(std::vector<std::string>& lines, const Material& m, uint32_t index) {
  lines.push_back("material " + std::to_string(index) + (m.name.empty() ? "" : ": " + m.name) +
                  (m.unlit ? ", unlit" : "") + (m.doubleSided ? ", double-sided" : ""));
  const glm::vec4 c = m.baseColorFactor;
  lines.push_back(text("  base colour %.3g, %.3g, %.3g", double(c.r), double(c.g), double(c.b)) +
                  (m.baseColorTexture.present() ? ", textured" : ""));
  lines.push_back(
      text("  metallic %.3g, roughness %.3g", double(m.metallicFactor), double(m.roughnessFactor)) +
      (m.metallicRoughnessTexture.present() ? ", textured" : ""));
  if (m.transmissive() || m.ior != 1.5f)
    lines.push_back(
        text("  transmission %.3g, index of refraction %.4g", double(m.transmissionFactor), double(m.ior)));
  const glm::vec3 e = m.emissiveFactor * m.emissiveStrength;
  if (m.emissive()) lines.push_back(text("  emits %.4g, %.4g, %.4g", double(e.r), double(e.g), double(e.b)));
  if (m.alphaMode != AlphaMode::Opaque)
    lines.push_back(m.alphaMode == AlphaMode::Mask ? "  alpha mask" : "  alpha blend");
}

}  // namespace

std::vector<std::string> pickLines(const Scene& scene, const Pick& pick) {
  std::vector<std::string> lines;
  lines.push_back("node " + pick.node);
  if (!pick.mesh.empty())
    lines.push_back("mesh " + pick.mesh + ", triangle " + std::to_string(pick.triangle));
  lines.push_back(
      text("at %.6g, %.6g, %.6g, %.6g m away", pick.point.x, pick.point.y, pick.point.z, pick.distance));
  lines.push_back(text("normal %.4f, %.4f, %.4f", pick.normal.x, pick.normal.y, pick.normal.z));
  if (pick.material < scene.materials.size())
    addMaterial(lines, scene.materials[pick.material], pick.material);
  return lines;
}

}  // namespace fragtrace
