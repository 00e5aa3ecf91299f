// SPDX-License-Identifier: MIT

#include <imgui.h>

#include <algorithm>

#include "base/text.h"
#include "view/picture/pixel_value.h"
#include "view/progress.h"
#include "view/shown_text.h"
#include "view/window/draw/text.h"
#include "view/window/overlay.h"

namespace fragtrace {

namespace {

constexpr float kProgressWidth = 150.0f;  // pixels at 96 dots an inch
constexpr float kGap = 18.0f;

/// Returns a word or two that say what the viewer is doing.
std::string activity(const ViewState& state, const ViewFacts& facts) {
  if (facts.load.busy) return "loading";
  if (!state.scene) return "no scene";
  // The news have all of it.
  if (!facts.note.empty()) return facts.note.substr(0, facts.note.find_first_of(",("));
  return progressText(facts.statistics[state.shownSide()], state.options());
}

/// These are left out last.
std::vector<std::string> firstTexts(const ViewState& state, const ViewFacts& facts) {
  const size_t side = state.shownSide();
  const SideStatistics& s = facts.statistics[side];
  std::vector<std::string> texts;
  const std::string name = state.compares() ? (side == 0 ? "A: " : "B: ") : "";
  texts.push_back(name + samplesText(s.samples) + " per pixel");
  // It is the error of light, which a debug view does not show.
  if (s.error >= 0.0 && state.side().debugView == DebugView::None) {
    const double noise = state.edit.shared.sampling.noise;
    texts.push_back(noise > 0.0 ? formatted("error %.2f %% of %.2f %%", 100.0 * s.error, 100.0 * noise)
                                : formatted("error %.2f %%", 100.0 * s.error));
  }
  if (facts.pick && facts.pick->end) texts.push_back(distanceText(facts.pick->point, *facts.pick->end));
  return texts;
}

/// These follow where there is room beside the pixel.
std::vector<std::string> moreTexts(const ViewState& state, const ViewFacts& facts,
                                   const ViewProgress& progress) {
  const size_t side = state.shownSide();
  const SideStatistics& s = facts.statistics[side];
  std::vector<std::string> texts;
  if (!s.resting && progress.seconds) texts.push_back(durationText(*progress.seconds) + " left");
  if (facts.picturesPerSecond > 0.0) texts.push_back(formatted("%.1f pictures/s", facts.picturesPerSecond));
  const glm::ivec2 size = facts.pictureSize[side];
  if (size.x <= 0) return texts;  // there is no picture yet
  texts.push_back(size == state.size
                      ? formatted("%d x %d", size.x, size.y)
                      : formatted("%d x %d of %d x %d", size.x, size.y, state.size.x, state.size.y));
  return texts;
}

/// The pixel under the cursor, of the picture at its full resolution, and what it holds.
std::string pixelText(const ViewState& state, const ViewFacts& facts) {
  if (!facts.cursor) return "";
  const bool difference = state.compares() && state.comparison == CompareMode::Difference;
  const size_t side = difference ? 0 : sideAt(state, *facts.cursor);
  if (side >= kMostSides) return "";
  // The middle of the pixel, since places of whole pixels are rounded.
  const glm::dvec2 place = magnifiedPlace(state, *facts.cursor + 0.5 / glm::dvec2(state.size));
  const glm::ivec2 pixel =
      glm::clamp(glm::ivec2(place * glm::dvec2(state.size)), glm::ivec2(0), state.size - 1);
  const auto value = shownValue(facts, side, difference, place);
  if (!value) return "";
  const char* name = !state.compares() ? "" : difference ? "|A - B| " : side == 0 ? "A " : "B ";
  return formatted("%s%d, %d: %.4g %.4g %.4g", name, pixel.x, pixel.y, value->x, value->y, value->z);
}

}  // namespace

void drawStatusBar(const ViewState& state, ViewFacts& facts, const WindowLayout& layout) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float top = float(layout.picture.y) + layout.stagesHeight;
  ImGui::SetNextWindowPos({0.0f, top});
  ImGui::SetNextWindowSize({display.x, display.y - top});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(layout.margin, 0.0f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0f, 1.0f));
  if (ImGui::Begin("status", nullptr,
                   (kLabelFlags & ~ImGuiWindowFlags_AlwaysAutoResize) | ImGuiWindowFlags_NoScrollWithMouse)) {
    addWindowPlace(facts.places, "status");
    const bool known = state.scene.has_value();
    const ViewProgress progress = known ? progressOf(facts.statistics[state.shownSide()], state.options(),
                                                     1.0 / double(state.tracedCount()))
                                        : ViewProgress{};
    const float height = ImGui::GetTextLineHeight();
    const float line = std::max(0.5f * (display.y - top - height), 0.0f);
    ImGui::SetCursorPosY(line);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0.0f, 0.0f));
    const std::string word = activity(state, facts);
    ImGui::ProgressBar(float(facts.load.busy ? facts.load.fraction : progress.fraction),
                       {kProgressWidth * layout.scale, height}, word.c_str());
    ImGui::PopStyleVar();
    float end = ImGui::GetItemRectMax().x;
    facts.status = word;
    const auto put = [&](const std::vector<std::string>& texts, float room) {
      for (const std::string& text : texts) {
        const float width = ImGui::CalcTextSize(text.c_str()).x;
        const float start = end + kGap * layout.scale;
        if (start + width > room) break;
        ImGui::SameLine(start);
        ImGui::TextUnformatted(text.c_str());
        facts.status += "; " + text;
        end = start + width;
      }
    };
    if (known) put(firstTexts(state, facts), display.x - layout.margin);
    std::string pixel = known ? pixelText(state, facts) : "";
    if (pixel.empty()) pixel = "H: help";
    const float start = display.x - layout.margin - ImGui::CalcTextSize(pixel.c_str()).x;
    const bool fits = start >= end + kGap * layout.scale;
    if (known)
      put(moreTexts(state, facts, progress), fits ? start - kGap * layout.scale : display.x - layout.margin);
    if (fits) {
      ImGui::SameLine(start);
      ImGui::TextUnformatted(pixel.c_str());
      facts.status += "; " + pixel;
    }
  }
  ImGui::End();
  ImGui::PopStyleVar(3);
}

}  // namespace fragtrace
