// SPDX-License-Identifier: MIT
// The choice among the file's scenes and material variants.
#include "scene/parts.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

namespace {

/// Draws a list of `none` and the parts of the file. Returns the one that was chosen, as the command line
/// names it; "" is `none`.
std::optional<std::string> choosePart(const char* id, const char* none, const std::vector<std::string>& names,
                                      const std::string& current) {
  const auto nameOf = [&](size_t i) { return partText(i, names[i]); };
  const size_t no = names.size();
  const size_t now = current.empty() ? no : findPart(current, names).value_or(no);
  std::optional<std::string> chosen;
  if (!ImGui::BeginCombo(id, now != no ? nameOf(now).c_str() : none)) return chosen;
  if (ImGui::Selectable(none, now == no)) chosen = "";
  for (size_t i = 0; i < names.size(); ++i) {
    if (ImGui::Selectable(nameOf(i).c_str(), now == i)) chosen = std::to_string(i);
  }
  ImGui::EndCombo();
  return chosen;
}

}  // namespace

bool hasParts(const ViewState& state) {
  return state.scene->sceneNames.size() > 1 || !state.scene->materialVariants.empty();
}

void drawParts(const ViewState& state, ViewFacts& facts) {
  const ViewedScene& scene = *state.scene;
  const auto choose = [&](const char* name, const char* id, const char* none,
                          const std::vector<std::string>& names, std::string SceneSelection::*part) {
    label(facts.places, name);
    const std::string& current = scene.options.selection.*part;
    const std::optional<std::string> chosen = choosePart(id, none, names, current);
    if (!chosen || *chosen == current) return;
    facts.commands.push_back({.command = Command::Load, .load = scene.options});
    facts.commands.back().load->selection.*part = *chosen;
  };
  if (scene.sceneNames.size() > 1)
    choose("Scene", "##scene", "the file's own choice", scene.sceneNames, &SceneSelection::scene);
  if (!scene.materialVariants.empty())
    choose("Variant", "##variant", "none", scene.materialVariants, &SceneSelection::materialVariant);
}

}  // namespace fragtrace
