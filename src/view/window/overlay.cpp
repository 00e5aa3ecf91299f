// SPDX-License-Identifier: MIT
#include "view/window/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "view/window/figures.h"
#include "view/window/text.h"

namespace fragtrace {

namespace {

constexpr float kBarWidth = 2.0f;
constexpr float kHandleRadius = 7.0f;
constexpr float kProgressWidth = 320.0f;
constexpr float kSheetWidth = 600.0f;
/// A label that may be longer than its place.
constexpr ImGuiWindowFlags kPageFlags = kLabelFlags & ~ImGuiWindowFlags_NoScrollbar;
const ImVec4 kRed{0.55f, 0.08f, 0.06f, 0.94f};

void drawBar(const ViewState& state, float scale) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float x = std::round(float(state.bar) * display.x);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImU32 color = IM_COL32(255, 255, 255, 220);
  list.AddLine({x, 0.0f}, {x, display.y}, color, kBarWidth * scale);
  list.AddCircleFilled({x, 0.5f * display.y}, kHandleRadius * scale, color);
}

/// Boxes of the tree, each side's within its part.
void drawLines(const ViewState& state, const ViewFacts& facts) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float bar = state.split ? float(state.bar) * display.x : display.x;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (size_t side = 0; side < (state.split ? 2u : 1u); ++side) {
    list.PushClipRect({side == 0 ? 0.0f : bar, 0.0f}, {side == 0 ? bar : display.x, display.y});
    const auto at = [&](const glm::dvec2& place) {
      return ImVec2(float(0.5 + 0.5 * place.x) * display.x, float(0.5 - 0.5 * place.y) * display.y);
    };
    for (const PictureLine& line : facts.lines[side])
      list.AddLine(at(line.from), at(line.to), IM_COL32(255, 194, 89, 255));
    list.PopClipRect();
  }
}

/// Left of what is said next.
bool closeButton(Places& places, const std::string& name) {
  const bool pressed = ImGui::SmallButton("x");
  addItemPlace(places, "close " + name);
  ImGui::SameLine();
  return pressed;
}

void drawNewsLines(const ViewState& state, const ViewFacts& facts, double now) {
  if (!facts.note.empty())
    drawText(facts.note + (state.scene ? " (the last picture stays meanwhile)" : ""), kMostLineCharacters);
  for (auto m = facts.messages.rbegin(); m != facts.messages.rend(); ++m) {
    const float opacity = float(opacityOf(*m, now));
    if (opacity <= 0.0f) continue;
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, opacity);
    drawText(lineOf(*m), kMostLineCharacters);
    ImGui::PopStyleVar();
  }
  if (!facts.pick) return;
  for (const std::string& line : facts.pick->lines) drawText(line, kMostLineCharacters);
}

/// The latest news at the bottom left, the newest above.
void drawNews(const ViewState& state, ViewFacts& facts, const OverlayLayout& layout, double now) {
  const bool seen = !std::isinf(secondsToFade(facts.messages, now));
  if (facts.note.empty() && !seen && !facts.pick) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({layout.margin, display.y - layout.margin}, ImGuiCond_Always, {0.0f, 1.0f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {layout.newsMost.x, layout.newsMost.y});
  ImGui::SetNextWindowBgAlpha(0.78f);
  if (ImGui::Begin("news", nullptr, kPageFlags)) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const bool close = (seen || facts.pick) && closeButton(facts.places, "news");
    ImGui::BeginGroup();
    ImGui::PushTextWrapPos(layout.newsMost.x - style.WindowPadding.x - style.ScrollbarSize);
    drawNewsLines(state, facts, now);
    ImGui::PopTextWrapPos();
    ImGui::EndGroup();
    addWindowPlace(facts.places, "news");
    if (close) {
      closeMessages(facts.messages);
      facts.pick.reset();
    }
  }
  ImGui::End();
}

void drawError(ViewFacts& facts, const OverlayLayout& layout) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.25f * display.y}, ImGuiCond_Always, {0.5f, 0.0f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {display.x - 2 * layout.margin, 0.6f * display.y});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, kRed);
  if (ImGui::Begin("error", nullptr, kPageFlags)) {
    if (closeButton(facts.places, "error")) facts.errorClosed = true;
    ImGui::PushTextWrapPos(0.7f * display.x);
    drawText(facts.error, kMostPageCharacters);
    ImGui::PopTextWrapPos();
    addWindowPlace(facts.places, "error");
  }
  ImGui::End();
  ImGui::PopStyleColor();
}

bool drawLoading(const LoadStatus& load, const OverlayLayout& layout) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  bool cancel = false;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowBgAlpha(0.88f);
  if (ImGui::Begin("loading", nullptr, kLabelFlags)) {
    drawText("Loading " + shownText(load.name, kMostNameCharacters), kMostLineCharacters);
    const float width = std::min(kProgressWidth * layout.scale, display.x - 6 * layout.margin);
    ImGui::ProgressBar(float(load.fraction), {width, 0.0f}, load.step.c_str());
    cancel = ImGui::Button("Cancel");
  }
  ImGui::End();
  return cancel;
}

void drawSheet(ViewFacts& facts, const OverlayLayout& layout) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float height = display.y - 4 * layout.margin;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(kSheetWidth * layout.scale, display.x - 2 * layout.margin), height});
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowBgAlpha(1.0f);
  if (ImGui::Begin("Keys and mouse", nullptr,
                   ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoSavedSettings) &&
      ImGui::BeginTable("sheet", 2, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg)) {
    for (const SheetLine& line : sheetLines()) {
      ImGui::TableNextRow();
      for (const std::string& text : {line.name, line.sentence}) {
        ImGui::TableNextColumn();
        ImGui::PushTextWrapPos(0.0f);
        drawText(text, kMostLineCharacters);
        ImGui::PopTextWrapPos();
      }
    }
    ImGui::EndTable();
    addWindowPlace(facts.places, "sheet");
  }
  ImGui::End();
}

}  // namespace

bool drawOverlay(ViewState& state, ViewFacts& facts, const OverlayLayout& layout, double now) {
  drawLines(state, facts);
  if (state.split) drawBar(state, layout.scale);
  if (state.figures && state.scene) drawFigures(state, facts, layout);
  drawNews(state, facts, layout, now);
  if (!facts.error.empty() && !facts.errorClosed) drawError(facts, layout);
  if (state.sheet) drawSheet(facts, layout);
  return facts.load.busy && drawLoading(facts.load, layout);
}

}  // namespace fragtrace
