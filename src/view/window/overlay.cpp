// SPDX-License-Identifier: MIT
#include "view/window/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fragtrace {

namespace {

constexpr float kBorder = 8.0f;
constexpr float kBarWidth = 2.0f;
constexpr float kHandleRadius = 7.0f;
constexpr ImGuiWindowFlags kLabelFlags =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
const ImVec4 kRed{0.55f, 0.08f, 0.06f, 0.94f};

std::string megabytes(size_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f MB", double(bytes) / 1e6);
  return text;
}

template <typename... Values>
void row(const char* name, const char* format, Values... values) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name);
  ImGui::TableNextColumn();
  ImGui::Text(format, values...);
}

/// The variant's parts, as many a line as fit.
void drawVariant(const std::string& variant, float width) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("variant");
  ImGui::TableNextColumn();
  std::string line;
  const auto flush = [&] {
    if (!line.empty()) ImGui::TextUnformatted(line.c_str());
    line.clear();
  };
  for (size_t at = 0; at < variant.size();) {
    const size_t end = std::min(variant.find('+', at), variant.size());
    const std::string part = variant.substr(at, end - at);
    std::string longer = line;
    longer.append(line.empty() ? "" : " ").append(part);
    const bool fits = line.empty() || ImGui::CalcTextSize(longer.c_str()).x <= width;
    if (!fits) flush();
    line = fits ? longer : part;
    at = end + 1;
  }
  flush();
}

/// Of the split view only what is compared. Returns where it ends.
float drawFigures(const ViewState& state, const ViewFacts& facts, size_t side, ImVec2 place, float scale) {
  float end = place.y;
  const SideStatistics& s = facts.statistics[side];
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowBgAlpha(0.62f);
  const std::string name = "figures" + std::to_string(side);
  if (ImGui::Begin(name.c_str(), nullptr, kLabelFlags | ImGuiWindowFlags_NoInputs) &&
      ImGui::BeginTable("rows", 2, ImGuiTableFlags_SizingFixedFit)) {
    if (state.split) row("side", "%s", side == 0 ? "left" : "right");
    row("samples", "%d, %.1f s%s", s.samples, s.seconds, s.resting ? ", done" : "");
    if (s.error >= 0.0)
      row("error", "%.2f %% (goal %.2f %%)", 100.0 * s.error, 100.0 * state.sides[side].noise);
    else
      row("error", "not yet known");
    row("frame", "%.1f ms, 95th %.1f ms", s.frameMs, s.frameP95Ms);
    row("rays", "%.2f million/s", s.megaRaysPerSecond);
    if (!state.split) row("paths", "%.2f million/s", s.megaPathsPerSecond);
    const glm::ivec2 size = facts.pictureSize[side];
    row("picture", "%d x %d", size.x, size.y);
    if (!state.split && state.scene) {
      const SceneDescription& d = state.scene->description;
      if (d.spheres > 0)
        row("scene", "%zu triangles, %zu spheres", d.triangles, d.spheres);
      else
        row("scene", "%zu triangles", d.triangles);
    }
    if (!state.split) {
      row("memory", "%s", megabytes(s.deviceBytes).c_str());
      drawVariant(s.variant, 190.0f * scale);
    }
    ImGui::EndTable();
    end = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
  }
  ImGui::End();
  return end;
}

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

/// The latest news at the bottom left, the newest below.
void drawNews(const ViewState& state, const ViewFacts& facts, float scale) {
  std::deque<std::string> lines = facts.messages;
  if (!facts.note.empty())
    lines.push_back(facts.note + (state.scene ? " (the last picture stays meanwhile)" : ""));
  if (lines.empty() && !facts.pick) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({kBorder * scale, display.y - kBorder * scale}, ImGuiCond_Always, {0.0f, 1.0f});
  ImGui::SetNextWindowBgAlpha(0.78f);
  if (ImGui::Begin("news", nullptr, kLabelFlags | ImGuiWindowFlags_NoInputs)) {
    ImGui::PushTextWrapPos(0.5f * display.x);
    if (facts.pick) {
      for (const std::string& line : facts.pick->lines) ImGui::TextUnformatted(line.c_str());
    }
    for (const std::string& line : lines) ImGui::TextUnformatted(line.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

void drawError(ViewFacts& facts, float scale) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.25f * display.y}, ImGuiCond_Always, {0.5f, 0.0f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {display.x - 2 * kBorder * scale, 0.6f * display.y});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, kRed);
  if (ImGui::Begin("error", nullptr, kLabelFlags)) {
    ImGui::PushTextWrapPos(0.7f * display.x);
    ImGui::TextUnformatted(facts.error.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
  ImGui::PopStyleColor();
}

bool drawLoading(const LoadStatus& load, float scale) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  bool cancel = false;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowBgAlpha(0.88f);
  if (ImGui::Begin("loading", nullptr, kLabelFlags)) {
    ImGui::Text("Loading %s", load.name.c_str());
    ImGui::ProgressBar(float(load.fraction), {320.0f * scale, 0.0f}, load.step.c_str());
    cancel = ImGui::Button("Cancel");
  }
  ImGui::End();
  return cancel;
}

void drawSheet(float scale) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float height = display.y - 4 * kBorder * scale;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(600.0f * scale, display.x - 2 * kBorder * scale), height});
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowBgAlpha(1.0f);
  if (ImGui::Begin("Keys and mouse", nullptr,
                   ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoSavedSettings) &&
      ImGui::BeginTable("sheet", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
    for (const SheetLine& line : sheetLines()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(line.name.c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(line.sentence.c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace

bool drawOverlay(ViewState& state, ViewFacts& facts, float scale) {
  drawLines(state, facts);
  if (state.split) drawBar(state, scale);
  const float margin = kBorder * scale;
  if (state.figures && state.scene) {
    const float end = drawFigures(state, facts, 0, {margin, margin}, scale);
    if (state.split) drawFigures(state, facts, 1, {margin, end + margin}, scale);
  }
  drawNews(state, facts, scale);
  if (!facts.error.empty()) drawError(facts, scale);
  if (state.sheet) drawSheet(scale);
  return facts.load.busy && drawLoading(facts.load, scale);
}

}  // namespace fragtrace
