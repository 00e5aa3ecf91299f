// SPDX-License-Identifier: MIT
#include "view/view_state.h"

#include <cmath>
#include <utility>

#include "stage/variant.h"

namespace fragtrace {

void resetCamera(ViewState& state) {
  if (!state.scene) return;
  for (RenderOptions& o : state.sides) {
    o.cameraIndex = state.scene->options.cameraIndex;
    o.camera = state.scene->options.camera;
  }
  state.sceneCamera = state.scene->options.cameraIndex.value_or(state.scene->cameras.empty() ? -1 : 0);
  state.pose = poseOf(state.scene->camera, state.scene->bounds);
  state.posed = false;
}

double ViewState::shownBar() const {
  if (!split || comparison == CompareMode::Left || comparison == CompareMode::Difference) return 1.0;
  return comparison == CompareMode::Right ? 0.0 : bar;
}

glm::dvec2 magnifiedPlace(const ViewState& state, const glm::dvec2& place) {
  return state.magnifier.center + (place - 0.5) * std::exp2(-state.magnifier.steps);
}

size_t sideAt(const ViewState& state, const glm::dvec2& place) {
  return state.split && place.x >= state.shownBar() ? 1 : 0;
}

void takeScene(RenderOptions& side, const RenderOptions& from) {
  side.scene = from.scene;
  side.selection = from.selection;
  side.hdriFile = from.hdriFile;
  side.studio = from.studio;
  side.backgroundBlur = from.backgroundBlur;
  side.defaultLight = from.defaultLight;
}

void showScene(ViewState& state, ViewedScene scene) {
  const bool another = !state.scene || state.scene->options.scene != scene.options.scene;
  if (another) state.playback.playing = false;
  state.scene = std::move(scene);
  for (RenderOptions& side : state.sides) {
    if (!side.scene.empty() || &side == &state.sides[0]) takeScene(side, state.scene->options);
  }
  if (another) resetCamera(state);
}

RenderOptions renderOptionsOf(const ViewState& state, size_t side) {
  RenderOptions o = state.sides[side];
  if (state.posed) {
    o.cameraIndex.reset();
    o.camera = overridesOf(state.pose);
  }
  if (!state.pose.perspective) o.lens = {};
  o.treeLevel = state.treeBoxes ? std::optional<int>(state.treeLevel) : std::nullopt;
  return o;
}

std::vector<RenderOptions> tracedSides(const ViewState& state) {
  std::vector<RenderOptions> sides;
  for (size_t i = 0; i < state.tracedCount(); ++i) {
    sides.push_back(renderOptionsOf(state, i));
    sides.back().resolution.reset();
  }
  return sides;
}

void takeOptions(ViewState& state, const RenderOptions& options) {
  if (!state.scene) return;
  const std::optional<int> index =
      cameraIndexOf(options.cameraIndex, options.selection.camera, state.scene->cameras);
  const Camera camera = chooseCamera(state.scene->cameras, index, options.camera, state.scene->bounds,
                                     framedAspect(state.scene->options));
  state.options() = options;
  for (RenderOptions& side : state.sides) {
    side.cameraIndex = index;
    side.selection.camera = options.selection.camera;
    side.camera = options.camera;
    side.exposure = options.exposure;
    side.toneMap = options.toneMap;
    side.hdriRotationDegrees = options.hdriRotationDegrees;
    side.hdriIntensity = options.hdriIntensity;
    side.background = options.background;
    side.shadowCatcher = options.shadowCatcher;
    side.catcherHeight = options.catcherHeight;
    side.backgroundColor = options.backgroundColor;
  }
  state.sceneCamera = index.value_or(state.sceneCamera);
  state.treeBoxes = options.treeLevel.has_value();
  state.treeLevel = options.treeLevel.value_or(state.treeLevel);
  state.pose = poseOf(camera, state.scene->bounds);
  state.posed = false;
}

bool sameScene(const RenderOptions& a, const RenderOptions& b) {
  return a.scene == b.scene && a.selection == b.selection && a.hdriFile == b.hdriFile &&
         a.studio == b.studio && a.backgroundBlur == b.backgroundBlur && a.defaultLight == b.defaultLight &&
         a.instancing == b.instancing && a.limits == b.limits;
}

bool sameNodes(const RenderOptions& a, const RenderOptions& b) {
  return a.scene == b.scene && a.selection.scene == b.selection.scene;
}

RenderOptions resetAll(ViewState& state, const RenderOptions& start) {
  for (RenderOptions& side : state.sides) {
    const RenderOptions before = std::exchange(side, start);
    takeScene(side, before);
  }
  state.split = false;
  state.active = 0;
  state.comparison = CompareMode::Bar;
  state.magnifier = {};
  state.treeBoxes = start.treeLevel.has_value();
  state.playback.playing = false;
  resetCamera(state);
  RenderOptions wanted = state.scene ? state.scene->options : start;
  const std::filesystem::path scene = wanted.scene;
  takeScene(wanted, start);
  if (scene != start.scene) wanted.selection = {};
  wanted.scene = scene;
  return wanted;
}

std::string whyGrey(const ViewState& state, Stage stage) {
  return state.scene ? whyOff(stage, state.scene->present) : std::string();
}

}  // namespace fragtrace
