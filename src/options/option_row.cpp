// SPDX-License-Identifier: MIT
#include "options/option_row.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "options/help_rows.h"
#include "options/option_text.h"

namespace fragtrace {

namespace {

/// Copies those whose row `chosen` is true of.
template <typename Chosen>
void take(RenderOptions& options, const RenderOptions& from, const Chosen& chosen) {
  for (const OptionRow& row : optionRows()) {
    if (chosen(row)) row.copy(options, from);
  }
}

/// Sets those to the default.
template <typename Chosen>
void reset(RenderOptions& options, const Chosen& chosen) {
  static const RenderOptions standard;
  take(options, standard, chosen);
}

}  // namespace

std::span<const OptionRow> optionRows() {
  static const std::vector<OptionRow> rows = [] {
    std::vector<OptionRow> all;
    const auto add = [&](std::vector<OptionRow> part, const char* topic) {
      for (OptionRow& row : part) row.shown = helpOf(row.name, topic);
      std::ranges::move(part, std::back_inserter(all));
    };
    add(fileRows(), "Scene");
    add(cameraRows(), "Camera");
    add(samplingRows(), "Quality");
    add(lightRows(), "Light");
    add(skyRows(), "Light");
    add(fogRows(), "Look");
    add(volumeRows(), "Look");
    add(deviceRows(), "Device");
    add(inputRows(), "Scene");
    add(outputRows(), "Output");
    return all;
  }();
  return rows;
}

const OptionRow& rowOf(std::string_view name) {
  const auto rows = optionRows();
  const auto found =
      std::ranges::find(rows, name, [](const OptionRow& row) { return std::string_view(row.name); });
  if (found == rows.end()) throw std::logic_error("no option " + std::string(name));
  return *found;
}

void appendRow(std::string& text, const OptionRow& row, const RenderOptions& options) {
  if (row.isDefault(options)) return;
  const std::vector<std::string> words = row.words(options);
  if (words.empty()) text += (text.empty() ? "" : " ") + std::string(row.name);
  for (const std::string& word : words) appendOption(text, row.name, word);
}

RenderOptions withoutEffects(RenderOptions options, std::initializer_list<Effect> effects) {
  const auto chosen = [&](Effect effect) { return std::ranges::find(effects, effect) != effects.end(); };
  reset(options, [&](const OptionRow& row) { return chosen(row.traits.effect); });
  for (const StageRow& row : stageRows()) {
    if (chosen(row.effect)) options.stages.set(size_t(row.stage), row.standard);
  }
  return options;
}

RenderOptions programOptions(RenderOptions options) {
  reset(options, [](const OptionRow& row) { return row.traits.renewal == Renewal::None; });
  // A program has fog or has none; how dense it is depends on the draw.
  if (options.fog.density > 0.0) options.fog.density = 1.0;
  // The same is true of the shift of a lens.
  std::optional<glm::dvec2>& shift = options.camera.overrides.lensShift;
  if (shift) shift = *shift == glm::dvec2(0.0) ? std::nullopt : std::optional(glm::dvec2(1.0));
  return options;
}

Renewal renewalBetween(const RenderOptions& before, const RenderOptions& now) {
  const auto differ = [&](Renewal least) {
    const auto part = [&](RenderOptions options) {
      reset(options, [&](const OptionRow& row) { return row.traits.renewal < least; });
      return options;
    };
    return part(before) != part(now);
  };
  for (const Renewal renewal : {Renewal::Scene, Renewal::Pose, Renewal::Surfaces, Renewal::Surroundings}) {
    if (differ(renewal)) return renewal;
  }
  return programOptions(before) == programOptions(now) ? Renewal::None : Renewal::Program;
}

void takeStep(RenderOptions& options, const RenderOptions& from, Renewal step) {
  take(options, from, [&](const OptionRow& row) { return row.traits.renewal == step; });
}

void takePose(RenderOptions& options, const RenderOptions& from) {
  for (const Renewal step : {Renewal::Surfaces, Renewal::Pose}) takeStep(options, from, step);
}

bool differIn(Renewal step, const RenderOptions& a, const RenderOptions& b) {
  RenderOptions taken = a;
  takeStep(taken, b, step);
  return taken != a;
}

bool sameBesidePose(const RenderOptions& a, const RenderOptions& b) {
  RenderOptions posed = a;
  takePose(posed, b);
  return programOptions(posed) == programOptions(b);
}

}  // namespace fragtrace
