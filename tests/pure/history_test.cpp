// SPDX-License-Identifier: MIT
#include "view/view_state.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

ViewState shownState() {
  ViewState state;
  ViewedScene scene;
  scene.options.scene = "a.gltf";
  scene.options.light.hdriFile = "sky.hdr";
  scene.bounds.include({0.0, 0.0, 0.0});
  scene.bounds.include({1.0, 1.0, 1.0});
  state.edit.shared.scene = "a.gltf";
  showScene(state, scene);
  return state;
}

TEST(History, GoesBackAndForth) {
  ViewState state = shownState();
  History history;
  restart(history, state);
  EXPECT_FALSE(undo(history, state));
  for (int i = 1; i <= 3; ++i) {
    state.edit.shared.output.exposure = i;
    record(history, state);
    record(history, state);  // nothing has changed
  }
  EXPECT_TRUE(undo(history, state));
  EXPECT_EQ(state.edit.shared.output.exposure, 2.0);
  EXPECT_TRUE(undo(history, state));
  EXPECT_TRUE(redo(history, state));
  EXPECT_EQ(state.edit.shared.output.exposure, 2.0);
  state.edit.shared.output.exposure = 7.0;
  record(history, state);
  EXPECT_FALSE(redo(history, state));  // another way was taken
  EXPECT_TRUE(undo(history, state));
  EXPECT_EQ(state.edit.shared.output.exposure, 2.0);
}

TEST(History, WholeTurnsAreNoSteps) {
  ViewState state = shownState();
  History history;
  restart(history, state);
  for (const double turn : {-360.0, 360.0}) {
    state.edit.shared.light.sky.sun.azimuth += turn;
    state.edit.shared.light.hdriRotationDegrees += turn;
    record(history, state);
    EXPECT_TRUE(history.past.empty());
  }
  state.edit.shared.light.sky.sun.azimuth += 1.0;
  record(history, state);
  EXPECT_EQ(history.past.size(), 1u);
}

TEST(History, NumbersThatTheFileHasByNowAreTakenBack) {
  const auto with = [](double value) { return std::vector<SetNumber>{{"/a", {value}}}; };
  ViewState state = shownState();
  History history;
  restart(history, state);
  const auto set = [&](std::vector<SetNumber> numbers) {
    state.edit.shared.selection.set = std::move(numbers);
    record(history, state);
  };
  set(with(2.0));
  set(with(3.0));
  // The file had 1, and has 2.
  const LightOptions before = state.edit.shared.light;
  state.edit.shared.light.studio = true;
  rebase(history, state, {{{"/a", {1.0}}, {"/a", {2.0}}}}, before);
  EXPECT_EQ(state.edit.shared.selection.set, with(3.0));
  record(history, state);
  ASSERT_EQ(history.past.size(), 2u);
  EXPECT_TRUE(undo(history, state));
  EXPECT_TRUE(state.edit.shared.selection.set.empty());
  EXPECT_TRUE(undo(history, state));
  EXPECT_EQ(state.edit.shared.selection.set, with(1.0));
  EXPECT_TRUE(history.now->shared.light.studio);
}

TEST(History, WhatWasNotRecordedIsAStepToo) {
  ViewState state = shownState();
  History history;
  restart(history, state);
  state.edit.pose.viewAngleDegrees = 30.0;
  EXPECT_TRUE(undo(history, state));
  EXPECT_EQ(state.edit.pose.viewAngleDegrees, 45.0);
  EXPECT_TRUE(redo(history, state));
  EXPECT_EQ(state.edit.pose.viewAngleDegrees, 30.0);
}

TEST(History, ASideKeepsWhatIsItsOwn) {
  ViewState state = shownState();
  History history;
  restart(history, state);
  apply(state, {Command::ToggleSplit});
  record(history, state);
  state.edit.active = 1;
  state.side().output.denoise = Denoise::Variance;
  record(history, state);
  EXPECT_TRUE(undo(history, state));
  EXPECT_EQ(state.edit.sides.at(1).output.denoise, Denoise::None);
  EXPECT_TRUE(undo(history, state));
  EXPECT_EQ(state.edit.sides.size(), 1u);
  EXPECT_TRUE(redo(history, state));
  EXPECT_TRUE(redo(history, state));
  EXPECT_EQ(state.edit.sides.at(0).output.denoise, Denoise::None);
  EXPECT_EQ(state.edit.sides.at(1).output.denoise, Denoise::Variance);
}

TEST(History, SceneLightAndTimeStay) {
  ViewState state = shownState();
  History history;
  restart(history, state);
  apply(state, {Command::ToggleSplit});
  record(history, state);
  state.edit.shared.selection.animationTime = 0.5;
  record(history, state);
  ASSERT_EQ(history.past.size(), 1u);
  EXPECT_TRUE(undo(history, state));
  EXPECT_FALSE(state.edit.split);
  EXPECT_EQ(state.edit.shared.scene, "a.gltf");
  EXPECT_EQ(state.edit.shared.light.hdriFile, "sky.hdr");
  EXPECT_EQ(state.edit.shared.selection.animationTime, 0.5);
  EXPECT_TRUE(redo(history, state));
  EXPECT_EQ(state.edit.shared.light.hdriFile, "sky.hdr");
}

TEST(History, AnAnimationThatHoldsTheCameraIsNoStep) {
  ViewState state = shownState();
  state.scene->animationNames = {"run"};
  state.scene->animationSeconds = {1.0};
  History history;
  restart(history, state);
  state.edit.shared.output.exposure = 1.0;
  record(history, state);
  EXPECT_TRUE(undo(history, state));
  showAnimation(state, 0, 0.5);
  EXPECT_TRUE(state.edit.posed);
  record(history, state);
  EXPECT_TRUE(history.past.empty());
  EXPECT_TRUE(redo(history, state));
  EXPECT_EQ(state.edit.shared.output.exposure, 1.0);
  EXPECT_TRUE(state.edit.posed);  // or it would be framed again
}

/// Changes the state as a newly loaded scene does.
void loadAs(ViewState& state, const char* environment, const char* variant) {
  ViewedScene scene = *state.scene;
  scene.options.light.hdriFile = environment;
  scene.options.light.backgroundBlur = 5.0;
  scene.options.selection.materialVariant = variant;
  showScene(state, scene);
}

TEST(History, LightAndVariantAreStepsOfTheirOwn) {
  ViewState state = shownState();
  History history;
  restart(history, state);
  state.edit.pose.viewAngleDegrees = 30.0;
  record(history, state);
  loadAs(state, "other.hdr", "red");
  record(history, state);
  ASSERT_EQ(history.past.size(), 2u);
  EXPECT_EQ(withLight(history, state.scene->options), state.scene->options);
  EXPECT_TRUE(undo(history, state));
  EXPECT_EQ(state.edit.pose.viewAngleDegrees, 30.0);
  // The window keeps showing this environment until the other one is loaded.
  EXPECT_EQ(state.edit.shared.light.hdriFile, "other.hdr");
  const RenderOptions wanted = withLight(history, state.scene->options);
  EXPECT_EQ(wanted.scene, "a.gltf");
  EXPECT_EQ(wanted.light.hdriFile, "sky.hdr");
  EXPECT_EQ(wanted.light.backgroundBlur, 0.0);
  EXPECT_EQ(wanted.selection.materialVariant, "");
  history.waits = true;
  record(history, state);
  EXPECT_EQ(history.future.size(), 1u);
  state.scene->options = wanted;
  showScene(state, *state.scene);
  history.waits = false;
  record(history, state);
  EXPECT_EQ(history.future.size(), 1u);
  EXPECT_TRUE(redo(history, state));
  EXPECT_EQ(withLight(history, state.scene->options).light.hdriFile, "other.hdr");
  EXPECT_EQ(withLight(history, state.scene->options).selection.materialVariant, "red");
}

TEST(History, AStepWhoseSceneCannotBeHadIsTakenBack) {
  ViewState state = shownState();
  History history;
  restart(history, state);
  for (const double angle : {30.0, 20.0}) {
    state.edit.pose.viewAngleDegrees = angle;
    record(history, state);
  }
  loadAs(state, "gone.hdr", "");
  record(history, state);
  EXPECT_TRUE(undo(history, state));
  state.scene->options = withLight(history, state.scene->options);
  showScene(state, *state.scene);
  EXPECT_TRUE(redo(history, state));
  history.waits = true;
  revert(history, state);
  record(history, state);
  EXPECT_EQ(history.past.size(), 2u);
  EXPECT_EQ(history.future.size(), 1u);
  EXPECT_TRUE(undo(history, state));
  EXPECT_EQ(state.edit.pose.viewAngleDegrees, 30.0);
  revert(history, state);  // nothing waits
  EXPECT_EQ(state.edit.pose.viewAngleDegrees, 30.0);
  history.waits = true;
  revert(history, state);
  EXPECT_EQ(state.edit.pose.viewAngleDegrees, 20.0);
}

TEST(History, WhatTheUserDidNotDoIsNoStep) {
  ViewState state = shownState();
  History history;
  restart(history, state);
  state.edit.split = true;
  ignoreChange(history, state);
  EXPECT_FALSE(undo(history, state));
  EXPECT_TRUE(state.edit.split);
}

TEST(History, NodesAreThoseOfTheFilesSceneUnderAnyLight) {
  ViewState state = shownState();
  loadAs(state, "other.hdr", "red");
  EXPECT_TRUE(sameNodes(state.edit.shared, shownState().edit.shared));
  RenderOptions other = state.edit.shared;
  other.selection.scene = "second";
  EXPECT_FALSE(sameNodes(other, state.edit.shared));
}

TEST(History, OldStepsAreForgotten) {
  ViewState state = shownState();
  History history;
  restart(history, state);
  for (size_t i = 1; i <= 2 * kMostSteps; ++i) {
    state.edit.shared.output.exposure = double(i);
    record(history, state);
  }
  size_t steps = 0;
  while (undo(history, state)) ++steps;
  EXPECT_EQ(steps, kMostSteps);
}

}  // namespace
}  // namespace fragtrace
