// SPDX-License-Identifier: MIT
#include "view/view_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shader/variant.h"

namespace fragtrace {

void resetCamera(ViewState& state) {
  if (!state.scene) return;
  state.edit.shared.camera.index = state.scene->options.camera.index;
  state.edit.shared.camera.overrides = state.scene->options.camera.overrides;
  state.edit.sceneCamera = state.scene->options.camera.index.value_or(state.scene->cameras.empty() ? -1 : 0);
  state.edit.pose = poseOf(state.scene->camera, state.scene->bounds);
  state.edit.posed = false;
}

double ViewState::shownBar() const {
  if (!compares() || comparison == CompareMode::Left || comparison == CompareMode::Difference) return 1.0;
  return comparison == CompareMode::Right ? 0.0 : bar;
}

void fitPanel(ViewState& state, bool hasRoom) {
  if (std::exchange(state.panelHasRoom, hasRoom) == hasRoom) return;
  if (hasRoom) {
    state.panel = state.panel || std::exchange(state.panelWaits, false);
  } else {
    state.panelWaits = std::exchange(state.panel, false);
  }
}

size_t ViewState::shownSide() const {
  if (!overview) return edit.active;
  size_t last = 0;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative && has(side().stages, row.stage)) last = size_t(row.stage);
  }
  return last;
}

glm::dvec2 magnifiedPlace(const ViewState& state, const glm::dvec2& place) {
  if (state.overview) return glm::fract(place * double(kCells));
  return state.magnifier.center + (place - 0.5) * std::exp2(-state.magnifier.steps);
}

size_t sideAt(const ViewState& state, const glm::dvec2& place) {
  if (state.overview) {
    const glm::ivec2 cell(glm::clamp(place, 0.0, 1.0 - 1e-9) * double(kCells));
    return size_t(cell.y) * size_t(kCells) + size_t(cell.x);
  }
  return state.edit.split && place.x >= state.shownBar() ? 1 : 0;
}

void takeScene(RenderOptions& side, const RenderOptions& from) {
  side.scene = from.scene;
  side.selection = from.selection;
  side.light.hdriFile = from.light.hdriFile;
  side.light.studio = from.light.studio;
  side.light.studioLook = from.light.studioLook;
  side.light.ground = from.light.ground;
  side.light.sky.on = from.light.sky.on;
  side.light.backgroundBlur = from.light.backgroundBlur;
  side.light.defaultLight = from.light.defaultLight;
  side.light.lampUnits = from.light.lampUnits;
}

void showScene(ViewState& state, ViewedScene scene) {
  const bool another = !state.scene || state.scene->options.scene != scene.options.scene;
  if (another) state.playback.playing = false;
  std::optional<double> asked;
  if (state.scene) asked = state.scene->exposure;
  state.scene = std::move(scene);
  // An exposure that the user has set stays.
  std::optional<double>& exposure = state.edit.shared.output.exposure;
  if (exposure == asked) exposure = state.scene->exposure;
  takeScene(state.edit.shared, state.scene->options);
  if (another) resetCamera(state);
}

RenderOptions renderOptionsOf(const ViewState& state, size_t side) {
  RenderOptions o = optionsOf(state.edit, side);
  if (state.edit.posed) {
    o.camera.index.reset();
    o.camera.overrides = overridesOf(state.edit.pose);
  }
  if (state.edit.pose.type != CameraType::Perspective) o.camera.lens = {};
  const bool boxes = state.edit.treeBoxes && isRectilinear(state.edit.pose.type);
  o.output.treeLevel = boxes ? std::optional<int>(state.edit.treeLevel) : std::nullopt;
  return o;
}

std::vector<RenderOptions> tracedSides(const ViewState& state) {
  std::vector<RenderOptions> sides;
  for (size_t i = 0; i < state.tracedCount(); ++i) {
    sides.push_back(renderOptionsOf(state, state.overview ? state.edit.active : i));
    sides.back().camera.resolution.reset();
    if (!state.overview) continue;
    sides.back().stages = withStagesUpTo(sides.back().stages, Stage(i));
    sides.back().output.debugView = DebugView::None;
  }
  return sides;
}

void takeOptions(ViewState& state, const RenderOptions& options) {
  if (!state.scene) return;
  const std::optional<int> index =
      cameraIndexOf(options.camera.index, options.selection.camera, state.scene->cameras);
  const Camera camera = chooseCamera(state.scene->cameras, index, options.camera.overrides,
                                     state.scene->bounds, framedAspect(state.scene->options));
  state.side() = sideOf(options);
  state.edit.shared = options;
  state.edit.shared.camera.index = index;
  state.edit.sceneCamera = index.value_or(state.edit.sceneCamera);
  state.edit.treeBoxes = options.output.treeLevel.has_value();
  state.edit.treeLevel = options.output.treeLevel.value_or(state.edit.treeLevel);
  state.edit.pose = poseOf(camera, state.scene->bounds);
  // Without the scene's points here, a default view is held as it is shown.
  state.edit.posed = state.scene->cameras.empty();
}

bool sameScene(const RenderOptions& a, const RenderOptions& b) {
  return a.scene == b.scene && a.selection == b.selection && a.light.hdriFile == b.light.hdriFile &&
         a.light.studio == b.light.studio && a.light.studioLook == b.light.studioLook &&
         a.light.ground == b.light.ground && a.light.sky.on == b.light.sky.on &&
         a.light.backgroundBlur == b.light.backgroundBlur && a.light.defaultLight == b.light.defaultLight &&
         a.light.lampUnits == b.light.lampUnits && a.device.instancing == b.device.instancing &&
         a.limits == b.limits;
}

bool sameNodes(const RenderOptions& a, const RenderOptions& b) {
  return a.scene == b.scene && a.selection.scene == b.selection.scene;
}

RenderOptions resetAll(ViewState& state, const RenderOptions& start) {
  const RenderOptions before = std::exchange(state.edit.shared, start);
  takeScene(state.edit.shared, before);
  std::ranges::fill(state.edit.sides, sideOf(start));
  state.edit.split = false;
  state.overview = false;
  state.edit.active = 0;
  state.comparison = CompareMode::Bar;
  state.magnifier = {};
  state.edit.treeBoxes = start.output.treeLevel.has_value();
  state.playback.playing = false;
  resetCamera(state);
  RenderOptions wanted = state.scene ? state.scene->options : start;
  const std::filesystem::path scene = wanted.scene;
  takeScene(wanted, start);
  if (scene != start.scene) wanted.selection = {.up = start.selection.up};
  wanted.scene = scene;
  return wanted;
}

std::string whyNoFog(const ViewState& state) {
  if (!has(state.side().stages, Stage::Gi)) return "only path traced";
  return state.edit.shared.light.shadowCatcher ? "not with a shadow catcher" : "";
}

std::string whyGrey(const ViewState& state, Stage stage) {
  return state.scene ? whyOff(stage, state.scene->present, has(state.side().stages, Stage::Gi))
                     : std::string();
}

}  // namespace fragtrace
