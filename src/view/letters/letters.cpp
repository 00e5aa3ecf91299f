// SPDX-License-Identifier: MIT
#include "view/letters/letters.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "view/letters/fonts.h"

namespace fragtrace {

namespace {

constexpr float kFontSize = 14.0f;
constexpr std::string_view kCut = "...";

/// A font with the characters of one text, as a picture.
struct FontPicture {
  ImFontAtlas atlas;
  ImFont* font = nullptr;
  unsigned char* pixels = nullptr;
  int width = 0;
  int height = 0;
};

void load(FontPicture& picture, const std::string& text) {
  ImFontGlyphRangesBuilder characters;
  characters.AddText(text.data(), text.data() + text.size());
  ImFontConfig look;
  look.OversampleH = 1;
  look.PixelSnapH = true;
  picture.font = buildFont(picture.atlas, kFontSize, std::move(characters), look);
  picture.atlas.GetTexDataAsAlpha8(&picture.pixels, &picture.width, &picture.height);
}

/// The text in lines that are no wider. A word that is wider is cut.
std::vector<std::string_view> linesOf(const ImFont& font, const std::string& text, int width) {
  std::vector<std::string_view> lines;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    const char* next =
        std::min(std::find(at, end, '\n'), font.CalcWordWrapPositionA(1.0f, at, end, float(width)));
    next = std::max(next, at + 1);
    lines.emplace_back(at, next);
    at = next;
    while (at < end && (*at == ' ' || *at == '\n')) ++at;
  }
  return lines;
}

float widthOf(const ImFont& font, std::string_view text) {
  return font.CalcTextSizeA(font.FontSize, FLT_MAX, 0.0f, text.data(), text.data() + text.size()).x;
}

/// The line with dots at its end, as far as there is room for it before them.
std::string cutLine(const ImFont& font, std::string_view line, int width) {
  std::string cut(line);
  while (!cut.empty() && widthOf(font, cut + std::string(kCut)) > float(width)) {
    while (!cut.empty() && (cut.back() & 0xc0) == 0x80) cut.pop_back();
    if (!cut.empty()) cut.pop_back();
  }
  return cut + std::string(kCut);
}

void drawGlyph(const FontPicture& picture, const ImFontGlyph& glyph, float left, int top, Letters& letters) {
  const int fromX = int(std::lround(glyph.U0 * float(picture.width)));
  const int fromY = int(std::lround(glyph.V0 * float(picture.height)));
  const int wide = int(std::lround(glyph.X1 - glyph.X0)), high = int(std::lround(glyph.Y1 - glyph.Y0));
  for (int y = 0; y < high; ++y) {
    for (int x = 0; x < wide; ++x) {
      const int toX = int(std::lround(left + glyph.X0)) + x, toY = top + int(std::lround(glyph.Y0)) + y;
      if (toX < 0 || toY < 0 || toX >= letters.width || toY >= letters.height) continue;
      uint8_t& to = letters.coverage[size_t(toY) * size_t(letters.width) + size_t(toX)];
      to = std::max(to, picture.pixels[(fromY + y) * picture.width + fromX + x]);
    }
  }
}

void drawLine(const FontPicture& picture, std::string_view line, int top, Letters& letters) {
  float left = std::floor(0.5f * (float(letters.width) - widthOf(*picture.font, line)));
  const char* at = line.data();
  const char* const end = at + line.size();
  while (at < end) {
    unsigned int character = 0;
    at += std::max(1, ImTextCharFromUtf8(&character, at, end));
    const ImFontGlyph& glyph = *picture.font->FindGlyph(ImWchar(character));
    if (glyph.Visible) drawGlyph(picture, glyph, left, top, letters);
    left += glyph.AdvanceX;
  }
}

}  // namespace

extern "C" Letters fragtraceLetters(std::string_view given, int width, int mostLines) {
  const std::string text(given);
  FontPicture picture;
  load(picture, text);
  const ImFont& font = *picture.font;
  std::vector<std::string_view> lines = linesOf(font, text, width);
  std::string last;
  if (lines.size() > size_t(mostLines)) {
    lines.resize(size_t(mostLines));
    lines.back() = last = cutLine(font, lines.back(), width);
  }
  const int lineHeight = int(std::ceil(font.FontSize)) + 2;
  Letters letters{width, lineHeight * int(lines.size()), {}};
  letters.coverage.resize(size_t(letters.width) * size_t(letters.height));
  for (size_t i = 0; i < lines.size(); ++i) drawLine(picture, lines[i], int(i) * lineHeight, letters);
  return letters;
}

}  // namespace fragtrace
