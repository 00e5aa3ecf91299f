// SPDX-License-Identifier: MIT
// Nodes that the viewer's user hides.
#include <gtest/gtest.h>

#include "view/view_state.h"

namespace fragtrace {
namespace {

ViewState withNodes() {
  ViewState state;
  ViewedScene scene;
  scene.options.scene = "a.gltf";
  scene.nodes = {{"root", 4, 0}, {"twin", 1, 1}, {"twin", 2, 1}, {"/nodes/3", 3, 0}};
  state.edit.shared.scene = "a.gltf";
  showScene(state, scene);
  return state;
}

using Names = std::vector<std::string>;

TEST(Visibility, NodesAreHiddenByTheirNameWhereThatIsTheirsAlone) {
  ViewState state = withNodes();
  apply(state, {Command::ToggleSplit});
  hideNode(state, 0, true);
  hideNode(state, 2, true);
  hideNode(state, 3, true);
  for (size_t side = 0; side < 2; ++side)
    EXPECT_EQ(optionsOf(state.edit, side).selection.hiddenNodes, (Names{"root", "/nodes/2", "/nodes/3"}));
  EXPECT_EQ(state.scene->options.selection.hiddenNodes.size(), 3u);
  EXPECT_FALSE(isHidden(state, 1));
  EXPECT_TRUE(isHidden(state, 2));
  hideNode(state, 2, false);
  EXPECT_EQ(state.edit.shared.selection.hiddenNodes, (Names{"root", "/nodes/3"}));
  EXPECT_TRUE(state.edit.posed);  // the camera stays, whatever is left to frame
}

TEST(Visibility, AnotherOfTheSameNameStaysHidden) {
  ViewState state = withNodes();
  state.edit.shared.selection.hiddenNodes = {"twin"};
  EXPECT_TRUE(isHidden(state, 1) && isHidden(state, 2));
  hideNode(state, 1, false);
  EXPECT_EQ(state.edit.shared.selection.hiddenNodes, Names{"/nodes/2"});
}

TEST(Visibility, AnIndexIsOneOnlyWhereNoNodeHasThatName) {
  ViewState state = withNodes();
  state.edit.shared.selection.hiddenNodes = {"2"};
  EXPECT_TRUE(isHidden(state, 2));
  state.scene->nodes[0].name = "2";
  EXPECT_TRUE(isHidden(state, 0));
  EXPECT_FALSE(isHidden(state, 2));
}

TEST(Visibility, IsUndone) {
  ViewState state = withNodes();
  History history;
  restart(history, state);
  hideNode(state, 0, true);
  record(history, state);
  EXPECT_TRUE(undo(history, state));
  EXPECT_TRUE(state.edit.shared.selection.hiddenNodes.empty());
  EXPECT_TRUE(state.scene->options.selection.hiddenNodes.empty());
  EXPECT_TRUE(redo(history, state));
  EXPECT_TRUE(isHidden(state, 0));
}

}  // namespace
}  // namespace fragtrace
