// SPDX-License-Identifier: MIT
#include "base/errors.h"
#include "options/option_row.h"
#include "options/row_makers.h"

namespace fragtrace {

namespace {

/// FILE[:GRID]
void chooseFile(RenderOptions& o, const std::string& text) {
  const VolumeSource named = volumeFile(text);
  o.volume.file = named.file;
  o.volume.grid = named.grid;
  if (named.file.empty() || (named.grid && named.grid->empty()))
    throw UsageError("--volume: '" + text + "' is not FILE.nvdb or FILE.nvdb:GRID");
}

std::string textOf(const VolumeSource& v) { return v.file.string() + (v.grid ? ":" + *v.grid : ""); }

OptionRow fileRow() {
  OptionRow row = memberRow("--volume",
                            "grid of densities, such as a cloud or smoke, to place in the scene: a NanoVDB "
                            "file, and if it is not the grid "
                            "`density`, its name; only stage gi has it",
                            FRAGTRACE_MEMBER(volume.file),
                            {.effect = Effect::Picture, .renewal = Renewal::Scene, .attribute = "volume"});
  row.examples = {"it's.nvdb:heat", "cloud.nvdb"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, chooseFile, "FILE[:GRID]");
  };
  row.words = [](const RenderOptions& o) { return std::vector{textOf(o.volume)}; };
  row.value = [](const RenderOptions& o) { return AttributeValue(o.volume.file.filename().string()); };
  row.copy = [](RenderOptions& to, const RenderOptions& from) {
    to.volume.file = from.volume.file;
    to.volume.grid = from.volume.grid;
  };
  return row;
}

}  // namespace

std::vector<OptionRow> volumeRows() {
  constexpr OptionTraits kPlaced{.effect = Effect::Picture, .renewal = Renewal::Scene};
  const auto position = [](const std::vector<double>& v) { return glm::dvec3(v[0], v[1], v[2]); };
  return {
      fileRow(),
      numbers<double>(
          "--volume-position", "X,Y,Z, in metres: place of the origin of the grid's file",
          FRAGTRACE_MEMBER(volume.position), 3, position,
          [](const glm::dvec3& p) { return numbersText(p.x, p.y, p.z); }, {"1,-2.5,0"}, kPlaced),
      limit<double>("--volume-scale", "metres per unit of the grid's file; by default 1",
                    FRAGTRACE_MEMBER(volume.scale), {kLeastVolumeScale, kMostVolumeScale}, kPlaced),
      limit<double>("--volume-density", "extinction coefficient of a density of 1, in 1/m; by default 1",
                    FRAGTRACE_MEMBER(volume.density), {0.0, kMostVolumeFactor}, kPlaced),
      color("--volume-color",
            "the part of the light that the grid scatters (albedo), and does not absorb; by default 1,1,1",
            FRAGTRACE_MEMBER(volume.color), 1.0, kPlaced),
      limit<double>("--volume-anisotropy",
                    "mean cosine of the angle by which the grid scatters light: above 0 it goes on forward; "
                    "by default 0",
                    FRAGTRACE_MEMBER(volume.anisotropy), {-kMostAnisotropy, kMostAnisotropy}, kPlaced),
      limit<double>(
          "--volume-emission",
          "let the part of the grid that absorbs light (--volume-color) glow as a black body at the "
          "temperatures (kelvin) of the grid `temperature` of its file, times this factor; by default 0",
          FRAGTRACE_MEMBER(volume.emission), {0.0, kMostVolumeFactor}, kPlaced),
  };
}

}  // namespace fragtrace
