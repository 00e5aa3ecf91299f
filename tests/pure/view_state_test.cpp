// SPDX-License-Identifier: MIT
// Tests the changes that the viewer's controls make.
#include "view/view_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "base/errors.h"
#include "shader/variant.h"

namespace fragtrace {
namespace {

ViewedScene someScene() {
  ViewedScene scene;
  scene.options.scene = "some.gltf";
  scene.animationNames = {"walk", "run"};
  scene.animationSeconds = {2.0, std::nullopt};
  scene.bounds.include({-1.0, -1.0, -1.0});
  scene.bounds.include({1.0, 1.0, 1.0});
  Camera camera;
  camera.position = {0.0, 0.0, 5.0};
  scene.cameras = {camera, camera};
  scene.cameras[1].position = {5.0, 0.0, 5.0};
  scene.camera = camera;
  scene.present.set(size_t(Trait::Triangles));
  return scene;
}

ViewState someState() {
  ViewState state;
  state.edit.shared.scene = "some.gltf";
  showScene(state, someScene());
  return state;
}

/// A drag, a turn of the wheel and a moment of a held key at once.
const Invocation kMoved{.drag = {0.1, 0.2}, .notches = 1.0, .seconds = 0.1};

bool press(ViewState& state, Command command, int argument = 0) {
  EXPECT_NE(controlOf(command, argument), nullptr);
  return apply(state, {command, argument});
}

TEST(ViewState, NothingChangesThatCannotBeSeen) {
  for (const bool sheet : {false, true}) {
    ViewState state = sheet ? someState() : ViewState();
    state.sheet = sheet;
    const ViewState before = state;
    for (const Command command :
         {Command::Orbit, Command::Zoom, Command::ToggleStage, Command::Magnify, Command::ToggleSplit})
      for (const Control& control : controls()) {
        if (control.command == command) {
          EXPECT_FALSE(apply(state, invocationOf(control, kMoved)));
        }
      }
    EXPECT_TRUE(state.edit == before.edit && state.magnifier == before.magnifier);
    EXPECT_TRUE(isUsable(state, Command::Quit));
  }
}

TEST(ViewState, ASidesOptionsAreThoseThatItWasGiven) {
  RenderOptions o;
  o.scene = "some.gltf";
  o.stages = stagesUpTo(Stage::Phong);
  o.sampling.seed = 7;
  o.sampling.noise = 0.1;
  o.device.dispatch = Dispatch::Compute;
  o.output.debugView = DebugView::Visits;
  o.output.denoise = Denoise::Variance;
  o.output.exposure = 1.0;
  o.camera.pixelFilter = PixelFilter::Gaussian;
  o.light.selection = LightSelection::Power;
  o.light.reuse = LightReuse::Spatial;
  o.light.caustics = Caustics::Off;
  o.light.transparentGlass = true;
  Edit edit = editOf(o);
  edit.sides.emplace_back();
  EXPECT_EQ(optionsOf(edit, 0), o);
  EXPECT_EQ(optionsOf(edit, 1).stages, stagesUpTo(Stage::Gi));
  EXPECT_EQ(optionsOf(edit, 1).output.exposure, 1.0);
  edit = editOf(RenderOptions());
  edit.sides[0] = sideOf(o);
  edit.shared.sampling.noise = o.sampling.noise;
  EXPECT_EQ(sideOf(optionsOf(edit, 0)), sideOf(o));
  EXPECT_EQ(optionsOf(edit, 0).output.exposure, std::nullopt);
}

TEST(ViewState, AnOrthographicViewHasNoLens) {
  ViewState state = someState();
  state.edit.shared.camera.lens.fStop = 2.8;
  EXPECT_TRUE(tracedSides(state)[0].camera.lens.fStop);
  press(state, Command::OtherProjection);
  EXPECT_FALSE(tracedSides(state)[0].camera.lens.fStop);
}

TEST(ViewState, AReferenceIsSideB) {
  ViewState state = someState();
  press(state, Command::ToggleSplit);
  EXPECT_EQ(tracedSides(state).size(), 2u);
  state.reference = "reference.exr";
  EXPECT_EQ(tracedSides(state).size(), 1u);
  press(state, Command::FlipSides);
  press(state, Command::FlipSides);
  EXPECT_EQ(state.comparison, CompareMode::Right);
  EXPECT_EQ(state.edit.active, 0u);  // there are no settings of a file
}

TEST(ViewState, EveryControlChangesTheStateOrIsLeftToTheWindow) {
  const std::set<Command> ofTheWindow{
      Command::CenterOn,    Command::FocusOn,      Command::Inspect,   Command::Measure,    Command::Level,
      Command::CopyCommand, Command::PasteCommand, Command::Undo,      Command::Redo,       Command::Reload,
      Command::Open,        Command::SaveAs,       Command::SaveModel, Command::Screenshot, Command::WriteExr,
      Command::Fullscreen,  Command::Quit,         Command::NextModel};
  for (const Control& control : controls()) {
    ViewState state = someState();
    press(state, Command::ToggleSplit);
    press(state, Command::Magnify, 1);
    press(state, Command::FlipSides);
    const ViewState before = state;
    const bool done = apply(state, invocationOf(control, kMoved));
    const bool changed = state.edit != before.edit || state.panel != before.panel ||
                         state.figures != before.figures || state.sheet != before.sheet ||
                         state.playback.playing != before.playback.playing ||
                         state.comparison != before.comparison || state.flySpeed != before.flySpeed ||
                         !(state.magnifier == before.magnifier);
    // Some do nothing: no such camera, or the state is already the one wanted.
    const bool maybeNot = control.command == Command::SceneCamera ||
                          control.command == Command::ResetCamera || control.command == Command::StagesUpTo ||
                          control.command == Command::StandardView || control.command == Command::FrameAll;
    EXPECT_TRUE(changed || !done || maybeNot) << controlName(control);
    EXPECT_EQ(done, !ofTheWindow.contains(control.command)) << controlName(control);
  }
}

TEST(ViewState, AnAnimationGoesOnByTheTimeThatPassesAndBeginsAgainOrStops) {
  ViewState state = someState();
  const auto time = [&] { return state.edit.shared.selection.animationTime; };
  play(state, 1.0);
  EXPECT_FALSE(time());
  press(state, Command::PlayAnimation);
  play(state, 5.0);
  EXPECT_EQ(time(), 0.0);
  play(state, 5.5);
  EXPECT_EQ(time(), 0.5);
  state.playback.speed = 2.0;
  play(state, 6.0);
  EXPECT_EQ(time(), 1.5);
  play(state, 6.5);
  EXPECT_EQ(time(), 0.5);
  EXPECT_TRUE(state.playback.playing);
  state.playback.loops = false;
  play(state, 9.0);
  EXPECT_EQ(time(), 2.0);
  EXPECT_FALSE(state.playback.playing);
  press(state, Command::PlayAnimation);
  EXPECT_EQ(time(), 0.0);
  press(state, Command::NextAnimation, 1);
  EXPECT_EQ(shownAnimation(state), 1);
  EXPECT_EQ(animationLength(state), 1.0);
  state.edit.shared.selection.animation = "WALK";
  EXPECT_EQ(shownAnimation(state), 0);
  state.edit.shared.selection.animation = "RUN";
  EXPECT_EQ(shownAnimation(state), 1);
  state.edit.shared.selection.animation = "1";
  EXPECT_EQ(state.scene->options.selection, state.edit.shared.selection);
}

TEST(ViewState, UntilSomebodyMovesTheCameraIsThatOfTheOptions) {
  ViewState state = someState();
  EXPECT_EQ(tracedSides(state)[0].camera.overrides, CameraOverrides{});
  EXPECT_TRUE(drawsTheSame(tracedSides(state)[0], state.options()));
  apply(state, {.command = Command::Orbit, .drag = {0.1, 0.0}});
  EXPECT_EQ(tracedSides(state)[0].camera.overrides, overridesOf(state.edit.pose));
  press(state, Command::ResetCamera);
  EXPECT_EQ(tracedSides(state)[0].camera.overrides, CameraOverrides{});
}

TEST(ViewState, TheSceneCamerasAreThereByNumber) {
  ViewState state = someState();
  press(state, Command::SceneCamera, 1);
  EXPECT_EQ(tracedSides(state)[0].camera.index, 1);
  press(state, Command::SceneCamera, 7);
  EXPECT_EQ(tracedSides(state)[0].camera.index, 1);
  press(state, Command::NextCamera, 1);
  EXPECT_EQ(tracedSides(state)[0].camera.index, 0);
}

TEST(ViewState, OnlyWhatIsTracedIsDrawnAnew) {
  ViewState state = someState();
  const RenderOptions before = tracedSides(state)[0];
  for (const Command command : {Command::NextToneMap, Command::Exposure, Command::TogglePanel,
                                Command::ToggleHud, Command::ToggleSheet, Command::ToggleTreeBoxes}) {
    press(state, command, command == Command::Exposure ? 1 : 0);
  }
  press(state, Command::ToggleSheet);
  EXPECT_NE(state.edit.shared.output.exposure, before.output.exposure);
  EXPECT_TRUE(drawsTheSame(tracedSides(state)[0], before));
  press(state, Command::ToggleStage, int(Stage::Shadows));
  EXPECT_FALSE(drawsTheSame(tracedSides(state)[0], before));
}

TEST(ViewState, TheSplitViewBeginsWithTwoOfTheSameAndTogglesTheActiveOne) {
  ViewState state = someState();
  press(state, Command::ToggleSplit);
  ASSERT_EQ(tracedSides(state).size(), 2u);
  EXPECT_TRUE(drawsTheSame(tracedSides(state)[0], tracedSides(state)[1]));
  state.edit.active = 1;
  press(state, Command::ToggleStage, int(Stage::Shadows));
  EXPECT_TRUE(has(state.edit.sides[0].stages, Stage::Shadows));
  EXPECT_FALSE(has(state.edit.sides[1].stages, Stage::Shadows));
  apply(state, {.command = Command::Orbit, .drag = {0.1, 0.0}});
  EXPECT_EQ(tracedSides(state)[0].camera.overrides, tracedSides(state)[1].camera.overrides);
  press(state, Command::ToggleSplit);
  EXPECT_EQ(tracedSides(state).size(), 1u);
  EXPECT_EQ(state.edit.active, 0u);
}

TEST(ViewState, WhatTheSceneLacksIsGreyWithTheReason) {
  ViewState state = someState();
  EXPECT_EQ(whyGrey(state, Stage::Refraction), "no transmissive material");
  EXPECT_EQ(whyGrey(state, Stage::Gi), "");
  // The one light of such a scene casts shadows in gi alone.
  state.scene->present = {};
  state.scene->present.set(size_t(Trait::EnvironmentSampling));
  EXPECT_EQ(whyGrey(state, Stage::Shadows), "");
  state.side().stages = stagesUpTo(Stage::Shadows);
  EXPECT_EQ(whyGrey(state, Stage::Shadows), "before gi, the environment casts no shadows");
  EXPECT_EQ(whyNoFog(state), "only path traced");
  state.side().stages = stagesUpTo(Stage::Gi);
  EXPECT_EQ(whyNoFog(state), "");
  press(state, Command::ToggleGround);
  EXPECT_EQ(whyNoFog(state), "not with a shadow catcher");
}

TEST(ViewState, AReloadedSceneKeepsTheViewAndAnotherOneDoesNot) {
  ViewState state = someState();
  apply(state, {.command = Command::Orbit, .drag = {0.1, 0.0}});
  const CameraPose moved = state.edit.pose;
  showScene(state, someScene());
  EXPECT_EQ(state.edit.pose, moved);
  EXPECT_TRUE(state.edit.posed);
  ViewedScene other = someScene();
  other.options.scene = "other.gltf";
  showScene(state, other);
  EXPECT_FALSE(state.edit.posed);
  EXPECT_EQ(state.edit.shared.scene, "other.gltf");
}

TEST(ViewState, ThePanelClosesWithoutRoomAndOpensWithIt) {
  ViewState state = someState();
  fitPanel(state, true);
  EXPECT_TRUE(state.panel);
  fitPanel(state, false);
  EXPECT_FALSE(state.panel);
  fitPanel(state, true);
  EXPECT_TRUE(state.panel);
  fitPanel(state, false);
  press(state, Command::TogglePanel);  // over the picture, as it was asked for
  fitPanel(state, false);
  EXPECT_TRUE(state.panel);
  press(state, Command::TogglePanel);
  fitPanel(state, true);
  EXPECT_FALSE(state.panel);
}

TEST(ViewState, TheOverviewHasAPictureOfEachStage) {
  ViewState state = someState();
  press(state, Command::ToggleOverview);
  const std::vector<RenderOptions> sides = tracedSides(state);
  ASSERT_EQ(sides.size(), kMostSides);
  for (size_t i = 0; i < sides.size(); ++i)
    EXPECT_EQ(sides[i].stages, withStagesUpTo(state.options().stages, Stage(i))) << i;
  EXPECT_EQ(sideAt(state, {0.0, 0.0}), 0u);
  EXPECT_EQ(sideAt(state, {0.5, 0.5}), 4u);
  EXPECT_EQ(sideAt(state, {0.1, 0.9}), 6u);
  EXPECT_GE(sideAt(state, {0.5, 0.9}), kMostSides);
  EXPECT_NEAR(magnifiedPlace(state, {0.5, 0.4}).x, 0.5, 1e-9);
  EXPECT_NEAR(magnifiedPlace(state, {0.5, 0.4}).y, 0.2, 1e-9);
  apply(state, {Command::StagesUpTo, int(Stage::Shadows)});
  EXPECT_FALSE(state.overview);
  EXPECT_EQ(state.shownSide(), 0u);
  press(state, Command::ToggleOverview);
  EXPECT_EQ(state.shownSide(), size_t(Stage::Shadows));
  EXPECT_TRUE(press(state, Command::Close));
  EXPECT_EQ(tracedSides(state).size(), 1u);
}

TEST(ViewState, EscapeClosesTheSheetBeforeItQuits) {
  ViewState state = someState();
  press(state, Command::ToggleSheet);
  EXPECT_TRUE(press(state, Command::Close));
  EXPECT_FALSE(state.sheet);
  EXPECT_FALSE(press(state, Command::Close));
}

TEST(ViewState, EscapeEndsTheMagnifierBeforeItQuits) {
  ViewState state = someState();
  apply(state, {.command = Command::Magnify, .notches = 3.0, .place = {0.9, 0.1}});
  EXPECT_EQ(state.magnifier.steps, 1);
  EXPECT_TRUE(press(state, Command::Close));
  EXPECT_EQ(state.magnifier, Magnifier{});
  EXPECT_FALSE(press(state, Command::Close));
}

TEST(ViewState, TheMagnifierKeepsWhatIsUnderTheCursorAndStaysInThePicture) {
  ViewState state = someState();
  const glm::dvec2 cursor(0.6, 0.3);
  for (int i = 0; i < 10; ++i) {
    const glm::dvec2 before = magnifiedPlace(state, cursor);
    apply(state, {.command = Command::Magnify, .notches = 1.0, .place = cursor});
    EXPECT_NEAR(glm::distance(magnifiedPlace(state, cursor), before), 0.0, 1e-12);
  }
  EXPECT_EQ(state.magnifier.steps, 7);
  for (int i = 0; i < 200; ++i) apply(state, {.command = Command::MoveMagnifier, .drag = {-0.5, 0.5}});
  EXPECT_NEAR(magnifiedPlace(state, {1.0, 0.0}).x, 1.0, 1e-12);
  EXPECT_NEAR(magnifiedPlace(state, {1.0, 0.0}).y, 0.0, 1e-12);
  for (int i = 0; i < 10; ++i) apply(state, {.command = Command::Magnify, .notches = -1.0, .place = cursor});
  EXPECT_EQ(state.magnifier, Magnifier{});
}

TEST(ViewState, OneSideAloneIsShownAndChosen) {
  ViewState state = someState();
  press(state, Command::FlipSides);
  EXPECT_EQ(state.comparison, CompareMode::Bar);  // there is one side
  press(state, Command::ToggleSplit);
  EXPECT_EQ(sideAt(state, {0.4, 0.5}), 0u);
  EXPECT_EQ(sideAt(state, {0.6, 0.5}), 1u);
  press(state, Command::FlipSides);
  EXPECT_EQ(sideAt(state, {0.6, 0.5}), 0u);
  EXPECT_EQ(state.edit.active, 0u);
  press(state, Command::FlipSides);
  EXPECT_EQ(sideAt(state, {0.4, 0.5}), 1u);
  EXPECT_EQ(state.edit.active, 1u);
  press(state, Command::ToggleDifference);
  EXPECT_EQ(state.comparison, CompareMode::Difference);
  press(state, Command::ShowBar);
  EXPECT_EQ(state.comparison, CompareMode::Bar);
}

TEST(ViewState, TheWheelZoomsTowardsTheCursor) {
  ViewState state = someState();
  state.size = {800, 400};
  state.edit.pose.position = {0.0, 0.0, 5.0};
  state.edit.pose.focalPoint = {0.0, 0.0, 0.0};
  // The point at this place of the focal point's plane stays there.
  const double half = 5.0 * std::tan(0.5 * glm::radians(state.edit.pose.viewAngleDegrees));
  const glm::dvec3 point(2.0 * half * 0.5, half * 0.5, 0.0);
  apply(state, {.command = Command::Zoom, .notches = 2.0, .place = {0.75, 0.25}});
  const glm::dvec3 seen = point - state.edit.pose.position;
  const double tangent = std::tan(0.5 * glm::radians(state.edit.pose.viewAngleDegrees));
  EXPECT_NEAR(seen.y / (-seen.z * tangent), 0.5, 1e-12);
  EXPECT_NEAR(seen.x / (-seen.z * tangent * 2.0), 0.5, 1e-12);
  EXPECT_LT(-seen.z, 4.0);
}

TEST(ViewState, WhatWasClickedOnIsFramedAndTheWholeSceneIfAskedFor) {
  ViewState state = someState();
  state.selected.include({0.5, 0.5, 0.5});
  state.selected.include({0.7, 0.7, 0.7});
  press(state, Command::FrameAll);
  EXPECT_NEAR(state.edit.pose.focalPoint.x, 0.6, 1e-12);
  press(state, Command::FrameAll, 1);
  EXPECT_NEAR(state.edit.pose.focalPoint.x, 0.0, 1e-12);
}

TEST(ViewState, ResetAllIsTheStartOfTheSceneThatIsShown) {
  ViewState state = someState();
  RenderOptions start;
  start.scene = "first.gltf";
  start.output.exposure = 1.0;
  press(state, Command::ToggleSplit);
  press(state, Command::ToggleStage, int(Stage::Shadows));
  apply(state, {.command = Command::Orbit, .drag = {0.1, 0.0}});
  resetAll(state, start);
  EXPECT_EQ(state.edit.shared.scene, "some.gltf");
  EXPECT_EQ(state.edit.sides[0].stages, start.stages);
  EXPECT_EQ(state.edit.shared.output.exposure, 1.0);
  EXPECT_FALSE(state.edit.split);
  EXPECT_FALSE(state.edit.posed);
}

TEST(ViewState, ExposureHasLimits) {
  ViewState state = someState();
  for (int i = 0; i < 1000; ++i) press(state, Command::Exposure, 1);
  EXPECT_EQ(state.edit.shared.output.exposure, 32.0);
  for (int i = 0; i < 1000; ++i) press(state, Command::Exposure, -1);
  EXPECT_EQ(state.edit.shared.output.exposure, -32.0);
}

TEST(ViewState, PastedOptionsAreThoseOfTheActiveSideAndTheCameraOfBoth) {
  ViewState state = someState();
  press(state, Command::ToggleSplit);
  state.edit.active = 1;
  RenderOptions pasted = renderOptionsOf(state, 1);
  pasted.sampling.bounces = 2;
  pasted.output.exposure = 1.5;
  pasted.camera.index = 1;
  pasted.output.treeLevel = 7;
  takeOptions(state, pasted);
  EXPECT_EQ(state.edit.sides[1].sampling.bounces, 2);
  EXPECT_EQ(state.edit.sides[0].sampling.bounces, RenderOptions().sampling.bounces);
  EXPECT_EQ(state.edit.shared.output.exposure, 1.5);
  EXPECT_EQ(tracedSides(state)[0].camera.index, 1);
  EXPECT_EQ(state.edit.pose.position, glm::dvec3(5.0, 0.0, 5.0));
  EXPECT_EQ(tracedSides(state)[0].output.treeLevel, 7);
}

TEST(ViewState, ACameraThatIsNotThereChangesNothing) {
  ViewState state = someState();
  RenderOptions pasted = renderOptionsOf(state, 0);
  pasted.camera.index = 7;
  pasted.sampling.bounces = 2;
  EXPECT_THROW(takeOptions(state, pasted), UsageError);
  EXPECT_FALSE(tracedSides(state)[0].camera.index);
  EXPECT_EQ(state.edit.sides[0].sampling.bounces, RenderOptions().sampling.bounces);
}

TEST(ViewerDocument, HoldsTheTableOfAllControls) {
  std::ifstream file(FRAGTRACE_DOCS "/viewer.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find(sheetMarkdown()), std::string::npos) << "docs/viewer.md should have\n"
                                                           << sheetMarkdown();
}

TEST(ViewState, TheExposureThatASceneAsksForGoesWithIt) {
  ViewState state;
  ViewedScene bright = someScene();
  bright.exposure = -7.0;
  showScene(state, bright);
  EXPECT_EQ(state.edit.shared.output.exposure, -7.0);
  showScene(state, someScene());
  EXPECT_EQ(state.edit.shared.output.exposure, std::nullopt);
  state.edit.shared.output.exposure = 0.0;  // the user's
  showScene(state, bright);
  EXPECT_EQ(state.edit.shared.output.exposure, 0.0);
}

}  // namespace
}  // namespace fragtrace
