// SPDX-License-Identifier: MIT
// Sliders for the numbers of materials and lights that are set by eye.
#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "gltf/edit/factors.h"
#include "view/set_by_eye.h"
#include "view/window/draw/text.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

namespace {

constexpr float kMostBrighter = 100.0f;  // than in the file

/// Linear, from 0 to 1.
bool editColor(const char* id, float* color) {
  if (!ImGui::ColorEdit3(id, color, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoLabel)) return false;
  // Any number may be typed.
  for (int i = 0; i < 3; ++i) color[i] = std::clamp(color[i], 0.0f, 1.0f);
  return true;
}

void drawFactor(ViewState& state, Places& places, const Factor& factor, const Material& file, Material now) {
  label(places, factor.label);
  const std::string id = std::string("##") + factor.member;
  float* first = factor.at(now);
  const ImGuiSliderFlags flags = factor.logarithmic ? kBoundedLogarithmic : kBounded;
  const bool changed = factor.width > 1
                           ? editColor(id.c_str(), first)
                           : ImGui::SliderFloat(id.c_str(), first, factor.least, factor.most, "%.3f", flags);
  if (changed) setNumber(state, numberOf(factor, now), numberOf(factor, file));
}

void drawLightSource(ViewState& state, Places& places, size_t index) {
  const LightSource& file = state.scene->lights[index];
  LightSource now = file;
  setLight(now, index, state.edit.shared.selection.set);
  const float most = file.intensity > 0.0 ? kMostBrighter * float(file.intensity) : kMostBrighter;
  if (slider(places, {"Light intensity", 0.0f, most, "%.4g", kBoundedLogarithmic}, now.intensity)) {
    now.intensity = shortest(float(now.intensity));
    setNumber(state, intensityOf(now, index), intensityOf(file, index));
  }
  label(places, "Light colour");
  glm::vec3 color(now.color);
  if (editColor("##color", glm::value_ptr(color))) {
    now.color = {shortest(color.x), shortest(color.y), shortest(color.z)};
    setNumber(state, colorOf(now, index), colorOf(file, index));
  }
}

/// A row that opens.
bool beginPart(Places& places, const std::string& place, size_t index, const std::string& name) {
  ImGui::PushID(int(index));
  return placed(places, place + " " + std::to_string(index),
                ImGui::TreeNodeEx("##part", 0, "%s", partText(index, name).c_str()));
}

void endPart(bool open) {
  if (open) ImGui::TreePop();
  ImGui::PopID();
}

}  // namespace

void drawMaterial(ViewState& state, Places& places, size_t index) {
  const Material& file = state.scene->materials[index];
  const Material now = shownMaterial(state, index);
  for (const Factor& factor : factors()) {
    if (isOffered(factor, file)) drawFactor(state, places, factor, file, now);
  }
}

void drawMaterials(ViewState& state, Places& places) {
  for (size_t i = 0; i < state.scene->materials.size(); ++i) {
    const bool open = beginPart(places, "material", i, state.scene->materials[i].name);
    if (open) {
      drawMaterial(state, places, i);
      for (const std::string& line : materialLines(shownMaterial(state, i)))
        ImGui::TextUnformatted(line.c_str());
    }
    endPart(open);
  }
}

void drawLights(ViewState& state, Places& places) {
  for (size_t i = 0; i < state.scene->lights.size(); ++i) {
    const bool open = beginPart(places, "light", i, state.scene->lights[i].name);
    if (open) drawLightSource(state, places, i);
    endPart(open);
  }
}

}  // namespace fragtrace
