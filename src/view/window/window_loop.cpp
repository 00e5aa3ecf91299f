// SPDX-License-Identifier: MIT
#include "view/window/view_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.h"
#include "gltf/edit/factors.h"
#include "options/command_text.h"
#include "view/shown_text.h"
#include "view/window/widgets.h"

namespace fragtrace {

namespace {

constexpr double kMovingSeconds = 0.2;  // after the last change, before full resolution
constexpr double kFrameSeconds = 1.0 / 60;
/// If another thread's glfwPostEmptyEvent() has read events from the connection, GLFW 3.3 on X11 sleeps
/// although they wait. So an event is late by this at most. Ten looks a second are no load.
constexpr double kLongestSleep = 0.1;
// While something moves, the window is drawn for each new picture, or after kSameSeconds. It looks for new
// pictures every kLookSeconds.
constexpr double kLookSeconds = 0.004;
constexpr double kSameSeconds = 0.25;
constexpr double kStatusSeconds = 0.05;  // between two status files
constexpr const char* kStarting = "starting";
constexpr glm::ivec2 kWindowSize{1280, 720};

/// The first screen.
struct Screen {
  float scale = 1.0f;  ///< displayScale()
  glm::ivec2 room{0};  ///< for a window, in pixels, also on Wayland; 0: not known
};

Screen primaryScreen() {
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (!monitor) return {};
  glm::vec2 scale(1.0f);
  glm::ivec2 corner(0), room(0);
  glfwGetMonitorContentScale(monitor, &scale.x, &scale.y);
  glfwGetMonitorWorkarea(monitor, &corner.x, &corner.y, &room.x, &room.y);
  return {displayScale(scale), room};
}

/// The window without a given resolution: as large on every display, if that has room.
glm::ivec2 standardSize(const Screen& screen) {
  const glm::ivec2 wanted(glm::round(glm::vec2(kWindowSize) * std::max(screen.scale, 1.0f)));
  const bool known = screen.room.x > 0 && screen.room.y > 0;
  return known ? glm::min(wanted, glm::max(screen.room, kWindowSize)) : kWindowSize;
}

/// Returns true if the panel stands next to the picture at first: both fit on the screen.
bool startsWithPanel(const RenderOptions& options) {
  const Screen screen = primaryScreen();
  const std::optional<glm::ivec2>& picture = options.camera.resolution;
  if (!picture) return layoutOf(glm::vec2(standardSize(screen)), screen.scale, {.panel = true}).docked;
  const bool fits = glm::all(glm::lessThanEqual(windowFor(*picture, screen.scale, true), screen.room));
  return fits && fitsPanel(glm::vec2(*picture), screen.scale);
}

/// The size of the window in GLFW's units. A given resolution is that of the picture.
glm::ivec2 startSize(const RenderOptions& options) {
  const Screen screen = primaryScreen();
  const std::optional<glm::ivec2>& picture = options.camera.resolution;
  const glm::ivec2 pixels =
      picture ? windowFor(*picture, screen.scale, startsWithPanel(options)) : standardSize(screen);
  return onWayland() ? glm::ivec2(glm::round(glm::vec2(pixels) / screen.scale)) : pixels;
}

}  // namespace

Window::Window(const WindowStart& start, Exchange& exchange)
    : start_(start),
      exchange_(exchange),
      window_(openWindow(startSize(start.options), windowTitle(start.options.scene))),
      input_(window_.get()),
      interface_(window_.get()),
      display_(exchange),
      frames_(kFramesAfterEvent) {
  wanted_ = start.options;
  state_.edit = editOf(start.options);
  state_.edit.treeBoxes = start.options.output.treeLevel.has_value();
  state_.edit.treeLevel = start.options.output.treeLevel.value_or(state_.edit.treeLevel);
  state_.panel = start.panel && startsWithPanel(start.options);
  if (!start.warning.empty()) notify(start.warning);
  exchange_.setWake([] { glfwPostEmptyEvent(); });
  try {
    facts_.remembered = readRemembered(rememberedFile());
  } catch (const std::exception& error) {
    notify(std::string("what the viewer remembers cannot be read: ") + error.what());
  }
  if (start.options.device.backend == Backend::Auto && start.options.device.device.empty()) {
    try {
      sharing_ = openSharing(window_.get());
      compiling_ = openSharing(window_.get());
    } catch (const std::exception& error) {
      notify(std::string("pictures are copied, as drivers share none: ") + error.what());
    }
  }
  open();
}

SharedContexts Window::shared() const {
  SharedContexts contexts;
  if (sharing_) contexts.draws = outsideContext(sharing_.get());
  if (compiling_) contexts.compiles = outsideContext(compiling_.get());
  return contexts;
}

/// The first load, for a picture as large as it will be.
void Window::open() {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(window_.get(), &size.x, &size.y);
  state_.size = layoutOf(glm::vec2(size), interface_.scale(), {.panel = state_.panel}).picture;
  if (!start_.reference.empty()) exchange_.request(&Requests::reference, start_.reference);
  if (start_.options.scene.empty()) return;
  load(start_.options);
  facts_.trace.load = {true, start_.options.scene.filename().string(), kStarting, 0.0};
}

void Window::run() {
  while (!closes() && !start_.interrupted()) {
    wait();
    const double begin = glfwGetTime();
    const bool came = take();
    if (!came && frames_ == 0 && !input_.active() && !state_.playback.playing && !requested_.moving &&
        !statusWaits_)
      continue;
    if (frames_ > 0 && !iconified()) draw();
    play(state_, glfwGetTime());
    const bool held = input_.active() || ImGui::IsAnyItemActive();
    if (!held && !state_.playback.playing && state_.scene) record(history_, state_);
    request();
    writeStatus();
    const double ms = 1000.0 * (glfwGetTime() - begin);
    keepTime(report_.loopMs, ms);
    report_.longestLoopMs = std::max(report_.longestLoopMs, ms);
    if (!std::exchange(prepared_, true)) display_.prepare();
  }
  if (!state_.scene && !start_.options.scene.empty() && !facts_.trace.error.empty())
    throw InputError(facts_.trace.error);
}

bool Window::iconified() const { return glfwGetWindowAttrib(window_.get(), GLFW_ICONIFIED) != 0; }

void Window::wait() {
  if (interface_.waiting()) frames_ = std::max(frames_, kFramesAfterEvent);
  double seconds = kLongestSleep;
  const double now = glfwGetTime();
  const auto atMost = [&](double limit) { seconds = std::clamp(limit, 0.0, seconds); };
  if (input_.active() || state_.playback.playing) atMost(kFrameSeconds);
  if (requested_.moving) atMost(changed_ + kMovingSeconds - now);
  if (now >= again_) frames_ = std::max(frames_, 1);
  if (!skipped_) atMost(again_ - now);
  if (now >= fades_) frames_ = std::max(frames_, 2);  // the box of messages fits them one frame later
  atMost(fades_ - now);
  if (statusWaits_) atMost(statusTime_ + kStatusSeconds - now);
  if (frames_ > 0 && !iconified()) atMost(skipped_ ? kLookSeconds : 0.0);
  if (seconds > 0.0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  if (input_.waiting() || interface_.waiting() || input_.active() || requested_.moving)
    frames_ = std::max(frames_, kFramesAfterEvent);
}

void Window::notify(const std::string& message) {
  addMessage(facts_.messages, message, glfwGetTime());
  frames_ = std::max(frames_, kFramesAfterEvent);
}

bool Window::take() {
  Results results = exchange_.take();
  const bool came =
      !results.queue.empty() || !results.pictures.empty() || results.status.request != facts_.trace.request;
  for (Result& result : results.queue) std::visit([this](auto& one) { take(std::move(one)); }, result);
  takePictures(std::move(results.pictures));
  if (const std::string errors = takeGlfwErrors(); !errors.empty()) notify("window: " + errors);
  takeStatus(results.status);
  takeFile();
  return came || dialog_.open();
}

void Window::take(const std::string& message) { notify(withControls(message)); }

void Window::take(const PosedScene& posed) {
  if (!state_.scene) return;
  state_.scene->bounds = posed.bounds;
  state_.scene->surroundings = posed.surroundings;
}

/// The window then shows the numbers of the file, in the light that it has.
void Window::take(SavedModel saved) {
  saved_ = std::move(saved.set);
  if (quitsWhenSaved_) glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
  if (!std::exchange(savesShown_, false) || !state_.scene) return;
  RenderOptions again = state_.scene->options;
  nameLight(again, *state_.scene);
  load(again);
}

/// The numbers that a model was written with, and that the scene that is shown has by now, since it was read
/// again.
std::vector<ChangedNumber> Window::numbersSavedIn(const ViewedScene& scene) const {
  std::vector<ChangedNumber> changed;
  if (!state_.scene || !sameNodes(state_.scene->options, scene.options)) return changed;
  for (const SetNumber& saved : saved_) {
    const auto before = numberAt(state_.scene->materials, state_.scene->lights, saved.pointer);
    const auto now = numberAt(scene.materials, scene.lights, saved.pointer);
    if (before && now && isSame(*now, saved) && !isSame(*before, *now)) changed.push_back({*before, *now});
  }
  return changed;
}

void Window::take(ViewedScene scene) {
  const bool another = !state_.scene || !sameScene(state_.scene->options, scene.options);
  const bool otherNodes = !state_.scene || !sameNodes(state_.scene->options, scene.options);
  const std::vector<ChangedNumber> changed = numbersSavedIn(scene);
  const LightOptions lightBefore = state_.edit.shared.light;
  showScene(state_, std::move(scene));
  // The font gets all names at once, not each as it is scrolled to.
  for (const SceneNode& node : state_.scene->nodes) shownText(node.name, kMostNameCharacters);
  rebase(history_, state_, changed, lightBefore);
  glfwSetWindowTitle(window_.get(), windowTitle(state_.scene->options.scene).c_str());
  wanted_ = state_.scene->options;
  if (pasted_ && sameScene(*pasted_, wanted_)) takeOptions(state_, *std::exchange(pasted_, {}));
  history_.waits = false;
  if (otherNodes) {
    restart(history_, state_);
    saved_.clear();
  }
  if (another) {
    remember([&](Remembered& r) { addRecent(r, wanted_.scene); });
  }
  requested_.sides.clear();
  deselect();
  frames_ = kFramesAfterEvent;
}

void Window::takeStatus(const TraceStatus& status) {
  facts_.trace.request = status.request;
  // The tracing thread may not know of the first load yet.
  const bool silent = !status.load.busy && status.error.empty();
  if (status == facts_.trace || (silent && !state_.scene && facts_.trace.load.step == kStarting)) return;
  if (status.error != facts_.trace.error) facts_.errorClosed = false;
  facts_.trace = status;
  if (!status.error.empty() && !status.load.busy) {
    if (!state_.scene) forgetBrokenEnvironment();
    endLoad();
  }
  frames_ = std::max(frames_, 2);
}

/// Goes back to the scene that is shown: nothing else is loaded.
void Window::endLoad() {
  pasted_.reset();
  revert(history_, state_);
  if (state_.scene)
    wanted_ = state_.scene->options;
  else
    glfwSetWindowTitle(window_.get(), windowTitle({}).c_str());
}

/// An environment that was dropped before a model would keep every model from being shown.
void Window::forgetBrokenEnvironment() {
  const std::string file = wanted_.light.hdriFile.string();
  if (file.empty() || facts_.trace.error.find(file) == std::string::npos) return;
  wanted_.light.hdriFile.clear();
  notify(std::filesystem::path(file).filename().string() + " is left out from now on");
}

void Window::request() {
  if (!state_.scene || state_.size.x <= 0 || state_.size.y <= 0) return;
  TraceRequest next{requested_.number + 1, tracedSides(state_), state_.size};
  const std::vector<RenderOptions>& before = requested_.sides;
  bool turned = before.empty() || next.size != requested_.size;
  for (size_t i = 0; !turned && i < std::min(next.sides.size(), before.size()); ++i)
    turned = !drawsTheSame(next.sides[i], before[i]);
  const bool other = turned || next.sides.size() != before.size();
  // A side that comes back showed another view long ago.
  for (size_t i = before.size(); !before.empty() && i < next.sides.size(); ++i) display_.forget(i);
  const double now = glfwGetTime();
  // A side that comes or goes moves nothing: the others keep their samples.
  if (turned) changed_ = now;
  next.moving = changed_ >= 0.0 && now - changed_ < kMovingSeconds;
  if (!other && next.sides == before && next.moving == requested_.moving) return;
  requested_ = std::move(next);
  exchange_.request(&Requests::trace, requested_);
  report_.asked = requested_.number;
  if (other) unanswered_.emplace_back(requested_.number, now);
  // A movement that continues is drawn again and again.
  if (requested_.moving) frames_ = std::max(frames_, 1);
}

/// Only values that somebody looks at are read; frames are drawn until they are there.
void Window::readValues() {
  const double now = glfwGetTime();
  again_ = display_.waits() ? now : std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < kMostSides; ++i) {
    const PixelArea area = wantedArea(state_, facts_, i, display_.sizeOf(i));
    again_ = std::min(again_, display_.keepValues(i, facts_.values[i], area, now));
  }
}

void Window::draw() {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(window_.get(), &size.x, &size.y);
  if (size.x <= 0 || size.y <= 0) return;
  fitPanel(state_, layoutOf(glm::vec2(size), interface_.scale(), {.panel = true}).docked);
  const bool panel = state_.panel && state_.scene;
  const WindowLayout layout =
      layoutOf(glm::vec2(size), interface_.scale(), {panel, state_.panelWidth, state_.compares()});
  state_.size = state_.overview ? glm::max(layout.picture / kCells, 1) : layout.picture;
  interface_.begin();
  facts_.cursor =
      input_.update(state_, layout, [this](const Invocation& invocation) { execute(invocation); });
  if (const auto files = input_.takeDrops(); !files.empty()) openFiles(files);
  places().clear();
  facts_.wantsHistogram = false;
  facts_.canUndo = !history_.past.empty();
  facts_.canRedo = !history_.future.empty();
  const double now = glfwGetTime();
  drawOverlay(state_, facts_, layout, now);
  fades_ = now + secondsToFade(facts_.messages, now);
  if (panel) drawPanel(state_, facts_, layout);
  for (const Invocation& invocation : std::exchange(facts_.commands, {})) execute(invocation);
  requestThumbnails();
  // Software would draw the same picture again, with the processors that trace the next one.
  skipped_ = requested_.moving && !display_.hasNewPicture() && now - drawn_ < kSameSeconds;
  if (skipped_) return ImGui::EndFrame();
  drawn_ = now;
  ++report_.frames;
  display_.draw(state_, layout.picture, size);
  readValues();
  interface_.end();
  checkGl("drawing the window", driverLog_);
  glfwSwapBuffers(window_.get());
  for (const std::string& message : driverLog_.take()) {
    report_.glErrors.push_back(message);
    notify("driver: " + message);
  }
  --frames_;
}

void Window::end(const std::string& failure) {
  facts_.trace.error = failure.empty() ? facts_.trace.error : failure;
  report_.end = failure.empty() ? "closed" : "failed";
  statusTime_ = -1.0;
  writeStatus();
}

void Window::writeStatus() {
  if (start_.statusFile.empty()) return;
  const double now = glfwGetTime();
  statusWaits_ = statusTime_ >= 0.0 && now - statusTime_ < kStatusSeconds;
  if (statusWaits_) return;
  report_.camera = state_.scene ? cameraText(shownOptions()) : "";
  std::string text = statusText(state_, facts_, report_);
  if (text == status_) return;
  status_ = std::move(text);
  statusTime_ = now;
  writeStatusFile(start_.statusFile, status_);
}

}  // namespace fragtrace
