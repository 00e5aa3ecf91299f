// SPDX-License-Identifier: MIT
#include "view/window/panel_parts.h"

#include <algorithm>

#include "view/window/draw/text.h"

namespace fragtrace {

namespace {

constexpr float kLabelWidth = 0.42f;  // share of the row before its control
constexpr float kTipWidth = 30.0f;    // widest tip, in heights of the font

}  // namespace

void dimAtEnd(const std::string& text) {
  const float start = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x;
  const float room = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + ImGui::GetStyle().ItemSpacing.x;
  if (room <= start)
    ImGui::SameLine(start);
  else
    ImGui::SetCursorPosX(start);
  ImGui::TextDisabled("%s", text.c_str());
}

void label(Places& places, const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * kLabelWidth);
  ImGui::SetNextItemWidth(-1.0f);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  places[text] = {at.x, at.y, ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight()};
}

bool slider(Places& places, const char* name, double& value, float least, float most, const char* format,
            ImGuiSliderFlags flags) {
  label(places, name);
  float shown = float(value);
  const bool moved =
      ImGui::SliderFloat((std::string("##") + name).c_str(), &shown, least, most, format, flags);
  if (moved) value = shown;
  return moved;
}

void tip(Places& places, const std::string& text) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  const float left = ImGui::GetWindowPos().x - ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 item = ImGui::GetItemRectMin();
  const float padding = 2 * ImGui::GetStyle().WindowPadding.x;
  const float display = ImGui::GetIO().DisplaySize.x;
  const float most = std::min(kTipWidth * ImGui::GetFontSize(), display - padding);
  const float width = std::min(ImGui::CalcTextSize(text.c_str()).x, most);
  const bool beside = width + padding <= left;
  const float right = std::max(std::min(item.x, display - width - padding), 0.0f);
  ImGui::SetNextWindowPos(beside ? ImVec2(left, item.y) : ImVec2(right, item.y), ImGuiCond_Always,
                          beside ? ImVec2(1.0f, 0.0f) : ImVec2(0.0f, 1.0f));
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1.0f);
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(most);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  addWindowPlace(places, "tip");
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

void stayOnLineFor(const char* text) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float width = ImGui::CalcTextSize(text).x + 2 * style.FramePadding.x;
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= end) ImGui::SameLine();
}

std::string partText(size_t index, const std::string& name) {
  return std::to_string(index) + (name.empty() ? "" : ": " + shownText(name, kMostNameCharacters));
}

std::string keyOf(Command command, int argument) {
  const Control* control = controlOf(command, argument);
  return control ? controlName(*control) : std::string();
}

void commandButton(ViewFacts& facts, const char* text, Command command, int argument) {
  if (ImGui::Button(text)) facts.commands.push_back({command, argument});
  addItemPlace(facts.places, text);
}

void commandBox(ViewFacts& facts, const char* text, bool on, Command command) {
  if (ImGui::Checkbox(text, &on)) facts.commands.push_back({command});
  addItemPlace(facts.places, text);
}

}  // namespace fragtrace
