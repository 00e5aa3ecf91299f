// SPDX-License-Identifier: MIT
// Exposure, tone map, environment and background.
#include <glm/gtc/type_ptr.hpp>

#include "image/display/tone_map.h"
#include "scene/blurred_map.h"
#include "view/environments.h"
#include "view/window/panel_parts.h"
#include "view/window/text.h"

namespace fragtrace {

namespace {

constexpr float kMostColor = 1e4f;
constexpr float kMostBlur = 30.0f;  // degrees; the command line takes more

/// A list of what can light the scene; what was chosen, with which it is to be loaded again.
std::optional<RenderOptions> chooseEnvironment(const ViewedScene& scene, Places& places) {
  std::optional<RenderOptions> chosen;
  const std::vector<EnvironmentChoice> choices = environmentChoices(scene);
  const size_t current = currentChoice(scene, choices);
  if (!ImGui::BeginCombo("##environment", shownText(choices[current].name, kMostNameCharacters).c_str()))
    return chosen;
  for (size_t i = 0; i < choices.size(); ++i) {
    ImGui::PushID(int(i));
    if (ImGui::Selectable(shownText(choices[i].name, kMostNameCharacters).c_str(), i == current))
      chosen = withEnvironment(scene.options, choices[i]);
    addItemPlace(places, "environment " + choices[i].name);
    ImGui::PopID();
  }
  ImGui::EndCombo();
  return chosen;
}

}  // namespace

Task drawLight(ViewState& state, ViewFacts& facts) {
  Places& places = facts.places;
  Task task;
  RenderOptions& o = state.sides[0];
  label(places, "Exposure");
  float exposure = float(o.exposure);
  if (ImGui::SliderFloat("##exposure", &exposure, -8.0f, 8.0f, "%.1f EV", kBounded))
    for (RenderOptions& side : state.sides) side.exposure = exposure;
  label(places, "Tone map");
  ToneMap curve = o.toneMap;
  choose("##curve", toneMapNames(), curve);
  for (RenderOptions& side : state.sides) side.toneMap = curve;
  const bool map = state.scene->map;
  label(places, "Environment");
  if (const std::optional<RenderOptions> other = chooseEnvironment(*state.scene, places)) {
    task.errand = Errand::Load;
    task.load = other;
  }
  label(places, "Rotation");
  ImGui::BeginDisabled(!map);
  float degrees = float(o.hdriRotationDegrees);
  if (ImGui::SliderFloat("##rotation", &degrees, -180.0f, 180.0f, map ? "%.0f degrees" : "no environment map",
                         kBounded))
    for (RenderOptions& side : state.sides) side.hdriRotationDegrees = degrees;
  ImGui::EndDisabled();
  if (!state.scene->options.hdriFile.empty()) {
    label(places, "Blur");
    const double blur = state.scene->options.backgroundBlur;
    // It is blurred once, when the slider is let go.
    float wanted = state.blur.value_or(float(blur));
    if (ImGui::SliderFloat("##blur", &wanted, 0.0f, kMostBlur, wanted > 0.0f ? "%.1f degrees" : "none",
                           kBounded))
      state.blur = wanted;
    if (ImGui::IsItemDeactivatedAfterEdit() && state.blur) {
      task.errand = Errand::Load;
      task.load = state.scene->options;
      task.load->backgroundBlur = *state.blur < kLeastBlur ? 0.0 : double(*state.blur);
      state.blur.reset();
    }
  }
  label(places, "Background");
  bool background = o.background;
  if (ImGui::Checkbox("##background", &background))
    for (RenderOptions& side : state.sides) side.background = background;
  if (background && !map) {
    ImGui::SameLine();
    glm::vec3 color = o.backgroundColor.value_or(glm::vec3(0.0f));
    if (ImGui::ColorEdit3("##color", glm::value_ptr(color),
                          ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR | ImGuiColorEditFlags_NoInputs))
      for (RenderOptions& side : state.sides)
        side.backgroundColor = glm::clamp(color, glm::vec3(0.0f), glm::vec3(kMostColor));
    addItemPlace(places, "Background colour");
  }
  const bool paths = has(state.options().stages, Stage::Gi);
  bool ground = o.shadowCatcher && paths;
  ImGui::BeginDisabled(!paths);
  if (ImGui::Checkbox("Ground that shows shadows alone", &ground))
    apply(state, *controlOf(Action::ToggleGround), {});
  ImGui::EndDisabled();
  addItemPlace(places, "Ground");
  dimAtEnd(paths ? keyOf(Action::ToggleGround) : "only path traced");
  return task;
}

}  // namespace fragtrace
