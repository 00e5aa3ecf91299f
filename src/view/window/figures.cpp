// SPDX-License-Identifier: MIT
#include "view/window/overlay.h"

#include <imgui.h>

#include <cstdio>
#include <string_view>

#include "base/text.h"
#include "view/window/draw/text.h"

namespace fragtrace {

namespace {

template <typename... Values>
void row(const char* name, const char* format, Values... values) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name);
  ImGui::TableNextColumn();
  ImGui::Text(format, values...);
}

/// Each step of a picture and the tracing thread's own work, in milliseconds. Software goes on with the steps
/// after the trace while it is told more, so their own times are not known there.
std::string passText(const PassTimes& times) {
  std::string text;
  double host = 0.0;
  const auto add = [&](std::string_view name, double ms) {
    text += (text.empty() ? "" : ", ") + std::string(name) + formatted(" %.1f", ms);
  };
  for (size_t pass = 0; pass < kPassNames.size(); ++pass) {
    if (times.wall[pass] >= 0.05) add(kPassNames[pass], times.wall[pass]);
    host += times.cpu[pass];
  }
  add("host", host);
  return text + " ms";
}

void drawCosts(const ViewState& state, const ViewFacts& facts, size_t side, const WindowLayout& layout) {
  const SideStatistics& s = facts.statistics[side];
  row("frame", "%.1f ms, 95th %.1f ms", s.frameMs, s.frameP95Ms);
  row("rays", "%.2f million/s", s.megaRaysPerSecond);
  ImGui::PushTextWrapPos(layout.figuresMost.x - 2 * ImGui::GetStyle().WindowPadding.x);
  row("steps", "%s", passText(s.passes).c_str());
  ImGui::PopTextWrapPos();
  if (s.filtered > 0.0) row("denoised", "%.0f %%, %.0f ms", 100.0 * s.filtered, s.filterMs);
  if (!state.edit.split) row("paths", "%.2f million/s", s.megaPathsPerSecond);
  const glm::ivec2 size = facts.pictureSize[side];
  row("picture", "%d x %d%s", size.x, size.y, s.copied ? ", copied" : "");
  if (state.edit.split || !state.scene) return;
  const SceneDescription& d = state.scene->description;
  if (d.spheres > 0)
    row("scene", "%zu triangles, %zu spheres", d.triangles, d.spheres);
  else
    row("scene", "%zu triangles", d.triangles);
  row("memory", "%.1f MB", double(s.deviceBytes) / 1e6);
}

/// In the split view only the compared values. Returns the lower end.
float drawSide(const ViewState& state, ViewFacts& facts, size_t side, ImVec2 place,
               const WindowLayout& layout) {
  float end = place.y;
  const SideStatistics& s = facts.statistics[side];
  const std::string name = "figures" + std::to_string(side);
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowSizeConstraints({0, 0}, {layout.figuresMost.x, layout.figuresMost.y});
  ImGui::SetNextWindowBgAlpha(0.62f);
  if (ImGui::Begin(name.c_str(), nullptr, kLabelFlags | ImGuiWindowFlags_NoInputs) &&
      ImGui::BeginTable("rows", 2, ImGuiTableFlags_SizingFixedFit)) {
    if (state.edit.split) row("side", "%s", side == 0 ? "A" : "B");
    row("samples", "%d, %.1f s%s", s.samples, s.seconds, s.resting ? ", done" : "");
    if (s.error < 0.0)
      row("error", "not yet known");
    else if (layout.figures == FigureDetail::Brief)
      row("error", "%.2f %%", 100.0 * s.error);
    else
      row("error", "%.2f %% (goal %.2f %%)", 100.0 * s.error, 100.0 * state.edit.shared.sampling.noise);
    if (layout.figures == FigureDetail::All) drawCosts(state, facts, side, layout);
    ImGui::EndTable();
    addWindowPlace(facts.places, name);
    end = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
  }
  ImGui::End();
  return end;
}

}  // namespace

void drawFigures(const ViewState& state, ViewFacts& facts, const WindowLayout& layout) {
  if (layout.figures == FigureDetail::None) return;
  // Below the names of the sides.
  float top = layout.margin + (state.edit.split ? ImGui::GetFontSize() + 2.0f * layout.margin : 0.0f);
  for (size_t side = 0; side < state.tracedCount(); ++side)
    top = drawSide(state, facts, side, {layout.margin, top}, layout) + layout.margin;
}

}  // namespace fragtrace
