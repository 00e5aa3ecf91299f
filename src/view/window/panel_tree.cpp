// SPDX-License-Identifier: MIT
// The scene's nodes, which can be selected and hidden, and its materials.
#include <algorithm>

#include "view/window/draw/text.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

namespace {

constexpr float kMostRows = 12.0f;
constexpr int kDepthOpen = 2;  ///< rows above are open at first

/// Returns the facts about a node that follow its name in brackets.
std::string notesOf(const SceneNode& node) {
  std::string notes;
  if (node.light) notes += notes.empty() ? "light" : ", light";
  if (node.camera) notes += notes.empty() ? "camera" : ", camera";
  if (node.hiddenInFile) notes += notes.empty() ? "hidden in the file" : ", hidden in the file";
  return notes.empty() ? "" : "  (" + notes + ")";
}

/// Draws a row: a box that shows or hides the node, and its name, which selects it. Returns true if the row
/// is open.
bool drawNode(ViewState& state, ViewFacts& facts, size_t i, bool parentShown) {
  const std::vector<SceneNode>& nodes = state.scene->nodes;
  const SceneNode& node = nodes[i];
  const bool leaf = i + 1 == nodes.size() || nodes[i + 1].depth <= node.depth;
  ImGui::PushID(int(i));
  bool shown = !isHidden(state, i) && !node.hiddenInFile;
  ImGui::BeginDisabled(node.hiddenInFile || !parentShown);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0.0f, 0.0f));
  if (placed(facts.places, "show " + node.name, ImGui::Checkbox("##shown", &shown)))
    hideNode(state, i, !shown);
  ImGui::PopStyleVar();
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool selected = state.selectedNode == node.index;
  const bool open =
      ImGui::TreeNodeEx("##node",
                        ImGuiTreeNodeFlags_OpenOnArrow | ImGuiTreeNodeFlags_NoTreePushOnOpen |
                            (leaf ? ImGuiTreeNodeFlags_Leaf : 0) |
                            (node.depth < kDepthOpen ? ImGuiTreeNodeFlags_DefaultOpen : 0) |
                            (selected ? ImGuiTreeNodeFlags_Selected : 0),
                        "%s%s", shownText(node.name, kMostNameCharacters).c_str(), notesOf(node).c_str());
  if (ImGui::IsItemClicked() && !ImGui::IsItemToggledOpen())
    facts.commands.push_back({Command::SelectNode, int(node.index)});
  placed(facts.places, "node " + node.name, open);
  ImGui::PopID();
  return open;
}

void drawNodes(ViewState& state, ViewFacts& facts) {
  const std::vector<SceneNode>& nodes = state.scene->nodes;
  const float indent = ImGui::GetStyle().IndentSpacing;
  int deepest = nodes.empty() ? 0 : nodes[0].depth;  // depth of the deepest open row
  std::vector<bool> hiddenAt;                        // for each depth: true if the row above is hidden
  for (size_t i = 0; i < nodes.size(); ++i) {
    const int depth = nodes[i].depth;
    if (depth > deepest) continue;
    hiddenAt.resize(size_t(depth));
    const bool parentShown = std::ranges::none_of(hiddenAt, [](bool hidden) { return hidden; });
    hiddenAt.push_back(isHidden(state, i));
    const float in = indent * float(depth);
    if (in > 0.0f) ImGui::Indent(in);
    // Rows that are scrolled away take their room alone.
    const float height = ImGui::GetTextLineHeight();
    const ImVec2 row = ImGui::GetCursorScreenPos();
    const bool seen = ImGui::IsRectVisible(row, ImVec2(row.x + 1.0f, row.y + height));
    bool open = false;
    if (seen) {
      open = drawNode(state, facts, i, parentShown);
    } else {
      ImGui::PushID(int(i));
      open = ImGui::GetStateStorage()->GetInt(ImGui::GetID("##node"), depth < kDepthOpen ? 1 : 0) != 0;
      ImGui::PopID();
      ImGui::Dummy(ImVec2(1.0f, height));
    }
    if (in > 0.0f) ImGui::Unindent(in);
    deepest = open ? depth + 1 : depth;
  }
}

/// Begins a list that is as high as its rows, up to a limit.
bool beginList(const char* id, size_t rows, ImGuiWindowFlags flags = 0) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  return ImGui::BeginChild(id, ImVec2(0.0f, line * std::min(float(rows) + 0.5f, kMostRows)), false, flags);
}

}  // namespace

void drawTree(ViewState& state, ViewFacts& facts) {
  if (beginList("nodes", state.scene->nodes.size(), ImGuiWindowFlags_HorizontalScrollbar))
    drawNodes(state, facts);
  ImGui::EndChild();
  const auto list = [&](const char* name, const char* title, size_t count, auto draw) {
    const std::string id = std::string("##") + name;
    const bool open =
        ImGui::TreeNodeEx(id.c_str(), ImGuiTreeNodeFlags_NoTreePushOnOpen, "%s (%d)", title, int(count));
    if (!placed(facts.places, name, open)) return;
    if (beginList(name, size_t(kMostRows))) draw(state, facts.places);
    ImGui::EndChild();
  };
  list("materials", "Materials", state.scene->materials.size(), drawMaterials);
  if (!state.scene->lights.empty()) list("lights", "Lights", state.scene->lights.size(), drawLights);
}

}  // namespace fragtrace
