// SPDX-License-Identifier: MIT
// The nodes of the scene that the viewer's user has hidden.
#include <algorithm>

#include "view/view_state.h"

namespace fragtrace {

namespace {

std::string pointerOf(const SceneNode& node) { return "/nodes/" + std::to_string(node.index); }

/// Returns true if `wanted` names the node. As in loading, an index counts only if no node has that name.
bool isNamed(const std::vector<SceneNode>& nodes, const SceneNode& node, const std::string& wanted) {
  if (wanted == node.name || wanted == pointerOf(node)) return true;
  return wanted == std::to_string(node.index) && std::ranges::count(nodes, wanted, &SceneNode::name) == 0;
}

/// The name, where no other node has it; else its JSON pointer.
std::string nameOf(const std::vector<SceneNode>& nodes, const SceneNode& node) {
  return std::ranges::count(nodes, node.name, &SceneNode::name) == 1 ? node.name : pointerOf(node);
}

}  // namespace

bool isHidden(const ViewState& state, size_t node) {
  const std::vector<SceneNode>& nodes = state.scene->nodes;
  return std::ranges::any_of(state.edit.shared.selection.hiddenNodes,
                             [&](const std::string& wanted) { return isNamed(nodes, nodes[node], wanted); });
}

void hideNode(ViewState& state, size_t node, bool hidden) {
  const std::vector<SceneNode>& nodes = state.scene->nodes;
  std::vector<std::string> names;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (i == node ? hidden : isHidden(state, i)) names.push_back(nameOf(nodes, nodes[i]));
  }
  SceneSelection& selection = state.edit.shared.selection;
  selection.hiddenNodes = names;
  state.scene->options.selection = selection;
  // A camera that frames the scene stays where it is.
  state.edit.posed = state.edit.posed || state.scene->cameras.empty();
}

}  // namespace fragtrace
