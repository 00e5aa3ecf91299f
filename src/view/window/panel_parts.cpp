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

namespace {

template <typename Slide>
bool drawRow(Places& places, const Row& row, const Slide& slide) {
  label(places, row.name);
  if (row.spare > 0.0f) ImGui::SetNextItemWidth(-row.spare);
  ImGui::BeginDisabled(!row.whyOff.empty());
  const bool moved =
      slide((std::string("##") + row.name).c_str(), row.whyOff.empty() ? row.format : row.whyOff.c_str());
  ImGui::EndDisabled();
  if (row.tip) tip(places, row.tip);
  return moved;
}

}  // namespace

bool slider(Places& places, const Row& row, double& value) {
  return drawRow(places, row, [&](const char* id, const char* format) {
    float shown = float(value);
    const bool moved = ImGui::SliderFloat(id, &shown, row.least, row.most, format, row.flags);
    if (moved) value = shown;
    return moved;
  });
}

bool slider(Places& places, const Row& row, int& value) {
  return drawRow(places, row, [&](const char* id, const char* format) {
    return ImGui::SliderInt(id, &value, int(row.least), int(row.most), format, row.flags);
  });
}

std::optional<size_t> choose(Places& places, const char* name, size_t count, std::optional<size_t> current,
                             const std::function<std::string(size_t)>& nameOf, ImGuiComboFlags flags) {
  label(places, name);
  std::optional<size_t> chosen;
  const std::string shown = current && *current < count ? nameOf(*current) : "none";
  if (!ImGui::BeginCombo((std::string("##") + name).c_str(), shown.c_str(), flags)) return chosen;
  for (size_t i = 0; i < count; ++i) {
    if (ImGui::Selectable(nameOf(i).c_str(), i == current)) chosen = i;
  }
  ImGui::EndCombo();
  return chosen;
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
  if (placed(facts.places, text, ImGui::Button(text))) facts.commands.push_back({command, argument});
}

void commandBox(ViewFacts& facts, const char* text, bool on, Command command) {
  if (placed(facts.places, text, ImGui::Checkbox(text, &on))) facts.commands.push_back({command});
}

}  // namespace fragtrace
