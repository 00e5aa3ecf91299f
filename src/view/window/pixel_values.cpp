// SPDX-License-Identifier: MIT
#include "view/window/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "view/picture/pixel_value.h"

namespace fragtrace {

namespace {

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

}  // namespace

std::optional<glm::dvec3> shownValue(const ViewFacts& facts, size_t side, bool difference,
                                     const glm::dvec2& place) {
  const auto value = radianceAt(facts.values[side], place);
  if (!value || !difference) return value;
  const auto other = radianceAt(facts.values[1], place);
  return other ? std::optional(glm::abs(*value - *other)) : std::nullopt;
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

bool showsPixelValues(const ViewState& state) {
  return std::exp2(state.magnifier.steps) >= double((kLines + 1.0f) * ImGui::GetFontSize());
}

void drawPixelValues(const ViewState& state, const ViewFacts& facts, const WindowLayout& layout) {
  if (!showsPixelValues(state)) return;
  const double factor = std::exp2(state.magnifier.steps);
  const bool difference = state.compares() && state.comparison == CompareMode::Difference;
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

}  // namespace fragtrace
