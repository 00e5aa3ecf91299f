// SPDX-License-Identifier: MIT
#include "view/window/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <span>
#include <string>

#include "stage/same_picture.h"
#include "view/window/text.h"

namespace fragtrace {

namespace {

constexpr float kLabelWidth = 0.42f;  // of the row, before its control
constexpr int kMostBouncesShown = 64;
constexpr float kMostColor = 1e4f;
/// Typed values keep to the ends of their slider, too.
constexpr ImGuiSliderFlags kBounded = ImGuiSliderFlags_AlwaysClamp;
constexpr ImGuiSliderFlags kBoundedLogarithmic = kBounded | ImGuiSliderFlags_Logarithmic;

/// In a dim colour at the right end of the line, or of a line of its own where that has no room.
void dimAtEnd(const std::string& text) {
  const float start = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x;
  const float room = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + ImGui::GetStyle().ItemSpacing.x;
  if (room <= start)
    ImGui::SameLine(start);
  else
    ImGui::SetCursorPosX(start);
  ImGui::TextDisabled("%s", text.c_str());
}

/// A label, and room for a control up to the end of the row.
void label(Places& places, const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * kLabelWidth);
  ImGui::SetNextItemWidth(-1.0f);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  places[text] = {at.x, at.y, ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight()};
}

/// The next button on the same line, if that has room for it.
void stayOnLineFor(const char* text) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float width = ImGui::CalcTextSize(text).x + 2 * style.FramePadding.x;
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= end) ImGui::SameLine();
}

template <typename Choice>
void choose(const char* id, std::span<const std::string_view> names, Choice& choice) {
  const std::string current(names[size_t(choice)]);
  if (!ImGui::BeginCombo(id, current.c_str())) return;
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string name(names[i]);
    if (ImGui::Selectable(name.c_str(), i == size_t(choice))) choice = Choice(i);
  }
  ImGui::EndCombo();
}

std::string keyOf(Action action, int argument = 0) {
  const Control* control = controlOf(action, argument);
  return control ? controlName(*control) : std::string();
}

Errand button(const char* text, Errand errand) { return ImGui::Button(text) ? errand : Errand::None; }

void drawStages(ViewState& state) {
  RenderOptions& o = state.options();
  for (const StageRow& row : stageRows()) {
    const std::string reason = row.stage == Stage::Flat ? "always on" : whyGrey(state, row.stage);
    bool on = has(o.stages, row.stage) && (reason.empty() || row.stage == Stage::Flat);
    ImGui::BeginDisabled(!reason.empty());
    if (ImGui::Checkbox(row.label, &on)) o.stages.set(size_t(row.stage), on);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", row.sentence);
    dimAtEnd(reason.empty() ? keyOf(Action::ToggleStage, int(row.stage)) : reason);
  }
}

void drawSampling(ViewState& state, Places& places) {
  RenderOptions& o = state.options();
  label(places, "Bounces");
  int bounces = std::min(o.bounces, kMostBouncesShown);
  if (ImGui::SliderInt("##bounces", &bounces, 0, kMostBouncesShown,
                       o.bounces >= kMostBouncesShown ? "unlimited" : "%d", kBounded))
    o.bounces = bounces >= kMostBouncesShown ? kUnlimitedBounces : bounces;
  label(places, "Roulette from");
  ImGui::SliderInt("##roulette", &o.rouletteDepth, 1, 32, "%d", kBounded);
  label(places, "Noise to reach");
  float noise = float(100.0 * o.noise);
  if (ImGui::SliderFloat("##noise", &noise, 0.1f, 20.0f, "%.2f %%", kBoundedLogarithmic))
    for (RenderOptions& side : state.sides) side.noise = 0.01 * noise;
  label(places, "Pixel filter");
  choose("##filter", kPixelFilterNames, o.pixelFilter);
  label(places, "Clamp indirect");
  float clamp = float(o.clampIndirect);
  if (ImGui::SliderFloat("##clamp", &clamp, 0.0f, 100.0f, clamp > 0.0f ? "%.2f (biased)" : "off",
                         kBoundedLogarithmic))
    o.clampIndirect = clamp;
  label(places, "Traversal");
  choose("##traversal", kTraversalNames, o.traversal);
}

void drawLight(ViewState& state, Places& places) {
  RenderOptions& o = state.sides[0];
  label(places, "Exposure");
  float exposure = float(o.exposure);
  if (ImGui::SliderFloat("##exposure", &exposure, -8.0f, 8.0f, "%.1f EV", kBounded))
    for (RenderOptions& side : state.sides) side.exposure = exposure;
  label(places, "Tone map");
  ToneMap curve = o.toneMap;
  choose("##curve", toneMapNames(), curve);
  for (RenderOptions& side : state.sides) side.toneMap = curve;
  const bool map = hasMap(o);
  label(places, "Environment");
  ImGui::BeginDisabled(!map);
  float degrees = float(o.hdriRotationDegrees);
  if (ImGui::SliderFloat("##rotation", &degrees, -180.0f, 180.0f, map ? "%.0f degrees" : "no environment map",
                         kBounded))
    for (RenderOptions& side : state.sides) side.hdriRotationDegrees = degrees;
  ImGui::EndDisabled();
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
}

Errand drawCamera(ViewState& state, Places& places) {
  Errand errand = Errand::None;
  const auto press = [&](const char* text, Action action) {
    if (ImGui::Button(text)) apply(state, *controlOf(action), {});
  };
  label(places, "Projection");
  if (ImGui::Button(state.pose.perspective ? "perspective" : "orthographic", ImVec2(-1, 0)))
    apply(state, *controlOf(Action::OtherProjection), {});
  if (state.pose.perspective) {
    label(places, "View angle");
    float degrees = float(state.pose.viewAngleDegrees);
    if (ImGui::SliderFloat("##angle", &degrees, 1.0f, 170.0f, "%.1f degrees", kBounded)) {
      state.pose.viewAngleDegrees = degrees;
      state.posed = true;
    }
  }
  if (state.scene && !state.scene->cameras.empty()) {
    label(places, "Scene camera");
    const auto& cameras = state.scene->cameras;
    const auto nameOf = [&](int i) {
      if (i < 0 || size_t(i) >= cameras.size()) return std::string("none");
      const std::string& name = cameras[size_t(i)].name;
      return std::to_string(i) + (name.empty() ? "" : ": " + shownText(name, kMostNameCharacters));
    };
    if (ImGui::BeginCombo("##camera", nameOf(state.sceneCamera).c_str())) {
      for (int i = 0; i < int(cameras.size()); ++i) {
        Control control{.action = Action::SceneCamera, .argument = i};
        if (ImGui::Selectable(nameOf(i).c_str(), i == state.sceneCamera)) apply(state, control, {});
      }
      ImGui::EndCombo();
    }
  }
  press("Frame all", Action::FrameAll);
  stayOnLineFor("Reset");
  press("Reset", Action::ResetCamera);
  stayOnLineFor("Copy");
  errand = std::max(errand, button("Copy", Errand::CopyCommand));
  stayOnLineFor("Paste");
  errand = std::max(errand, button("Paste", Errand::PasteCommand));
  return errand;
}

void drawAnimation(ViewState& state, Places& places) {
  const int shown = shownAnimation(state);
  const std::vector<std::string>& names = state.scene->animationNames;
  const auto nameOf = [&](int i) {
    const std::string& name = names[size_t(i)];
    return std::to_string(i) + (name.empty() ? "" : ": " + shownText(name, kMostNameCharacters));
  };
  label(places, "Clip");
  if (ImGui::BeginCombo("##clip", nameOf(shown).c_str())) {
    for (int i = 0; i < int(names.size()); ++i) {
      if (ImGui::Selectable(nameOf(i).c_str(), i == shown)) showAnimation(state, i, 0.0);
    }
    ImGui::EndCombo();
  }
  label(places, "Time");
  float time = float(state.sides[0].selection.animationTime.value_or(0.0));
  if (ImGui::SliderFloat("##time", &time, 0.0f, float(animationLength(state)), "%.2f s", kBounded)) {
    state.playback.playing = false;
    showAnimation(state, shown, time);
  }
  label(places, "Speed");
  float speed = float(state.playback.speed);
  if (ImGui::SliderFloat("##speed", &speed, 0.1f, 10.0f, "%.2f", kBoundedLogarithmic))
    state.playback.speed = speed;
  if (ImGui::Button(state.playback.playing ? "Pause" : "Play"))
    apply(state, *controlOf(Action::PlayAnimation), {});
  addItemPlace(places, "Play");
  ImGui::SameLine();
  ImGui::Checkbox("Loop", &state.playback.loops);
  addItemPlace(places, "Loop");
  dimAtEnd(keyOf(Action::PlayAnimation));
}

void drawCompare(ViewState& state, Places& places) {
  bool split = state.split;
  if (ImGui::Checkbox("Split view", &split)) apply(state, *controlOf(Action::ToggleSplit), {});
  stayOnLineFor("[ ] Denoise");
  const std::string reason = whyWithoutNoise(state.options());
  bool denoise = state.options().denoise != Denoise::None && reason.empty();
  ImGui::BeginDisabled(!reason.empty());
  if (ImGui::Checkbox("Denoise", &denoise)) apply(state, *controlOf(Action::ToggleDenoise), {});
  ImGui::EndDisabled();
  addItemPlace(places, "Denoise");
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    ImGui::SetTooltip(
        "%s", reason.empty() ? "all of it up to 64 samples per pixel, nothing from 256 on" : reason.c_str());
  dimAtEnd(keyOf(Action::ToggleSplit) + ", " + keyOf(Action::ToggleDenoise));
  if (!state.split) return;
  int active = int(state.active);
  ImGui::TextUnformatted("Settings of the");
  ImGui::SameLine();
  ImGui::RadioButton("left", &active, 0);
  ImGui::SameLine();
  ImGui::RadioButton("right side", &active, 1);
  state.active = size_t(active);
}

void drawDebug(ViewState& state, Places& places) {
  RenderOptions& o = state.options();
  label(places, "Show");
  const std::string current(rowOf(o.debugView).label);
  if (ImGui::BeginCombo("##show", current.c_str(), ImGuiComboFlags_HeightLargest)) {
    for (size_t i = 0; i < kDebugViewRows.size(); ++i) {
      const std::string name(kDebugViewRows[i].label);
      if (ImGui::Selectable(name.c_str(), DebugView(i) == o.debugView)) o.debugView = DebugView(i);
    }
    ImGui::EndCombo();
  }
  ImGui::Checkbox("Boxes of the tree", &state.treeBoxes);
  dimAtEnd(keyOf(Action::ToggleTreeBoxes));
  label(places, "Level");
  ImGui::SliderInt("##level", &state.treeLevel, 0, 31, "%d", kBounded);
}

}  // namespace

Errand drawPanel(ViewState& state, const OverlayLayout& layout, Places& places) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({display.x - layout.panel.x - layout.margin, layout.margin});
  ImGui::SetNextWindowSizeConstraints({layout.panel.x, 0.0f}, {layout.panel.x, layout.panel.y});
  ImGui::SetNextWindowBgAlpha(0.88f);
  Errand errand = Errand::None;
  if (ImGui::Begin("Settings", nullptr,
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoNav)) {
    addWindowPlace(places, "panel");
    drawCompare(state, places);
    if (shownAnimation(state) >= 0 && ImGui::CollapsingHeader("Animation", ImGuiTreeNodeFlags_DefaultOpen))
      drawAnimation(state, places);
    if (ImGui::CollapsingHeader("Stages and switches", ImGuiTreeNodeFlags_DefaultOpen)) drawStages(state);
    if (ImGui::CollapsingHeader("Light and display", ImGuiTreeNodeFlags_DefaultOpen))
      drawLight(state, places);
    if (ImGui::CollapsingHeader("Camera", ImGuiTreeNodeFlags_DefaultOpen)) errand = drawCamera(state, places);
    if (ImGui::CollapsingHeader("Sampling")) drawSampling(state, places);
    if (ImGui::CollapsingHeader("Debug views")) drawDebug(state, places);
    errand = std::max(errand, button("Screenshot", Errand::Screenshot));
    stayOnLineFor("Write .exr");
    errand = std::max(errand, button("Write .exr", Errand::WriteExr));
    stayOnLineFor("Reload");
    errand = std::max(errand, button("Reload", Errand::Reload));
    ImGui::TextDisabled("%s: all keys   %s: this panel", keyOf(Action::ToggleSheet).c_str(),
                        keyOf(Action::TogglePanel).c_str());
  }
  ImGui::End();
  return errand;
}

}  // namespace fragtrace
