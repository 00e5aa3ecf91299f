// SPDX-License-Identifier: MIT
#include "view/window/widgets.h"

#include <algorithm>
#include <system_error>

#include "image/display/tone_map.h"

namespace fragtrace {

namespace {

ImVec4 grey(float level, float opacity = 1.0f) { return {level, level, level, opacity}; }

const ImVec4 kAccentLit{0.27f, 0.48f, 0.74f, 1.0f};

void add(const std::string& name, ImVec2 place, ImVec2 size) {
  places()[name] = {place.x, place.y, size.x, size.y};
}

constexpr float kLabelWidth = 0.42f;  // share of the row before its control
constexpr float kTipWidth = 30.0f;    // widest tip, in heights of the font

template <typename Slide>
bool drawRow(const Row& row, const Slide& slide) {
  label(row.name);
  if (row.spare > 0.0f) ImGui::SetNextItemWidth(-row.spare);
  ImGui::BeginDisabled(!row.whyOff.empty());
  const bool moved =
      slide((std::string("##") + row.name).c_str(), row.whyOff.empty() ? row.format : row.whyOff.c_str());
  ImGui::EndDisabled();
  if (row.tip) tip(row.tip);
  return moved;
}

}  // namespace

ImGuiStyle themeStyle() {
  ImGuiStyle style;
  style.WindowRounding = 4.0f;
  style.WindowBorderSize = 0.0f;
  style.PopupBorderSize = 1.0f;
  style.FrameRounding = 3.0f;
  style.GrabRounding = 2.0f;
  style.GrabMinSize = 6.0f;
  style.ScrollbarSize = 12.0f;
  style.ItemSpacing = {7.0f, 5.0f};
  style.FramePadding = {6.0f, 3.0f};
  style.DisabledAlpha = 0.5f;
  ImGui::StyleColorsDark(&style);
  const auto set = [&](ImGuiCol color, const ImVec4& value) { style.Colors[color] = value; };
  set(ImGuiCol_Text, grey(0.94f));
  set(ImGuiCol_TextDisabled, grey(0.66f));
  set(ImGuiCol_WindowBg, grey(0.15f));
  set(ImGuiCol_PopupBg, grey(0.11f));
  set(ImGuiCol_Border, grey(0.30f));
  set(ImGuiCol_FrameBg, grey(0.23f));
  set(ImGuiCol_FrameBgHovered, grey(0.28f));
  set(ImGuiCol_FrameBgActive, grey(0.31f));
  set(ImGuiCol_TitleBg, grey(0.11f));
  set(ImGuiCol_TitleBgActive, grey(0.11f));
  set(ImGuiCol_CheckMark, grey(0.94f));
  // Text is read across the grab.
  set(ImGuiCol_SliderGrab, kAccent);
  set(ImGuiCol_SliderGrabActive, kAccentLit);
  set(ImGuiCol_Button, grey(0.28f));
  set(ImGuiCol_ButtonHovered, grey(0.33f));
  set(ImGuiCol_ButtonActive, kAccent);
  set(ImGuiCol_Header, grey(0.20f));
  set(ImGuiCol_HeaderHovered, grey(0.26f));
  set(ImGuiCol_HeaderActive, kAccent);
  set(ImGuiCol_Separator, grey(0.30f));
  set(ImGuiCol_ScrollbarBg, grey(0.12f));
  set(ImGuiCol_ScrollbarGrab, grey(0.32f));
  set(ImGuiCol_ScrollbarGrabHovered, grey(0.40f));
  set(ImGuiCol_ScrollbarGrabActive, grey(0.46f));
  set(ImGuiCol_PlotHistogram, kAccent);
  set(ImGuiCol_TextSelectedBg, kAccent);
  set(ImGuiCol_TableRowBgAlt, grey(1.0f, 0.04f));
  set(ImGuiCol_ModalWindowDimBg, grey(0.0f, 0.45f));
  return style;
}

std::map<std::string, std::array<float, 4>>& places() {
  static std::map<std::string, std::array<float, 4>> all;
  return all;
}

void addWindowPlace(const std::string& name) { add(name, ImGui::GetWindowPos(), ImGui::GetWindowSize()); }

bool placed(const std::string& name, bool result) {
  add(name, ImGui::GetItemRectMin(), ImGui::GetItemRectSize());
  return result;
}

void dimAtEnd(const std::string& text) {
  const float start = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x;
  const float room = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + ImGui::GetStyle().ItemSpacing.x;
  if (room <= start)
    ImGui::SameLine(start);
  else
    ImGui::SetCursorPosX(start);
  ImGui::TextDisabled("%s", text.c_str());
}

void label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * kLabelWidth);
  ImGui::SetNextItemWidth(-1.0f);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  places()[text] = {at.x, at.y, ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight()};
}

bool slider(const Row& row, double& value) {
  return drawRow(row, [&](const char* id, const char* format) {
    float shown = float(value);
    const bool moved = ImGui::SliderFloat(id, &shown, row.least, row.most, format, row.flags);
    if (moved) value = shown;
    return moved;
  });
}

bool slider(const Row& row, std::optional<double>& value) {
  double shown = value.value_or(0.0);
  const bool moved = slider(row, shown);
  if (moved) value = shown;
  return moved;
}

bool slider(const Row& row, int& value) {
  return drawRow(row, [&](const char* id, const char* format) {
    return ImGui::SliderInt(id, &value, int(row.least), int(row.most), format, row.flags);
  });
}

bool editColor(const char* id, glm::vec3& linear, float most, bool numbers, float spare) {
  const glm::vec3 before = linear;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const ImGuiColorEditFlags range = most > 1.0f ? ImGuiColorEditFlags_HDR : 0;
  ImGui::PushID(id);
  if (numbers) {
    ImGui::SetNextItemWidth(-(ImGui::GetFrameHeight() + gap + spare));
    ImGui::ColorEdit3("##numbers", &linear.x,
                      range | ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoLabel |
                          ImGuiColorEditFlags_NoSmallPreview | ImGuiColorEditFlags_NoPicker |
                          ImGuiColorEditFlags_NoOptions);
    ImGui::SameLine(0.0f, gap);
  }
  glm::vec3 shown;
  for (int c = 0; c < 3; ++c) shown[c] = float(encodeSrgb(linear[c]));
  const glm::vec3 was = shown;
  ImGui::ColorEdit3("##square", &shown.x, range | ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel);
  for (int c = 0; c < 3; ++c) {
    if (shown[c] != was[c]) linear[c] = float(decodeSrgb(shown[c]));
    linear[c] = std::clamp(linear[c], 0.0f, most);  // any number may be typed
  }
  ImGui::PopID();
  return linear != before;
}

std::optional<size_t> choose(const char* name, size_t count, std::optional<size_t> current,
                             const std::function<std::string(size_t)>& nameOf, ImGuiComboFlags flags) {
  label(name);
  std::optional<size_t> chosen;
  const std::string shown = current && *current < count ? nameOf(*current) : "none";
  if (!ImGui::BeginCombo((std::string("##") + name).c_str(), shown.c_str(), flags)) return chosen;
  for (size_t i = 0; i < count; ++i) {
    if (ImGui::Selectable(nameOf(i).c_str(), i == current)) chosen = i;
  }
  ImGui::EndCombo();
  return chosen;
}

void tip(const std::string& text) {
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
  addWindowPlace("tip");
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

bool button(const char* text) { return placed(text, ImGui::Button(text)); }

bool closeButton(const std::string& place) {
  const bool pressed = placed(place, ImGui::SmallButton("x"));
  ImGui::SameLine();
  return pressed;
}

void commandButtons(ViewFacts& facts, std::initializer_list<CommandButton> buttons) {
  for (const CommandButton& one : buttons) {
    if (&one != buttons.begin()) stayOnLineFor(one.text);
    if (button(one.text)) facts.commands.push_back({one.command, one.argument});
  }
}

bool box(const char* text, bool& on, const std::string& whyOff, const std::string& key,
         const std::string& sentence) {
  ImGui::BeginDisabled(!whyOff.empty());
  const bool changed = placed(text, ImGui::Checkbox(text, &on));
  ImGui::EndDisabled();
  if (!sentence.empty()) tip(sentence);
  if (const std::string& end = whyOff.empty() ? key : whyOff; !end.empty()) dimAtEnd(end);
  return changed;
}

void drawRecentFiles(ViewFacts& facts) {
  // As they were when the list was opened: the disk is not asked in each frame.
  static struct {
    std::vector<std::filesystem::path> files;
    std::vector<bool> gone;
    int frame = -1;  ///< in which the list was drawn last
  } seen;
  const std::vector<std::filesystem::path>& files = facts.remembered.recent;
  const int frame = ImGui::GetFrameCount();
  if (frame > seen.frame + 1 || files != seen.files) {
    seen.files = files;
    seen.gone.clear();
    for (const std::filesystem::path& file : files) {
      std::error_code error;
      seen.gone.push_back(!std::filesystem::exists(file, error));
    }
  }
  seen.frame = frame;
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string text =
        shownText(files[i].filename().string(), kMostNameCharacters) + "##" + std::to_string(i);
    ImGui::BeginDisabled(seen.gone[i]);
    if (placed("recent " + std::to_string(i), ImGui::Selectable(text.c_str())))
      facts.commands.push_back({.command = Command::OpenFile, .file = files[i]});
    ImGui::EndDisabled();
    tip(shownText(files[i].string(), kMostLineCharacters) + (seen.gone[i] ? " is gone" : ""));
  }
}

}  // namespace fragtrace
