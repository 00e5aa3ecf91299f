// SPDX-License-Identifier: MIT
#include "view/view_state.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "gltf/edit/factors.h"
#include "scene/parts.h"
#include "shader/variant.h"
#include "view/shown_text.h"

namespace fragtrace {

namespace {

constexpr double kHalfTurn = glm::pi<double>();  // radians that a drag over the picture's height turns
constexpr double kZoomPerHeight = 3.0;
constexpr double kZoomPerNotch = 0.15;
constexpr double kFlySpeedPerNotch = 0.25;  // natural logarithm
constexpr double kSlowest = 0.01;           // distances to the focal point a second
constexpr double kFastest = 100.0;
constexpr int kMostMagnified = 7;  // 128 times
constexpr double kWiden = 0.1;     // natural logarithm of one press
constexpr double kExposureStep = 0.5;
constexpr double kDegreesPerHeight = 180.0;
constexpr int kDeepestLevel = 31;
constexpr double kLowestSun = -18.0;    // degrees; it is night
constexpr double kMostExposure = 32.0;  // either way; far beyond, pictures are not finite

/// Makes the options load the same scene and light as others.
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
  side.device.instancing = from.device.instancing;
  side.limits = from.limits;
}

/// The scene's first camera, or that of the options that it was loaded with.
void resetCamera(ViewState& state) {
  if (!state.scene) return;
  state.edit.shared.camera.index = state.scene->options.camera.index;
  state.edit.shared.camera.overrides = state.scene->options.camera.overrides;
  state.edit.sceneCamera = state.scene->options.camera.index.value_or(state.scene->cameras.empty() ? -1 : 0);
  state.edit.pose = poseOf(state.scene->camera, state.scene->bounds);
  state.edit.posed = false;
}

/// Sets the number in the list; if it is the file's, ends what was set there.
void setNumberIn(std::vector<SetNumber>& set, SetNumber number, const SetNumber& inFile) {
  std::erase_if(set, [&](const SetNumber& one) { return one.pointer == number.pointer; });
  if (!isSame(number, inFile)) set.push_back(std::move(number));
}

/// Copies what the sides of the split view may differ in.
void copySide(RenderOptions& to, const RenderOptions& from) {
  const double noise = to.sampling.noise;  // is shared
  to.stages = from.stages;
  to.sampling = from.sampling;
  to.sampling.noise = noise;
  to.device = from.device;
  to.output.debugView = from.output.debugView;
  to.output.denoise = from.output.denoise;
  to.camera.pixelFilter = from.camera.pixelFilter;
  to.light.selection = from.light.selection;
  to.light.reuse = from.light.reuse;
  to.light.caustics = from.light.caustics;
  to.light.transparentGlass = from.light.transparentGlass;
}

/// The place where the wheel was turned, in halves of the picture's height to the right and up; a drag zooms
/// the picture's middle.
glm::dvec2 fromMiddle(const ViewState& state, const Invocation& m) {
  if (m.notches == 0.0) return glm::dvec2(0.0);
  const double aspectRatio = double(state.size.x) / std::max(state.size.y, 1);
  const glm::dvec2 place = magnifiedPlace(state, m.place);
  return {(2.0 * place.x - 1.0) * aspectRatio, 1.0 - 2.0 * place.y};
}

CameraPose standardView(const CameraPose& pose, StandardViewOf view) {
  struct View {
    glm::dvec3 direction, up;
  };
  static const std::array kViews{View{{0, 0, -1}, {0, 1, 0}}, View{{-1, 0, 0}, {0, 1, 0}},
                                 View{{0, -1, 0}, {0, 0, -1}},
                                 View{glm::normalize(glm::dvec3(-1, -1, -1)), {0, 1, 0}}};
  const View& chosen = kViews.at(size_t(view));
  return lookAlong(pose, chosen.direction, chosen.up);
}

void chooseSceneCamera(ViewState& state, int index) {
  if (!state.scene || index < 0 || size_t(index) >= state.scene->cameras.size()) return;
  state.edit.sceneCamera = index;
  state.edit.shared.camera.index = index;
  state.edit.shared.camera.overrides = {};
  state.edit.pose = poseOf(state.scene->cameras[size_t(index)], state.scene->bounds);
  state.edit.posed = false;
}

/// The filter that the viewer was started with.
Denoise filterOf(const ViewState& state) {
  const bool chosen = state.scene && state.scene->options.output.denoise != Denoise::None;
  return chosen ? state.scene->options.output.denoise : Denoise::Variance;
}

/// Plays from the beginning if the end is shown.
void playOrPause(ViewState& state) {
  const int shown = shownAnimation(state);
  if (shown < 0) return;
  state.playback.playing = !state.playback.playing;
  // Seven pictures a pose would take too long.
  if (state.playback.playing) state.overview = false;
  const double time = state.edit.shared.selection.animationTime.value_or(0.0);
  if (state.playback.playing && time >= animationLength(state)) showAnimation(state, shown, 0.0);
}

/// Shows a debug view by its number. Numbers beyond the last one begin again at the first.
void showDebugView(ViewState& state, int number) {
  const int count = int(kDebugViewRows.size());
  state.side().output.debugView = DebugView((number + count) % count);
  state.overview = false;
}

/// Turns the environment by degrees to the right, or moves the sun of a sky to the left and down.
void turnEnvironment(LightOptions& light, const glm::dvec2& degrees) {
  if (!light.sky.on) {
    light.hdriRotationDegrees = std::remainder(light.hdriRotationDegrees + degrees.x, 360.0);
    return;
  }
  SunPlace sun = sunOf(light.sky);
  sun.azimuth = std::remainder(sun.azimuth - degrees.x, 360.0);
  sun.elevation = std::clamp(sun.elevation - 0.5 * degrees.y, kLowestSun, 90.0);
  placeSun(light.sky, sun);
}

/// Magnifies by steps; the place under the cursor stays there.
void magnify(ViewState& state, int steps, const glm::dvec2& cursor) {
  Magnifier& magnifier = state.magnifier;
  const glm::dvec2 place = magnifiedPlace(state, cursor);
  magnifier.steps = std::clamp(magnifier.steps + steps, 0, kMostMagnified);
  magnifier.center = place - (cursor - 0.5) * std::exp2(-magnifier.steps);
  const double half = 0.5 * std::exp2(-magnifier.steps);
  magnifier.center = glm::clamp(magnifier.center, half, 1.0 - half);
}

/// Closes what lies over the picture, one at a time. Returns false if nothing does.
bool closeOverlay(ViewState& state) {
  return std::exchange(state.sheet, false) || std::exchange(state.overview, false) ||
         std::exchange(state.magnifier, {}).steps > 0;
}

/// Returns true if the sheet leaves the command in view.
bool isForSheet(Command command) {
  return command == Command::ToggleSheet || command == Command::Close || command == Command::Quit ||
         command == Command::Fullscreen;
}

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
                                     state.scene->bounds, framedAspect(state.scene->options.camera));
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
  RenderOptions same = b;
  takeScene(same, a);
  return same == b;
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

RenderOptions sideOf(const RenderOptions& options) {
  RenderOptions side;
  copySide(side, options);
  return side;
}

Edit editOf(const RenderOptions& options) {
  Edit edit;
  edit.shared = options;
  edit.sides = {sideOf(options)};
  return edit;
}

RenderOptions optionsOf(const Edit& edit, size_t side) {
  RenderOptions options = edit.shared;
  copySide(options, edit.sides.at(side));
  return options;
}

void split(Edit& edit) {
  edit.split = true;
  if (edit.sides.size() == 1) edit.sides.push_back(edit.sides[0]);
}

// The changes that commands make in the viewer's state.

bool needsScene(Command command) {
  constexpr std::array kWithout{Command::Reload,     Command::Open,      Command::OpenFile,
                                Command::CancelLoad, Command::NextModel, Command::DropReference};
  return !isForSheet(command) && std::ranges::find(kWithout, command) == kWithout.end();
}

bool isUsable(const ViewState& state, Command command) {
  return state.sheet ? isForSheet(command) : state.scene || !needsScene(command);
}

Invocation invocationOf(const Control& control, Invocation about) {
  about.command = control.command;
  about.argument = control.argument;
  return about;
}

// NOLINTNEXTLINE(readability-function-size): the table of what commands do
bool apply(ViewState& state, const Invocation& m) {
  using enum Command;
  if (!isUsable(state, m.command)) return false;
  RenderOptions& side = state.side();
  RenderOptions& shared = state.edit.shared;
  const CameraPose& pose = state.edit.pose;
  const double flown = state.flySpeed * m.seconds * m.argument;
  const auto move = [&](const CameraPose& moved) {
    state.edit.posed = state.edit.posed || !(moved == pose);
    state.edit.pose = moved;
    return true;
  };
  // Shows the selection, or the whole scene.
  const auto frame = [&](const CameraPose& from, bool whole) {
    if (!state.scene) return move(from);
    const BoundsDouble& bounds = whole || state.selected.empty() ? state.scene->bounds : state.selected;
    return move(frameAll(from, bounds, double(state.size.x) / state.size.y));
  };
  const auto flip = [](bool& on) {
    on = !on;
    return true;
  };
  switch (m.command) {
    case Orbit:
      return move(orbit(pose, kHalfTurn * m.drag.x, kHalfTurn * m.drag.y));
    case Pan:
      return move(pan(pose, {m.drag.x, -m.drag.y}));
    case Zoom:
      return move(zoomAt(pose, kZoomPerNotch * m.notches - kZoomPerHeight * m.drag.y, fromMiddle(state, m)));
    case Roll:
      return move(roll(pose, kHalfTurn * m.drag.x));
    case FlyRight:
      return move(fly(pose, {flown, 0, 0}));
    case FlyUp:
      return move(fly(pose, {0, flown, 0}));
    case FlyForward:
      return move(fly(pose, {0, 0, flown}));
    case FrameAll:
      return frame(pose, m.argument != 0);
    case ResetCamera:
      resetCamera(state);
      return true;
    case StandardView:
      return frame(standardView(pose, StandardViewOf(m.argument)), false);
    case Elevate:
      return move(orbit(pose, 0.0, 0.5 * kHalfTurn * m.argument));
    case RollQuarter:
      return move(roll(pose, 0.5 * kHalfTurn * m.argument));
    case OtherProjection:
      return move(withOtherProjection(pose));
    case Widen:
      return move(widen(pose, kWiden * m.argument));
    case SceneCamera:
      chooseSceneCamera(state, m.argument);
      return true;
    case NextCamera: {
      const int count = state.scene ? int(state.scene->cameras.size()) : 0;
      const int from = std::max(state.edit.sceneCamera, 0);
      if (count > 0) chooseSceneCamera(state, (from + m.argument + count) % count);
      return true;
    }
    // Picture.
    case ToggleStage:
      side.stages.flip(size_t(m.argument));
      // In the overview, each picture has the stages up to its own.
      if (stageRows()[size_t(m.argument)].cumulative) state.overview = false;
      return true;
    case StagesUpTo:
      side.stages = withStagesUpTo(side.stages, Stage(m.argument));
      state.overview = false;
      return true;
    case ToggleDebugView:
      showDebugView(state, side.output.debugView == DebugView(m.argument) ? 0 : m.argument);
      return true;
    case NextDebugView:
      showDebugView(state, int(side.output.debugView) + m.argument);
      return true;
    case ToggleTreeBoxes:
      return flip(state.edit.treeBoxes);
    case TreeLevel:
      state.edit.treeLevel = std::clamp(state.edit.treeLevel + m.argument, 0, kDeepestLevel);
      return true;
    case NextToneMap:
      shared.output.toneMap = ToneMap((int(shared.output.toneMap) + 1) % int(toneMapNames().size()));
      return true;
    case Exposure:
      shared.output.exposure = std::clamp(shared.output.exposure.value_or(0.0) + kExposureStep * m.argument,
                                          -kMostExposure, kMostExposure);
      return true;
    case RotateEnvironment:
      turnEnvironment(shared.light, kDegreesPerHeight * m.drag);
      return true;
    case ToggleDenoise:
      side.output.denoise = side.output.denoise == Denoise::None ? filterOf(state) : Denoise::None;
      return true;
    case PlayAnimation:
      playOrPause(state);
      return true;
    case NextAnimation: {
      const int count = animationCount(state);
      if (count > 0) showAnimation(state, (shownAnimation(state) + m.argument + count) % count, 0.0);
      return true;
    }
    case ToggleGround:
      return flip(shared.light.shadowCatcher);
    case ToggleBackground:
      return flip(shared.light.background);
    // Window.
    case ToggleOverview:
      // A reference has the place of a side.
      state.overview = !state.overview && state.reference.empty();
      if (state.overview) state.playback.playing = false;
      state.magnifier = {};
      return true;
    case ToggleSplit:
      state.overview = false;
      if (!std::exchange(state.edit.split, false))
        split(state.edit);
      else
        state.edit.active = 0;
      return true;
    case FlipSides:
      if (!state.edit.split) return true;
      state.comparison = state.comparison == CompareMode::Left ? CompareMode::Right : CompareMode::Left;
      state.edit.active = state.comparison == CompareMode::Left || !state.reference.empty() ? 0 : 1;
      return true;
    case ToggleDifference:
      if (!state.edit.split) return true;
      state.comparison =
          state.comparison == CompareMode::Difference ? CompareMode::Bar : CompareMode::Difference;
      return true;
    case ShowBar:
      state.comparison = CompareMode::Bar;
      return true;
    case Magnify:
      if (!state.overview) magnify(state, m.notches > 0.0 ? 1 : m.notches < 0.0 ? -1 : m.argument, m.place);
      return true;
    case MoveMagnifier: {
      const double half = 0.5 * std::exp2(-state.magnifier.steps);
      const glm::dvec2 moved(m.drag.x * state.size.y / std::max(state.size.x, 1), m.drag.y);
      state.magnifier.center = glm::clamp(state.magnifier.center - 2.0 * half * moved, half, 1.0 - half);
      return true;
    }
    case FlySpeed:
      state.flySpeed =
          std::clamp(state.flySpeed * std::exp(kFlySpeedPerNotch * m.notches), kSlowest, kFastest);
      return true;
    case TogglePanel:
      state.panelWaits = false;
      return flip(state.panel);
    case ToggleHud:
      return flip(state.figures);
    case ToggleSheet:
      return flip(state.sheet);
    case Close:
      return closeOverlay(state);
    default:
      return false;
  }
}

// The time of the scene's animation, as the viewer's controls set it.

int animationCount(const ViewState& state) {
  const size_t count = state.scene ? state.scene->animationNames.size() : 0;
  return int(count + (count > 1 ? 1 : 0));
}

int shownAnimation(const ViewState& state) {
  if (animationCount(state) == 0) return -1;
  const std::vector<std::string>& names = state.scene->animationNames;
  const std::string& wanted = state.edit.shared.selection.animation;
  const std::optional<size_t> found = findPart(wanted, names);
  if (!found && wanted == kAllAnimations) return animationCount(state) - 1;
  return int(found.value_or(0));
}

double animationLength(const ViewState& state) {
  const int shown = shownAnimation(state);
  if (shown < 0) return 0.0;
  const std::vector<std::optional<double>>& all = state.scene->animationSeconds;
  double seconds = 0.0;
  for (size_t i = 0; i < all.size(); ++i) {
    if (size_t(shown) == i || size_t(shown) == all.size()) seconds = std::max(seconds, all[i].value_or(1.0));
  }
  return seconds > 0.0 ? seconds : 1.0;
}

void showAnimation(ViewState& state, int animation, double seconds) {
  if (animation < 0 || animation >= animationCount(state)) return;
  const bool isAll = size_t(animation) == state.scene->animationNames.size();
  SceneSelection& selection = state.edit.shared.selection;
  selection.animation = isAll ? kAllAnimations : std::to_string(animation);
  selection.animationTime = std::clamp(seconds, 0.0, animationLength(state));
  state.scene->options.selection = selection;
  // A camera that frames the scene stays where it is while that moves.
  state.edit.posed = state.edit.posed || state.scene->cameras.empty();
}

void play(ViewState& state, double now) {
  Playback& playback = state.playback;
  const double length = animationLength(state);
  if (!playback.playing || length <= 0.0) {
    playback.playing = false;
    playback.at = -1.0;
    return;
  }
  const double passed = playback.at < 0.0 ? 0.0 : now - playback.at;
  playback.at = now;
  double time = state.edit.shared.selection.animationTime.value_or(0.0) + playback.speed * passed;
  if (time > length) {
    playback.playing = playback.loops;
    time = playback.loops ? std::fmod(time, length) : length;
  }
  showAnimation(state, shownAnimation(state), time);
}

// The nodes of the scene that the viewer's user has hidden.

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

std::vector<std::string> materialLines(const Material& m) {
  std::vector<std::string> lines;
  const auto textured = [](const TextureRef& texture) { return texture.present() ? ", textured" : ""; };
  const auto number = [&](const char* name, float value, bool shown, const TextureRef& texture = {}) {
    if (shown) lines.push_back(formatted("%s %.3g%s", name, double(value), textured(texture)));
  };
  const auto color = [&](const char* name, glm::vec3 value, bool shown, const TextureRef& texture = {}) {
    if (shown)
      lines.push_back(formatted("%s %.3g, %.3g, %.3g%s", name, double(value.r), double(value.g),
                                double(value.b), textured(texture)));
  };
  color("base colour", glm::vec3(m.baseColorFactor), true, m.baseColorTexture);
  number("alpha", m.baseColorFactor.a, m.alphaMode != AlphaMode::Opaque);
  if (m.alphaMode != AlphaMode::Opaque)
    lines.push_back(m.alphaMode == AlphaMode::Mask ? formatted("alpha mask at %.3g", double(m.alphaCutoff))
                                                   : "alpha blend");
  number("metallic", m.metallicFactor, true, m.metallicRoughnessTexture);
  number("roughness", m.roughnessFactor, true, m.metallicRoughnessTexture);
  number("normal map strength", m.normalScale, m.normalTexture.present());
  number("index of refraction", m.ior, m.transmissive() || m.ior != 1.5f);
  number("transmission", m.transmissionFactor, m.transmissive(), m.transmissionTexture);
  number("thickness", m.thicknessFactor, m.thicknessFactor > 0.0f);
  color("attenuation colour", m.attenuationColor, std::isfinite(m.attenuationDistance));
  number("attenuation distance", m.attenuationDistance, std::isfinite(m.attenuationDistance));
  number("specular", m.specularFactor, m.scalesSpecular(), m.specularTexture);
  color("specular colour", m.specularColorFactor, m.scalesSpecular(), m.specularColorTexture);
  number("clearcoat", m.clearcoatFactor, m.clearcoated(), m.clearcoatTexture);
  number("clearcoat roughness", m.clearcoatRoughnessFactor, m.clearcoated(), m.clearcoatRoughnessTexture);
  color("sheen colour", m.sheenColorFactor, m.hasSheen(), m.sheenColorTexture);
  number("sheen roughness", m.sheenRoughnessFactor, m.hasSheen(), m.sheenRoughnessTexture);
  number("anisotropy", m.anisotropyStrength, m.anisotropic(), m.anisotropyTexture);
  number("iridescence", m.iridescenceFactor, m.iridescent(), m.iridescenceTexture);
  number("diffuse transmission", m.diffuseTransmissionFactor, m.diffuseTransmissionFactor > 0.0f,
         m.diffuseTransmissionTexture);
  number("dispersion", m.dispersion, m.disperses());
  color("emits", m.emissiveFactor * m.emissiveStrength, m.emissive(), m.emissiveTexture);
  if (m.unlit) lines.emplace_back("unlit");
  if (m.doubleSided) lines.emplace_back("double-sided");
  return lines;
}

bool isSame(const SetNumber& a, const SetNumber& b) {
  const auto sameFloat = [](double x, double y) { return float(x) == float(y); };
  return a.pointer == b.pointer && std::ranges::equal(a.values, b.values, sameFloat);
}

void setNumber(ViewState& state, SetNumber number, const SetNumber& inFile) {
  SceneSelection& selection = state.edit.shared.selection;
  setNumberIn(selection.set, std::move(number), inFile);
  state.scene->options.selection = selection;
}

void nameLight(RenderOptions& options, const ViewedScene& scene) {
  if (scene.light.lampScale != 1.0) options.light.lampUnits = LampUnits::Radiometric;
  if (hasMap(options)) return;
  const bool shines = scene.light.own == OwnLight::Dim || setsEmission(options.selection.set);
  if (shines && scene.surroundings == Surroundings::Map) options.light.studio = true;
  if (shines && scene.surroundings == Surroundings::None) options.light.defaultLight = DefaultLight::None;
}

Material shownMaterial(const ViewState& state, size_t index) {
  Material material = state.scene->materials[index];
  setFactors(material, state.edit.shared.selection.set);
  return material;
}

std::vector<std::string> pickLines(const ViewState& state, const PickAnswer& answer) {
  std::vector<std::string> lines = answer.lines;
  if (!answer.material || *answer.material >= state.scene->materials.size()) return lines;
  for (const std::string& line : materialLines(shownMaterial(state, *answer.material)))
    lines.push_back("  " + line);
  return lines;
}

namespace {

/// The edit without what undo does not restore.
Edit restorable(const ViewState& state) {
  Edit edit = state.edit;
  SceneSelection& selection = edit.shared.selection;
  selection = {.materialVariant = selection.materialVariant,
               .hiddenNodes = selection.hiddenNodes,
               .set = selection.set,
               .up = selection.up};
  return edit;
}

/// Directions that are whole turns apart are the same.
void keepTurnsWithin(LightOptions& light) {
  for (double* degrees : {&light.sky.sun.azimuth, &light.hdriRotationDegrees})
    *degrees -= 360.0 * std::floor(*degrees / 360.0);
}

/// Returns true if a user made the step, and sees it: an animation that is shown holds the camera where it is
/// (showAnimation), which nobody sees.
bool differs(Edit a, Edit b) {
  if (a.pose == b.pose) a.posed = b.posed;
  keepTurnsWithin(a.shared.light);
  keepTurnsWithin(b.shared.light);
  return a != b;
}

/// Restores all of the edit except what needs loading.
void restore(ViewState& state, const Edit& edit) {
  const RenderOptions before = std::exchange(state.edit, edit).shared;
  SceneSelection& selection = state.edit.shared.selection;
  takeScene(state.edit.shared, before);
  selection.hiddenNodes = edit.shared.selection.hiddenNodes;
  selection.set = edit.shared.selection.set;
  if (!state.scene) return;
  state.scene->options.selection = selection;
  // This is the same as in showAnimation(): only the user moves the camera of a posed scene.
  state.edit.posed = edit.posed || (selection.animationTime && state.scene->cameras.empty());
}

/// Goes one step back (-1) or forward (1); false: there is none.
bool step(History& history, ViewState& state, int direction) {
  std::deque<Edit>& from = direction < 0 ? history.past : history.future;
  std::deque<Edit>& to = direction < 0 ? history.future : history.past;
  if (from.empty()) return false;
  to.push_back(std::exchange(*history.now, from.back()));
  from.pop_back();
  restore(state, *history.now);
  return true;
}

/// Does so as the user asks for it.
bool stepAsked(History& history, ViewState& state, int direction) {
  record(history, state);
  history.step = direction;
  return step(history, state, direction);
}

}  // namespace

void restart(History& history, const ViewState& state) { history = {{}, {}, restorable(state)}; }

void record(History& history, const ViewState& state) {
  if (history.waits) return;
  Edit edit = restorable(state);
  if (!history.now || !differs(edit, *history.now)) {
    history.now = std::move(edit);
    return;
  }
  history.past.push_back(std::exchange(*history.now, std::move(edit)));
  if (history.past.size() > kMostSteps) history.past.pop_front();
  history.future.clear();
}

bool undo(History& history, ViewState& state) { return stepAsked(history, state, -1); }

bool redo(History& history, ViewState& state) { return stepAsked(history, state, 1); }

void revert(History& history, ViewState& state) {
  if (!std::exchange(history.waits, false)) return;
  if (const int undone = std::exchange(history.step, 0)) step(history, state, -undone);
}

void ignoreChange(History& history, const ViewState& state) {
  if (history.now) history.now = restorable(state);
}

void rebase(History& history, ViewState& state, const std::vector<ChangedNumber>& changed,
            const LightOptions& lightBefore) {
  if (changed.empty()) return;
  const LightOptions lightNow = state.edit.shared.light;
  const auto apply = [&](RenderOptions& options) {
    std::vector<SetNumber>& set = options.selection.set;
    if (options.light.studio == lightBefore.studio &&
        options.light.defaultLight == lightBefore.defaultLight) {
      options.light.studio = lightNow.studio;
      options.light.defaultLight = lightNow.defaultLight;
    }
    for (const auto& [before, now] : changed) {
      const auto found = std::ranges::find(set, now.pointer, &SetNumber::pointer);
      const SetNumber shown = found != set.end() ? *found : before;
      setNumberIn(set, shown, now);
    }
  };
  for (Edit& edit : history.past) apply(edit.shared);
  for (Edit& edit : history.future) apply(edit.shared);
  if (history.now) apply(history.now->shared);
  apply(state.edit.shared);
  if (state.scene) apply(state.scene->options);
}

RenderOptions withLight(const History& history, RenderOptions options) {
  const RenderOptions before = options;
  takeScene(options, history.now->shared);
  options.scene = before.scene;
  options.selection = before.selection;
  options.selection.materialVariant = history.now->shared.selection.materialVariant;
  options.selection.up = history.now->shared.selection.up;
  return options;
}

}  // namespace fragtrace
