// SPDX-License-Identifier: MIT
// The histogram of the radiance in the active side's picture.
#include <algorithm>
#include <array>

#include "base/text.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

namespace {

constexpr float kPlotHeight = 72.0f;  // pixels at 96 dots an inch
constexpr std::array<ImU32, 3> kPlotColors{IM_COL32(220, 70, 70, 150), IM_COL32(70, 190, 80, 150),
                                           IM_COL32(90, 120, 240, 150)};

/// Computed again only for another picture or exposure.
const Histogram& current(const ViewState& state, ViewFacts& facts) {
  const size_t side = state.shownSide();
  ShownHistogram& shown = facts.histogram;
  const double exposure = state.edit.shared.output.exposure.value_or(0.0);
  const PictureValues& values = facts.values[side];
  facts.wantsHistogram = true;
  const bool whole = values.whole.x > 0 && values.area.size == values.whole;
  const bool known = shown.picture == values.picture && shown.side == side && shown.exposure == exposure;
  if (whole && !known) shown = {histogramOf(values.image, exposure), values.picture, side, exposure};
  return shown.histogram;
}

void plot(const Histogram& histogram, ImVec2 corner, ImVec2 size) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  const float width = size.x / float(kHistogramBins);
  for (size_t channel = 0; channel < 3; ++channel) {
    for (size_t bin = 0; bin < kHistogramBins; ++bin) {
      const float share = histogram.shares[channel][bin] / std::max(histogram.highest, 1e-6f);
      const float top = corner.y + size.y * (1.0f - std::min(share, 1.0f));
      const float left = corner.x + width * float(bin);
      list.AddRectFilled({left, top}, {left + width, corner.y + size.y}, kPlotColors[channel]);
    }
  }
  // A radiance of 1, which is white without a tone map.
  const float white = corner.x + size.x * float(-kLowestStop / (kHighestStop - kLowestStop));
  list.AddLine({white, corner.y}, {white, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_Text));
}

}  // namespace

void drawHistogram(const ViewState& state, ViewFacts& facts) {
  const Histogram& histogram = current(state, facts);
  const float scale = ImGui::GetFontSize() / 14.0f;
  const ImVec2 size(ImGui::GetContentRegionAvail().x, kPlotHeight * scale);
  plot(histogram, ImGui::GetCursorScreenPos(), size);
  ImGui::Dummy(size);
  placed(facts.places, "histogram");
  tip(facts.places,
      formatted("radiance from 2^%g to 2^%g with the exposure; the line is at 1", kLowestStop, kHighestStop));
  ImGui::TextDisabled("mean %.3g   max %.3g   above 1: %.2g %%", histogram.mean, histogram.most,
                      100.0 * histogram.above);
}

}  // namespace fragtrace
