// SPDX-License-Identifier: MIT
#include <cmath>

#include "base/errors.h"
#include "options/option_row.h"
#include "options/row_makers.h"
#include "scene/volume/grid.h"

namespace fragtrace {

namespace {

constexpr double kMostExtinction = 1e6;

/// H[,BASE]
void chooseHeight(RenderOptions& o, const std::string& text) {
  const size_t comma = text.find(',');
  const bool hasBase = comma != std::string::npos;
  const std::optional<double> height = numberIn(text.substr(0, comma));
  const std::optional<double> base = hasBase ? numberIn(text.substr(comma + 1)) : std::optional(0.0);
  if (!height || !base || !std::isfinite(*height) || !std::isfinite(*base) || *height <= 0.0)
    throw UsageError("--fog-height: '" + text + "' is not a height above 0, or a height and a base");
  o.fog.height = height;
  o.fog.base = hasBase ? base : std::nullopt;
}

OptionRow heightRow() {
  OptionRow row = memberRow(
      "--fog-height",
      "make the fog thinner above the height BASE (Y, in metres; by default the bottom of the scene), by a "
      "factor of e every H metres",
      FRAGTRACE_MEMBER(fog.height), {.effect = Effect::Picture});
  row.examples = {"1.5", "0.30000001192092896,-2"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, chooseHeight, "H[,BASE]");
  };
  row.words = [](const RenderOptions& o) {
    const std::string base = o.fog.base ? "," + exactText(*o.fog.base) : "";
    return std::vector<std::string>{exactText(*o.fog.height) + base};
  };
  row.copy = [](RenderOptions& to, const RenderOptions& from) {
    to.fog.height = from.fog.height;
    to.fog.base = from.fog.base;
  };
  return row;
}

}  // namespace

std::vector<OptionRow> fogRows() {
  constexpr OptionTraits kDrawn{.effect = Effect::Picture};
  return {
      number<double>("--fog-density",
                     "fill a ball round the scene with fog, and say how dense it is: the extinction "
                     "coefficient, in 1/m; only stage gi has it",
                     FRAGTRACE_MEMBER(fog.density), {0.0, kMostExtinction},
                     {.effect = Effect::Picture, .renewal = Renewal::Program, .attribute = "fog_density"}),
      color("--fog-color", "the part of the light that the fog scatters (albedo)",
            FRAGTRACE_MEMBER(fog.color), 1.0, kDrawn),
      number<double>("--fog-anisotropy",
                     "mean cosine of the angle by which the fog scatters light: above 0 it goes on forward",
                     FRAGTRACE_MEMBER(fog.anisotropy), {-kMostAnisotropy, kMostAnisotropy}, kDrawn),
      heightRow(),
      limit<double>(
          "--fog-distance",
          "radius of the ball in metres, round the middle of the scene; by default 1.5 times that of "
          "the scene's own",
          FRAGTRACE_MEMBER(fog.distance), {1e-9, 1e12}, kDrawn),
  };
}

}  // namespace fragtrace
