// SPDX-License-Identifier: MIT
// The choice among the file's scenes and material variants.
#include "scene/parts.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

bool hasParts(const ViewState& state) {
  return state.scene->sceneNames.size() > 1 || !state.scene->materialVariants.empty();
}

void drawParts(const ViewState& state, ViewFacts& facts) {
  const ViewedScene& scene = *state.scene;
  const auto chooseFrom = [&](const char* name, const char* none, const std::vector<std::string>& names,
                              std::string SceneSelection::*part) {
    const std::string& current = scene.options.selection.*part;
    const auto nameOf = [&](size_t i) { return i == 0 ? none : partText(i - 1, names[i - 1]); };
    const std::optional<size_t> shown = current.empty() ? std::nullopt : findPart(current, names);
    const auto chosen = choose(facts.places, name, names.size() + 1, shown ? *shown + 1 : 0, nameOf);
    const std::string wanted = chosen.value_or(0) == 0 ? "" : std::to_string(*chosen - 1);
    if (!chosen || wanted == current) return;
    facts.commands.push_back({.command = Command::Load, .load = scene.options});
    facts.commands.back().load->selection.*part = wanted;
  };
  if (scene.sceneNames.size() > 1)
    chooseFrom("Scene", "the file's own choice", scene.sceneNames, &SceneSelection::scene);
  if (!scene.materialVariants.empty())
    chooseFrom("Variant", "none", scene.materialVariants, &SceneSelection::materialVariant);
}

}  // namespace fragtrace
