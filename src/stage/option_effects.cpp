// SPDX-License-Identifier: MIT
#include "stage/option_effects.h"

#include <algorithm>

namespace fragtrace {

namespace {

/// Sets those to the default whose row `chosen` is true of.
template <typename Chosen>
void reset(RenderOptions& options, const Chosen& chosen) {
  RenderOptions standard;
  forEachOption(options, [&](const auto& row, auto& value) {
    if (chosen(row)) value = std::invoke(row.member, standard);
  });
}

}  // namespace

RenderOptions withoutEffects(RenderOptions options, std::initializer_list<Effect> effects) {
  const auto chosen = [&](const auto& row) {
    return std::ranges::find(effects, row.effect) != effects.end();
  };
  reset(options, chosen);
  for (const StageRow& row : stageRows()) {
    if (chosen(row)) options.stages.set(size_t(row.stage), row.standard);
  }
  return options;
}

RenderOptions sceneOptions(RenderOptions options) {
  reset(options, [](const auto& row) { return row.renewal != Renewal::Scene; });
  return options;
}

RenderOptions programOptions(RenderOptions options) {
  reset(options, [](const auto& row) { return row.renewal == Renewal::None; });
  return options;
}

}  // namespace fragtrace
