// SPDX-License-Identifier: MIT

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/text.h"
#include "options/same_picture.h"
#include "view/presets.h"
#include "view/window/draw/text.h"
#include "view/window/draw/theme.h"
#include "view/window/input.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

namespace {

constexpr int kMostBouncesShown = 64;

void drawPresets(const ViewState& state, ViewFacts& facts) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float count = float(kPresets.size());
  const float width = (ImGui::GetContentRegionAvail().x - (count - 1) * style.ItemSpacing.x) / count;
  for (const Preset& preset : kPresets) {
    const bool chosen = isPreset(state.side().stages, preset);
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, kAccent);
    if (&preset != kPresets.data()) ImGui::SameLine();
    if (placed(facts.places, preset.name, ImGui::Button(preset.name, {width, 0.0f})))
      facts.commands.push_back({Command::StagesUpTo, int(preset.last)});
    if (chosen) ImGui::PopStyleColor();
    tip(facts.places, preset.sentence);
  }
}

/// Draws the stages that build on each other, or the switches.
void drawStages(ViewState& state, Places& places, bool cumulative) {
  SideOptions& side = state.side();
  for (const StageRow& row : stageRows()) {
    if (row.cumulative != cumulative) continue;
    const std::string reason = row.stage == Stage::Flat ? "always on" : whyGrey(state, row.stage);
    bool on = has(side.stages, row.stage) && (reason.empty() || row.stage == Stage::Flat);
    ImGui::BeginDisabled(!reason.empty());
    if (ImGui::Checkbox(row.label, &on)) side.stages.set(size_t(row.stage), on);
    ImGui::EndDisabled();
    tip(places, row.sentence);
    dimAtEnd(reason.empty() ? keyOf(Command::ToggleStage, int(row.stage)) : reason);
  }
}

void drawSampling(ViewState& state, Places& places) {
  SideOptions& side = state.side();
  int bounces = std::min(side.sampling.bounces, kMostBouncesShown);
  const bool unlimited = side.sampling.bounces >= kMostBouncesShown;
  if (slider(places, {"Bounces", 0, kMostBouncesShown, unlimited ? "unlimited" : "%d"}, bounces))
    side.sampling.bounces = bounces >= kMostBouncesShown ? kUnlimitedBounces : bounces;
  slider(places, {"Roulette from", 1, 32, "%d"}, side.sampling.rouletteDepth);
  double& goal = state.edit.shared.sampling.noise;
  double percent = 100.0 * goal;
  if (slider(places, {"Noise to reach", 0.1f, 20.0f, "%.2f %%", kBoundedLogarithmic}, percent))
    goal = 0.01 * percent;
  choose(places, "Pixel filter", kPixelFilterNames, side.pixelFilter);
  double& clamp = side.sampling.clampIndirect;
  slider(places, {"Clamp indirect", 0.0f, 100.0f, clamp > 0.0 ? "%.2f (biased)" : "off", kBoundedLogarithmic},
         clamp);
  choose(places, "Traversal", kTraversalNames, side.device.traversal);
}

void drawAnimation(ViewState& state, ViewFacts& facts) {
  Places& places = facts.places;
  const int shown = shownAnimation(state);
  const std::vector<std::string>& names = state.scene->animationNames;
  const auto nameOf = [&](size_t i) { return i < names.size() ? partText(i, names[i]) : "all at once"; };
  if (const auto chosen = choose(places, "Clip", size_t(animationCount(state)), size_t(shown), nameOf))
    showAnimation(state, int(*chosen), 0.0);
  const std::optional<double> posed = state.edit.shared.selection.animationTime;
  double time = posed.value_or(0.0);
  if (slider(places, {"Time", 0.0f, float(animationLength(state)), posed ? "%.2f s" : "at rest"}, time)) {
    state.playback.playing = false;
    showAnimation(state, shown, time);
  }
  slider(places, {"Speed", 0.1f, 10.0f, "%.2f", kBoundedLogarithmic}, state.playback.speed);
  if (placed(places, "Play", ImGui::Button(state.playback.playing ? "Pause" : "Play")))
    facts.commands.push_back({Command::PlayAnimation});
  ImGui::SameLine();
  placed(places, "Loop", ImGui::Checkbox("Loop", &state.playback.loops));
  dimAtEnd(keyOf(Command::PlayAnimation));
}

/// Draws the choice of the side whose settings are shown. If side B is a file, draws its name instead.
void drawSides(ViewState& state, ViewFacts& facts) {
  if (!state.reference.empty()) {
    if (placed(facts.places, "close reference", ImGui::SmallButton("x")))
      facts.commands.push_back({Command::DropReference});
    ImGui::SameLine();
    ImGui::Text("B: %s", shownText(state.reference.filename().string(), kMostNameCharacters).c_str());
    return;
  }
  int active = int(state.edit.active);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Settings of");
  ImGui::SameLine();
  ImGui::RadioButton("A (left)", &active, 0);
  ImGui::SameLine();
  ImGui::RadioButton("B (right)", &active, 1);
  state.edit.active = size_t(active);
}

void drawCompare(ViewState& state, ViewFacts& facts) {
  Places& places = facts.places;
  commandBox(facts, "Split view", state.edit.split, Command::ToggleSplit);
  stayOnLineFor("[ ] Denoise");
  const std::string reason = whyWithoutNoise(state.options());
  const bool denoises = state.side().denoise != Denoise::None && reason.empty();
  ImGui::BeginDisabled(!reason.empty());
  commandBox(facts, "Denoise", denoises, Command::ToggleDenoise);
  ImGui::EndDisabled();
  tip(places, reason.empty() ? "all of it up to 64 samples per pixel, nothing from 256 on" : reason);
  dimAtEnd(keyOf(Command::ToggleSplit) + ", " + keyOf(Command::ToggleDenoise));
  if (!state.edit.split) return;
  int comparison = int(state.comparison);
  constexpr std::array kNames{"bar", "A", "B", "difference"};
  for (int i = 0; i < int(kNames.size()); ++i) {
    if (i > 0) ImGui::SameLine();
    placed(places, std::string("compare ") + kNames[size_t(i)],
           ImGui::RadioButton(kNames[size_t(i)], &comparison, i));
  }
  state.comparison = CompareMode(comparison);
  if (state.comparison == CompareMode::Difference)
    slider(places, {"Amplify", -8.0f, 16.0f, shortText(std::exp2(state.differenceStops)).c_str()},
           state.differenceStops);
  drawSides(state, facts);
}

void drawAdvanced(ViewState& state, ViewFacts& facts) {
  Places& places = facts.places;
  SideOptions& side = state.side();
  const auto nameOf = [](size_t i) { return std::string(kDebugViewRows[i].label); };
  if (const auto chosen = choose(places, "Show", kDebugViewRows.size(), size_t(side.debugView), nameOf,
                                 ImGuiComboFlags_HeightLargest))
    side.debugView = DebugView(*chosen);
  ImGui::Checkbox("Boxes of the tree", &state.edit.treeBoxes);
  dimAtEnd(keyOf(Command::ToggleTreeBoxes));
  slider(places, {"Level", 0, 31, "%d"}, state.edit.treeLevel);
  placed(places, "Figures", ImGui::Checkbox("Figures over the picture", &state.figures));
  dimAtEnd(keyOf(Command::ToggleHud));
  ImGui::TextDisabled("Features in the shader");
  ImGui::PushTextWrapPos(0.0f);
  std::string variant = facts.statistics[state.shownSide()].variant;
  std::ranges::replace(variant, '+', ' ');
  drawText(variant, kMostLineCharacters);
  ImGui::PopTextWrapPos();
}

/// The left edge of a docked panel can be dragged (Input).
void drawEdge(const WindowLayout& layout) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool near =
      std::abs(mouse.x - float(layout.picture.x)) <= kEdgePixels * layout.scale && mouse.y < layout.panel.y;
  if (near) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
}

void drawButtons(ViewFacts& facts) {
  ImGui::Separator();
  const auto next = [&](const char* text, Command command) {
    stayOnLineFor(text);
    commandButton(facts, text, command);
  };
  commandButton(facts, "Open...", Command::Open);
  next("Save as...", Command::SaveAs);
  next("Save model...", Command::SaveModel);
  next("Write .exr", Command::WriteExr);
  next("Reload", Command::Reload);
  next("Reset all", Command::ResetAll);
  next("Full screen", Command::Fullscreen);
  ImGui::TextDisabled("%s: all keys   %s: this panel", keyOf(Command::ToggleSheet).c_str(),
                      keyOf(Command::TogglePanel).c_str());
}

}  // namespace

void drawPanel(ViewState& state, ViewFacts& facts, const WindowLayout& layout) {
  Places& places = facts.places;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float margin = layout.docked ? 0.0f : layout.margin;
  ImGui::SetNextWindowPos({display.x - layout.panel.x - margin, margin});
  if (layout.docked)
    ImGui::SetNextWindowSize({layout.panel.x, layout.panel.y});
  else
    ImGui::SetNextWindowSizeConstraints({layout.panel.x, 0.0f}, {layout.panel.x, layout.panel.y});
  ImGui::SetNextWindowBgAlpha(layout.docked ? 1.0f : 0.94f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, layout.docked ? 0.0f : ImGui::GetStyle().WindowRounding);
  const ImGuiWindowFlags flags = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoNav |
                                 ImGuiWindowFlags_NoResize |
                                 (layout.docked ? 0 : ImGuiWindowFlags_AlwaysAutoResize);
  if (ImGui::Begin("Settings", nullptr, flags)) {
    addWindowPlace(places, "panel");
    if (layout.docked) drawEdge(layout);
    drawPresets(state, facts);
    drawCompare(state, facts);
    const auto open = [&](const char* name, bool first = true) {
      return placed(places, std::string("section ") + name,
                    ImGui::CollapsingHeader(name, first ? ImGuiTreeNodeFlags_DefaultOpen : 0));
    };
    if (shownAnimation(state) >= 0 && open("Animation")) drawAnimation(state, facts);
    if (hasParts(state) && open("File")) drawParts(state, facts);
    const std::optional<uint32_t> picked = facts.pick ? facts.pick->material : std::nullopt;
    if (picked && *picked < state.scene->materials.size() && open("Material")) {
      ImGui::TextDisabled("%s", partText(*picked, state.scene->materials[*picked].name).c_str());
      drawMaterial(state, places, *picked);
    }
    if (open("Scene", false)) drawTree(state, facts);
    if (open("Light and display")) drawLight(state, facts);
    if (open("Histogram", false)) drawHistogram(state, facts);
    if (open("Camera")) drawCamera(state, facts);
    if (open("Stages")) drawStages(state, places, true);
    if (open("Switches", false)) drawStages(state, places, false);
    if (open("Sampling", false)) drawSampling(state, places);
    if (open("Advanced", false)) drawAdvanced(state, facts);
    if (open("Shown before", false)) drawRecentFiles(facts);
    drawButtons(facts);
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace fragtrace
