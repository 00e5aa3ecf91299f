// SPDX-License-Identifier: MIT
#include "view/window/overlay.h"

#include <algorithm>
#include <array>
#include <string>

#include "view/window/draw/text.h"
#include "view/window/draw/theme.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

namespace {

/// The name of a button, by the room that it has.
enum class Naming : uint8_t { Label, Name, Number };

std::string nameOf(const StageRow& row, Naming naming) {
  return naming == Naming::Label  ? row.label
         : naming == Naming::Name ? row.name
                                  : std::to_string(int(row.stage) + 1);
}

float widthOf(const std::string& text) {
  const ImGuiStyle& style = ImGui::GetStyle();
  return ImGui::CalcTextSize(text.c_str()).x + 2 * style.FramePadding.x + style.ItemSpacing.x;
}

float widthOf(Naming naming) {
  float width = 0.0f;
  for (const StageRow& row : stageRows()) width += row.cumulative ? widthOf(nameOf(row, naming)) : 0.0f;
  return width;
}

void drawStage(const ViewState& state, ViewFacts& facts, const StageRow& row, Naming naming) {
  const std::string reason = whyGrey(state, row.stage);
  const bool on = has(state.side().stages, row.stage) && reason.empty();
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, kAccent);
  if (!reason.empty()) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  const Control& control = *controlOf(Command::StagesUpTo, int(row.stage));
  if (placed(facts.places, std::string("stage ") + row.name, ImGui::Button(nameOf(row, naming).c_str())))
    facts.commands.push_back(invocationOf(control));
  ImGui::PopStyleColor(int(on) + int(!reason.empty()));
  const char* upTo = row.stage == Stage::Flat ? "" : "All stages up to ";
  tip(facts.places, controlName(control) + ": " + upTo + row.label + ": " + row.sentence +
                        (reason.empty() ? "" : " (" + reason + ")"));
  ImGui::SameLine();
}

/// A button at the right end.
struct EndButton {
  const char* text;
  Command command;
  int rank;  ///< 0: the last to be left out
};
constexpr std::array kEndButtons{EndButton{"All", Command::ToggleOverview, 2},
                                 EndButton{"Undo", Command::Undo, 3}, EndButton{"Redo", Command::Redo, 4},
                                 EndButton{"Screenshot", Command::Screenshot, 1},
                                 EndButton{"Panel", Command::TogglePanel, 0}};

/// Returns the width of the first `ranks` ranks.
float widthOf(int ranks) {
  float width = 0.0f;
  for (const EndButton& button : kEndButtons) width += button.rank < ranks ? widthOf(button.text) : 0.0f;
  return width;
}

void drawEndButtons(const ViewState& state, ViewFacts& facts, float left, float right) {
  int ranks = int(kEndButtons.size());
  while (ranks > 0 && widthOf(ranks) > right - left) --ranks;
  float place = right - widthOf(ranks);
  for (const EndButton& button : kEndButtons) {
    if (button.rank >= ranks) continue;
    ImGui::SameLine(place);
    place += widthOf(button.text);
    const bool off = (button.command == Command::Undo && !facts.canUndo) ||
                     (button.command == Command::Redo && !facts.canRedo);
    ImGui::BeginDisabled(off);
    const bool lit = button.command == Command::ToggleOverview && state.overview;
    if (lit) ImGui::PushStyleColor(ImGuiCol_Button, kAccent);
    commandButton(facts, button.text, button.command);
    if (lit) ImGui::PopStyleColor();
    ImGui::EndDisabled();
    const Control& control = *controlOf(button.command);
    tip(facts.places, controlName(control) + ": " + control.sentence);
  }
}

/// Stages get labels if all buttons at the end still fit, names if the first two ranks do, else numbers.
Naming namingFor(float room) {
  if (widthOf(Naming::Label) + widthOf(int(kEndButtons.size())) <= room) return Naming::Label;
  return widthOf(Naming::Name) + widthOf(2) <= room ? Naming::Name : Naming::Number;
}

}  // namespace

void drawStageBar(const ViewState& state, ViewFacts& facts, const WindowLayout& layout) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.0f, float(layout.picture.y)});
  ImGui::SetNextWindowSize({display.x, layout.stagesHeight});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(layout.margin, 0.0f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0f, 1.0f));
  const bool shown =
      ImGui::Begin("stages", nullptr,
                   (kLabelFlags & ~ImGuiWindowFlags_AlwaysAutoResize) | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar(3);
  if (shown) {
    addWindowPlace(facts.places, "stages");
    ImGui::SetCursorPosY(std::max(0.5f * (layout.stagesHeight - ImGui::GetFrameHeight()), 0.0f));
    ImGui::BeginDisabled(!state.scene);
    const float right = display.x - layout.margin + ImGui::GetStyle().ItemSpacing.x;
    const Naming naming = namingFor(right - layout.margin);
    for (const StageRow& row : stageRows()) {
      if (row.cumulative) drawStage(state, facts, row, naming);
    }
    drawEndButtons(state, facts, layout.margin + widthOf(naming), right);
    ImGui::EndDisabled();
  }
  ImGui::End();
}

}  // namespace fragtrace
