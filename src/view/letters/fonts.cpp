// SPDX-License-Identifier: MIT
#include "view/letters/fonts.h"

#include <fontconfig/fontconfig.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace fragtrace {

namespace {

// Where systems keep a legible font.
constexpr std::array kFonts{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                            "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                            "/usr/share/fonts/TTF/DejaVuSans.ttf"};
constexpr float kBuiltInSize = 13.0f;  // the only one that the pixels of Dear ImGui's font are drawn for
constexpr size_t kMostMerged = 8;

template <auto destroy>
struct Destroy {
  void operator()(auto* object) const { destroy(object); }
};
using CharSet = std::unique_ptr<FcCharSet, Destroy<FcCharSetDestroy>>;
using Pattern = std::unique_ptr<FcPattern, Destroy<FcPatternDestroy>>;
using FontSet = std::unique_ptr<FcFontSet, Destroy<FcFontSetDestroy>>;

struct FontFile {
  std::string path;
  int index = 0;  ///< in a collection
};

/// The characters of the ranges that the font lacks.
CharSet missing(const ImFont& font, const ImVector<ImWchar>& ranges) {
  CharSet characters(FcCharSetCreate());
  for (int i = 0; ranges[i] != 0; i += 2) {
    for (unsigned int c = ranges[i]; c <= ranges[i + 1]; ++c) {
      if (!font.FindGlyphNoFallback(ImWchar(c))) FcCharSetAddChar(characters.get(), c);
    }
  }
  return characters;
}

/// Fonts of the system with outlines that Dear ImGui reads, which have the characters as far as one has them.
std::vector<FontFile> fontsWith(CharSet characters) {
  std::vector<FontFile> files;
  const Pattern wanted(FcPatternCreate());
  FcPatternAddCharSet(wanted.get(), FC_CHARSET, characters.get());
  FcPatternAddString(wanted.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
  FcConfigSubstitute(nullptr, wanted.get(), FcMatchPattern);
  FcDefaultSubstitute(wanted.get());
  FcResult result = FcResultMatch;
  const FontSet sorted(FcFontSort(nullptr, wanted.get(), FcFalse, nullptr, &result));
  for (int i = 0; sorted && i < sorted->nfont && files.size() < kMostMerged; ++i) {
    FcPattern* font = sorted->fonts[i];
    const auto text = [&](const char* property) {
      FcChar8* value = nullptr;
      const bool is = FcPatternGetString(font, property, 0, &value) == FcResultMatch;
      return std::string(is ? reinterpret_cast<const char*>(value) : "");
    };
    FontFile file{text(FC_FILE)};
    FcBool colored = FcFalse;
    FcCharSet* has = nullptr;
    FcPatternGetInteger(font, FC_INDEX, 0, &file.index);
    file.index &= 0xffff;  // above, one of the shapes of a variable font
    FcPatternGetBool(font, FC_COLOR, 0, &colored);
    const std::string format = text(FC_FONTFORMAT);
    std::error_code error;
    if ((format != "TrueType" && format != "CFF") || colored != FcFalse ||
        FcPatternGetCharSet(font, FC_CHARSET, 0, &has) != FcResultMatch ||
        FcCharSetIntersectCount(has, characters.get()) == 0 || !std::filesystem::exists(file.path, error))
      continue;
    characters.reset(FcCharSetSubtract(characters.get(), has));
    files.push_back(std::move(file));
  }
  return files;
}

}  // namespace

ImFont* buildFont(ImFontAtlas& atlas, float pixels, ImFontGlyphRangesBuilder characters, ImFontConfig look) {
  characters.AddRanges(atlas.GetGlyphRangesDefault());
  ImVector<ImWchar> ranges;
  characters.BuildRanges(&ranges);
  atlas.Clear();
  std::error_code error;
  const auto* file =
      std::ranges::find_if(kFonts, [&](const char* path) { return std::filesystem::exists(path, error); });
  look.SizePixels = kBuiltInSize * std::max(1.0f, std::floor(pixels / kBuiltInSize));
  ImFont* font = file == kFonts.end() ? atlas.AddFontDefault(&look)
                                      : atlas.AddFontFromFileTTF(*file, pixels, &look, ranges.Data);
  atlas.Build();
  CharSet lacks = missing(*font, ranges);
  if (FcCharSetCount(lacks.get()) == 0) return font;
  look.MergeMode = true;
  for (const FontFile& other : fontsWith(std::move(lacks))) {
    look.FontNo = other.index;
    atlas.AddFontFromFileTTF(other.path.c_str(), pixels, &look, ranges.Data);
  }
  atlas.Build();
  return font;
}

}  // namespace fragtrace
