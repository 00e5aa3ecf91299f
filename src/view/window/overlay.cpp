// SPDX-License-Identifier: MIT
#include "view/window/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "view/window/widgets.h"

namespace fragtrace {

namespace {

constexpr float kBarWidth = 2.0f;
constexpr float kHandleRadius = 7.0f;
constexpr float kProgressWidth = 320.0f;
constexpr float kSheetWidth = 980.0f;
constexpr float kTwoColumns = 760.0f;
/// A label that may be longer than its place.
constexpr ImGuiWindowFlags kPageFlags = kLabelFlags & ~ImGuiWindowFlags_NoScrollbar;
const ImVec4 kRed{0.55f, 0.08f, 0.06f, 0.94f};

ImVec2 sizeOf(const WindowLayout& layout) { return {float(layout.picture.x), float(layout.picture.y)}; }

void drawBar(const ViewState& state, const WindowLayout& layout) {
  const ImVec2 picture = sizeOf(layout);
  const float x = std::round(float(state.bar) * picture.x);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImU32 color = IM_COL32(255, 255, 255, 220);
  list.AddLine({x, 0.0f}, {x, picture.y}, color, kBarWidth * layout.scale);
  list.AddCircleFilled({x, 0.5f * picture.y}, kHandleRadius * layout.scale, color);
}

/// The place of a side's picture, and the part of it that is seen.
struct SidePlace {
  ImVec2 corner;
  ImVec2 size;
  float from = 0.0f;  ///< pixels from the left of the window
  float to = 0.0f;
};

SidePlace placeOf(const ViewState& state, const WindowLayout& layout, size_t side) {
  const ImVec2 picture = sizeOf(layout);
  if (state.overview) {
    const glm::vec2 size(layout.picture / kCells);
    const glm::vec2 corner = size * glm::vec2(glm::ivec2(int(side) % kCells, int(side) / kCells));
    return {{corner.x, corner.y}, {size.x, size.y}, corner.x, corner.x + size.x};
  }
  const float bar = float(state.shownBar()) * picture.x;
  return {{0.0f, 0.0f}, picture, side == 0 ? 0.0f : bar, side == 0 ? bar : picture.x};
}

/// Boxes of the tree, each side's within its part.
void drawLines(const ViewState& state, const ViewFacts& facts, const WindowLayout& layout) {
  const glm::dvec2 center = state.magnifier.center;
  const double factor = std::exp2(state.magnifier.steps);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (size_t side = 0; side < (state.compares() ? 2u : state.tracedCount()); ++side) {
    const SidePlace p = placeOf(state, layout, side);
    list.PushClipRect({p.from, p.corner.y}, {p.to, p.corner.y + p.size.y});
    const auto at = [&](const glm::dvec2& place) {
      const glm::dvec2 part = 0.5 + ((glm::dvec2(0.5) + glm::dvec2(0.5, -0.5) * place) - center) * factor;
      return ImVec2(p.corner.x + float(part.x) * p.size.x, p.corner.y + float(part.y) * p.size.y);
    };
    for (const PictureLine& line : facts.lines[side])
      list.AddLine(at(line.from), at(line.to), IM_COL32(255, 194, 89, 255));
    list.PopClipRect();
  }
}

/// Says at the top right of a picture which one it is: the first of these texts that has room, or the last.
struct Label {
  std::vector<std::string> texts;
  ImVec2 topRight;     ///< corner of the picture
  float width = 0.0f;  ///< width of the picture
  bool chosen = false;
};

void drawLabel(const Label& label, const std::string& place, const WindowLayout& layout) {
  const float pad = 0.5f * layout.margin;
  const float room = label.width - 2 * (layout.margin + pad);
  if (room <= 0.0f) return;
  const auto fits = [&](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x <= room; };
  const auto found = std::ranges::find_if(label.texts, fits);
  const std::string& text = found == label.texts.end() ? label.texts.back() : *found;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float width = std::min(size.x, room);
  const ImVec2 from{label.topRight.x - width - 2 * pad - layout.margin, label.topRight.y + layout.margin};
  const ImVec2 to{label.topRight.x - layout.margin, from.y + size.y + 2 * pad};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(from, to,
                     ImGui::GetColorU32(label.chosen ? kAccent : ImGui::GetStyleColorVec4(ImGuiCol_WindowBg)),
                     3.0f * layout.scale);
  list.PushClipRect(from, {to.x - pad, to.y});
  list.AddText({from.x + pad, from.y + pad}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  list.PopClipRect();
  places()[place] = {from.x, from.y, to.x - from.x, to.y - from.y};
}

/// "3.5 ms"
std::string frameText(const SideStatistics& s) {
  return formatted(s.frameMs < 10.0 ? "%.1f ms" : "%.0f ms", s.frameMs);
}

/// ", 12 samples, 3.5 ms"
std::string costText(const SideStatistics& s) { return ", " + samplesText(s.samples) + ", " + frameText(s); }

void drawStageNames(const ViewState& state, const ViewFacts& facts, const WindowLayout& layout) {
  for (const StageRow& row : stageRows()) {
    if (!row.cumulative) continue;
    const auto side = size_t(row.stage);
    const SidePlace place = placeOf(state, layout, side);
    const std::string cost = costText(facts.statistics[side]);
    const std::string name = row.name;
    drawLabel({{row.label + cost, name + cost, name + ", " + frameText(facts.statistics[side]), name},
               {place.to, place.corner.y},
               place.size.x,
               side == state.shownSide()},
              "name " + std::string(row.name), layout);
  }
}

/// Names each half of the split view, at its top.
void drawSideNames(const ViewState& state, const ViewFacts& facts, const WindowLayout& layout) {
  const float right = float(layout.picture.x);
  const float bar = float(state.shownBar()) * right;
  const auto draw = [&](size_t side, float from, float to) {
    const RenderOptions& options = state.edit.sides[side];
    const DebugView view = options.output.debugView;
    const bool file = side == 1 && !state.reference.empty();
    const std::string name = std::string(side == 0 ? "A  " : "B  ") +
                             (file ? shownText(state.reference.filename().string(), kMostNameCharacters)
                              : view == DebugView::None ? presetName(options.stages)
                                                        : std::string(rowOf(view).label));
    Label label{{name}, {to, 0.0f}, to - from, state.edit.active == side};
    if (!file) label.texts.insert(label.texts.begin(), name + costText(facts.statistics[side]));
    drawLabel(label, side == 0 ? "name A" : "name B", layout);
  };
  if (state.comparison == CompareMode::Difference)
    return drawLabel({{"|A - B| x " + shortText(std::exp2(state.differenceStops))}, {right, 0.0f}, right},
                     "name difference", layout);
  if (bar > 0.0f) draw(0, 0.0f, bar);
  if (bar < right) draw(1, bar, right);
}

/// A picture that shows something other than light says what.
void drawViewName(const ViewState& state, const WindowLayout& layout) {
  const DebugView view = state.side().output.debugView;
  if (!state.scene || view == DebugView::None) return;
  const std::string name(rowOf(view).label);
  const float right = float(layout.picture.x);
  const std::string keys = keyOf(Command::NextDebugView, 1) + ", " + keyOf(Command::NextDebugView, -1);
  drawLabel({{name + "  (" + keys + ": others)", name}, {right, 0.0f}, right, true}, "name view", layout);
}

struct MessageLine {
  std::string text;
  float opacity = 1.0f;
};

/// The latest messages, the newest above.
std::vector<MessageLine> messageLines(const ViewState& state, const ViewFacts& facts, double now) {
  std::vector<MessageLine> lines;
  if (!facts.trace.note.empty()) lines.push_back({facts.trace.note});
  for (size_t i = facts.messages.size(); i-- > 0;) {
    const float opacity = float(opacityOf(facts.messages[i], now));
    if (opacity > 0.0f) lines.push_back({facts.messages[i].text, opacity});
  }
  if (facts.pick && facts.pick->end) lines.push_back({distanceText(facts.pick->point, *facts.pick->end)});
  if (facts.pick) {
    for (const std::string& line : pickLines(state, *facts.pick)) lines.push_back({line});
  }
  for (MessageLine& line : lines) line.text = shownText(line.text, kMostLineCharacters);
  return lines;
}

/// The box of these lines, which begin at `left` and are wrapped at `right`. Dear ImGui would fit a box only
/// in the next frame, for which a driver that compiles may let us wait.
ImVec2 messagesSize(const std::vector<MessageLine>& lines, float left, float right) {
  const ImGuiStyle& style = ImGui::GetStyle();
  ImVec2 size(0.0f, -style.ItemSpacing.y);
  for (const MessageLine& line : lines) {
    const ImVec2 text = ImGui::CalcTextSize(line.text.c_str(), nullptr, false, std::max(right - left, 1.0f));
    size = {std::max(size.x, text.x), size.y + text.y + style.ItemSpacing.y};
  }
  return {left + size.x + style.WindowPadding.x, size.y + 2 * style.WindowPadding.y};
}

/// The latest messages at the bottom left.
void drawMessages(const ViewState& state, ViewFacts& facts, const WindowLayout& layout, double now) {
  const std::vector<MessageLine> lines = messageLines(state, facts, now);
  if (lines.empty()) return;
  const bool closes = facts.pick || !std::isinf(secondsToFade(facts.messages, now));
  const ImGuiStyle& style = ImGui::GetStyle();
  const float button = ImGui::CalcTextSize("x").x + 2 * style.FramePadding.x + style.ItemSpacing.x;
  const float right = layout.messagesMost.x - style.WindowPadding.x - style.ScrollbarSize;
  const ImVec2 size = messagesSize(lines, style.WindowPadding.x + (closes ? button : 0.0f), right);
  ImGui::SetNextWindowPos({layout.margin, float(layout.picture.y) - layout.margin}, ImGuiCond_Always,
                          {0.0f, 1.0f});
  ImGui::SetNextWindowSize(
      {std::min(size.x, layout.messagesMost.x), std::min(size.y, layout.messagesMost.y)});
  ImGui::SetNextWindowBgAlpha(0.78f);
  if (ImGui::Begin("messages", nullptr, kPageFlags)) {
    const bool close = closes && closeButton("close messages");
    ImGui::BeginGroup();
    ImGui::PushTextWrapPos(right);
    for (const MessageLine& line : lines) {
      ImGui::PushStyleVar(ImGuiStyleVar_Alpha, line.opacity);
      ImGui::TextUnformatted(line.text.c_str());
      ImGui::PopStyleVar();
    }
    ImGui::PopTextWrapPos();
    ImGui::EndGroup();
    addWindowPlace("messages");
    if (close) {
      closeMessages(facts.messages);
      if (facts.pick) facts.commands.push_back({Command::Deselect});
    }
  }
  ImGui::End();
}

void drawError(ViewFacts& facts, const WindowLayout& layout) {
  const ImVec2 display = sizeOf(layout);
  ImGui::SetNextWindowPos({0.5f * display.x, 0.25f * display.y}, ImGuiCond_Always, {0.5f, 0.0f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {display.x - 2 * layout.margin, 0.6f * display.y});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, kRed);
  if (ImGui::Begin("error", nullptr, kPageFlags)) {
    if (closeButton("close error")) facts.errorClosed = true;
    drawText(withControls(facts.trace.error), kMostPageCharacters, 0.7f * display.x);
    addWindowPlace("error");
  }
  ImGui::End();
  ImGui::PopStyleColor();
}

/// Asks what becomes of numbers that are not saved, before the window closes.
void drawSaveQuestion(ViewFacts& facts, const WindowLayout& layout) {
  constexpr const char* kTitle = "save question";
  if (std::exchange(facts.asksToSave, false)) ImGui::OpenPopup(kTitle);
  const ImVec2 display = sizeOf(layout);
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(kTitle, nullptr,
                              ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                  ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoSavedSettings))
    return;
  ImGui::TextUnformatted("Numbers that were set are not saved");
  const size_t before = facts.commands.size();
  commandButtons(facts, {{"Save...", Command::SaveModel, 1}, {"Discard", Command::Quit, 1}});
  ImGui::SameLine();
  if (button("Cancel") || facts.commands.size() > before) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

void drawLoading(ViewFacts& facts, const WindowLayout& layout) {
  const LoadStatus& load = facts.trace.load;
  const ImVec2 display = sizeOf(layout);
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowBgAlpha(0.88f);
  if (ImGui::Begin("loading", nullptr, kLabelFlags)) {
    drawText("Loading " + shownText(load.name, kMostNameCharacters), kMostLineCharacters);
    const float width = std::min(kProgressWidth * layout.scale, display.x - 6 * layout.margin);
    ImGui::ProgressBar(float(load.fraction), {width, 0.0f}, load.step.c_str());
    commandButtons(facts, {{"Cancel", Command::CancelLoad}});
  }
  ImGui::End();
}

/// The choices of an empty window: drop a file, or take one that was shown before.
void drawWelcome(ViewFacts& facts, const WindowLayout& layout) {
  const ImVec2 display = sizeOf(layout);
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {display.x - 2 * layout.margin, display.y - 2 * layout.margin});
  if (ImGui::Begin("welcome", nullptr, kPageFlags)) {
    addWindowPlace("welcome");
    commandButtons(facts, {{"Open...", Command::Open}});
    ImGui::SameLine();
    ImGui::TextUnformatted("or drop a model here");
    ImGui::PushTextWrapPos(display.x - 4 * layout.margin);
    ImGui::TextDisabled(".gltf or .glb; with it, or later, an environment: .hdr, .exr or .pfm. H: help");
    ImGui::PopTextWrapPos();
    if (!facts.remembered.recent.empty()) {
      ImGui::Separator();
      ImGui::TextDisabled("Shown before");
      drawRecentFiles(facts);
    }
  }
  ImGui::End();
}

/// Returns the lines of the sheet that hold the text, in upper or lower case.
std::vector<SheetLine> foundLines(const std::string& text) {
  std::vector<SheetLine> found = sheetLines();
  std::erase_if(found, [&](const SheetLine& line) {
    return lowered(line.name + " " + line.sentence).find(lowered(text)) == std::string::npos;
  });
  return found;
}

/// Lines of the sheet below each other, in as many pairs of columns.
void drawSheetLines(const std::vector<SheetLine>& lines, size_t columns) {
  const size_t rows = (lines.size() + columns - 1) / columns;
  if (!ImGui::BeginTable("sheet", int(2 * columns),
                         ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg))
    return;
  for (size_t row = 0; row < rows; ++row) {
    ImGui::TableNextRow();
    for (size_t i = row; i < lines.size(); i += rows) {
      for (const std::string& text : {lines[i].name, lines[i].sentence}) {
        ImGui::TableNextColumn();
        drawText(text, kMostLineCharacters, 0.0f);
      }
    }
  }
  ImGui::EndTable();
}

void drawSheet(ViewState& state, ViewFacts& facts, const WindowLayout& layout) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  // Above the status bar.
  const float height = float(layout.picture.y) - 2 * layout.margin;
  const float width = std::min(kSheetWidth * layout.scale, display.x - 2 * layout.margin);
  ImGui::SetNextWindowPos({0.5f * display.x, layout.margin}, ImGuiCond_Always, {0.5f, 0.0f});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowBgAlpha(1.0f);
  if (ImGui::Begin("Keys and mouse", &state.sheet,
                   ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoSavedSettings)) {
    addWindowPlace("sheet");
    ImGui::SetNextItemWidth(-1.0f);
    placed("Search",
           ImGui::InputTextWithHint("##search", "Search", state.search.data(), state.search.size()));
    const std::vector<SheetLine> lines = foundLines(state.search.data());
    facts.sheetLines = lines.size();
    if (lines.empty()) ImGui::TextDisabled("nothing of that name");
    // The text field stays in place while the lines are scrolled.
    if (ImGui::BeginChild("lines")) drawSheetLines(lines, width >= kTwoColumns * layout.scale ? 2 : 1);
    ImGui::EndChild();
  }
  ImGui::End();
}

template <typename... Values>
void row(const char* name, const char* format, Values... values) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name);
  ImGui::TableNextColumn();
  ImGui::Text(format, values...);
}

/// Each step of a picture and the tracing thread's own work, in milliseconds. Software continues with the
/// steps after the trace while it is told more, so their own times are not known there.
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
    addWindowPlace(name);
    end = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
  }
  ImGui::End();
  return end;
}

constexpr float kLines = 3.0f;  // red, green, blue
constexpr std::array<ImU32, 3> kValueColors{IM_COL32(255, 150, 150, 255), IM_COL32(150, 240, 150, 255),
                                            IM_COL32(170, 190, 255, 255)};

/// Three lines in the middle of a pixel, on a dark ground.
void drawValue(ImDrawList& list, ImVec2 middle, const glm::dvec3& value) {
  const float line = ImGui::GetFontSize();
  std::array<std::string, 3> texts;
  float width = 0.0f;
  for (size_t c = 0; c < 3; ++c) {
    texts[c] = formatted("%.3g", value[int(c)]);
    width = std::max(width, ImGui::CalcTextSize(texts[c].c_str()).x);
  }
  const ImVec2 corner(std::round(middle.x - 0.5f * width), std::round(middle.y - 0.5f * kLines * line));
  list.AddRectFilled({corner.x - 2.0f, corner.y}, {corner.x + width + 2.0f, corner.y + kLines * line},
                     IM_COL32(0, 0, 0, 150));
  for (size_t c = 0; c < 3; ++c)
    list.AddText({corner.x, corner.y + float(c) * line}, kValueColors[c], texts[c].data());
}

/// The figures at the top left, of one side or of both below each other: what the picture shown has cost, and
/// how good it is.
void drawFigures(const ViewState& state, ViewFacts& facts, const WindowLayout& layout) {
  if (layout.figures == FigureDetail::None) return;
  // Below the names of the sides.
  float top = layout.margin + (state.edit.split ? ImGui::GetFontSize() + 2.0f * layout.margin : 0.0f);
  for (size_t side = 0; side < state.tracedCount(); ++side)
    top = drawSide(state, facts, side, {layout.margin, top}, layout) + layout.margin;
}

/// The linear value at a place: of a side, or its difference from the other; none if it is not known.
std::optional<glm::dvec3> shownValue(const ViewFacts& facts, size_t side, bool difference,
                                     const glm::dvec2& place) {
  const auto value = radianceAt(facts.values[side], place);
  if (!value || !difference) return value;
  const auto other = radianceAt(facts.values[1], place);
  return other ? std::optional(glm::abs(*value - *other)) : std::nullopt;
}

/// Pixels are enlarged enough for values in them.
bool showsPixelValues(const ViewState& state) {
  return std::exp2(state.magnifier.steps) >= double((kLines + 1.0f) * ImGui::GetFontSize());
}

/// Writes the linear red, green and blue of the pixels into them, if they are enlarged enough.
void drawPixelValues(const ViewState& state, const ViewFacts& facts, const WindowLayout& layout) {
  if (!showsPixelValues(state)) return;
  const double factor = std::exp2(state.magnifier.steps);
  const bool difference = state.showsDifference();
  const glm::dvec2 size(layout.picture);
  // The place is in parts of the picture, from its top left.
  const glm::dvec2 corner = magnifiedPlace(state, glm::dvec2(0.0));
  const glm::ivec2 first(corner * size);
  const glm::ivec2 last((corner + 1.0 / factor) * size);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect({0.0f, 0.0f}, {float(size.x), float(size.y)});
  for (int y = first.y; y <= std::min(last.y, layout.picture.y - 1); ++y) {
    for (int x = first.x; x <= std::min(last.x, layout.picture.x - 1); ++x) {
      const glm::dvec2 place = (glm::dvec2(x, y) + 0.5) / size;
      const glm::dvec2 shown = (place - corner) * factor;
      const size_t side = difference ? 0 : sideAt(state, shown);
      const auto value = shownValue(facts, side, difference, place);
      if (value) drawValue(list, ImVec2(float(shown.x * size.x), float(shown.y * size.y)), *value);
    }
  }
  list.PopClipRect();
}

constexpr float kProgressBarWidth = 150.0f;  // pixels at 96 dots an inch
constexpr float kGap = 18.0f;

/// Returns a word or two that say what the viewer is doing.
std::string activity(const ViewState& state, const ViewFacts& facts) {
  if (facts.trace.load.busy) return "loading";
  if (!state.scene) return "no scene";
  // The messages have all of it.
  if (!facts.trace.note.empty()) return facts.trace.note.substr(0, facts.trace.note.find_first_of(",("));
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

/// These follow where there is room next to the pixel.
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
  if (placed(std::string("stage ") + row.name, ImGui::Button(nameOf(row, naming).c_str())))
    facts.commands.push_back(invocationOf(control));
  ImGui::PopStyleColor(int(on) + int(!reason.empty()));
  const char* upTo = row.stage == Stage::Flat ? "" : "All stages up to ";
  tip(controlName(control) + ": " + upTo + row.label + ": " + row.sentence +
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
    commandButtons(facts, {{button.text, button.command}});
    if (lit) ImGui::PopStyleColor();
    ImGui::EndDisabled();
    const Control& control = *controlOf(button.command);
    tip(controlName(control) + ": " + control.sentence);
  }
}

/// Stages get labels if all buttons at the end still fit, names if the first two ranks do, else numbers.
Naming namingFor(float room) {
  if (widthOf(Naming::Label) + widthOf(int(kEndButtons.size())) <= room) return Naming::Label;
  return widthOf(Naming::Name) + widthOf(2) <= room ? Naming::Name : Naming::Number;
}

/// Begins a bar as wide as the window.
bool beginBar(const char* name, float top, float height, const WindowLayout& layout) {
  ImGui::SetNextWindowPos({0.0f, top});
  ImGui::SetNextWindowSize({ImGui::GetIO().DisplaySize.x, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(layout.margin, 0.0f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0f, 1.0f));
  const bool shown = ImGui::Begin(
      name, nullptr, (kLabelFlags & ~ImGuiWindowFlags_AlwaysAutoResize) | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar(3);
  if (shown) addWindowPlace(name);
  return shown;
}

/// The status bar below the picture: how good it is, how long it will take, and the pixel under the cursor.
/// Leaves out what has no room, the least important first.
void drawStatusBar(const ViewState& state, ViewFacts& facts, const WindowLayout& layout) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float top = float(layout.picture.y) + layout.stagesHeight;
  if (beginBar("status", top, display.y - top, layout)) {
    const bool known = state.scene.has_value();
    const ViewProgress progress = known ? progressOf(facts.statistics[state.shownSide()], state.options(),
                                                     1.0 / double(state.tracedCount()))
                                        : ViewProgress{};
    const float height = ImGui::GetTextLineHeight();
    const float line = std::max(0.5f * (display.y - top - height), 0.0f);
    ImGui::SetCursorPosY(line);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0.0f, 0.0f));
    const std::string word = activity(state, facts);
    ImGui::ProgressBar(float(facts.trace.load.busy ? facts.trace.load.fraction : progress.fraction),
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
}

/// The stages above it in the same way, each a click away, and what is wanted besides them at any time.
void drawStageBar(const ViewState& state, ViewFacts& facts, const WindowLayout& layout) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  if (beginBar("stages", float(layout.picture.y), layout.stagesHeight, layout)) {
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

}  // namespace

void drawOverlay(ViewState& state, ViewFacts& facts, const WindowLayout& layout, double now) {
  drawLines(state, facts, layout);
  drawPixelValues(state, facts, layout);
  if (state.compares() && state.comparison == CompareMode::Bar) drawBar(state, layout);
  if (state.compares()) drawSideNames(state, facts, layout);
  if (state.overview) drawStageNames(state, facts, layout);
  if (!state.compares() && !state.overview) drawViewName(state, layout);
  if (state.figures && state.scene && !state.overview) drawFigures(state, facts, layout);
  drawMessages(state, facts, layout, now);
  if (!state.scene && !facts.trace.load.busy) drawWelcome(facts, layout);
  if (!facts.trace.error.empty() && !facts.errorClosed) drawError(facts, layout);
  drawStatusBar(state, facts, layout);
  drawStageBar(state, facts, layout);
  if (state.sheet) drawSheet(state, facts, layout);
  if (facts.trace.load.busy) drawLoading(facts, layout);
  drawSaveQuestion(facts, layout);
}

PixelArea wantedArea(const ViewState& state, const ViewFacts& facts, size_t side, glm::ivec2 whole) {
  if (whole.x <= 0) return {};
  if (facts.wantsHistogram && side == state.shownSide()) return {{0, 0}, whole};
  const auto between = [&](const glm::dvec2& from, const glm::dvec2& to) {
    const glm::ivec2 corner = pixelAt(whole, from);
    return PixelArea{corner, pixelAt(whole, to) - corner + 1};
  };
  if (showsPixelValues(state)) {
    const glm::dvec2 corner = magnifiedPlace(state, glm::dvec2(0.0));
    return between(corner, corner + std::exp2(-state.magnifier.steps));
  }
  if (!facts.cursor || (state.overview && sideAt(state, *facts.cursor) != side)) return {};
  const glm::dvec2 place = magnifiedPlace(state, *facts.cursor + 0.5 / glm::dvec2(state.size));
  return between(place, place);
}

}  // namespace fragtrace
