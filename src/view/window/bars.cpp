// SPDX-License-Identifier: MIT
#include <imgui.h>

#include <algorithm>
#include <array>
#include <string>

#include "base/text.h"
#include "view/pictures.h"
#include "view/shown_text.h"
#include "view/window/overlay.h"
#include "view/window/widgets.h"

namespace fragtrace {

namespace {

constexpr float kProgressBarWidth = 150.0f;  // pixels at 96 dots an inch
constexpr float kGap = 18.0f;

/// Returns a word or two that say what the viewer is doing.
std::string activity(const ViewState& state, const ViewFacts& facts) {
  if (facts.load.busy) return "loading";
  if (!state.scene) return "no scene";
  // The messages have all of it.
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
  if (s.error >= 0.0 && state.side().output.debugView == DebugView::None) {
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
  const bool difference = state.showsDifference();
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
                       {kProgressBarWidth * layout.scale, height}, word.c_str());
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
