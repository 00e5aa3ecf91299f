// SPDX-License-Identifier: MIT
// The window's thread: events in, requests to the tracing thread, its pictures onto the screen. It draws only
// when something has changed, and sleeps otherwise.
#include "view/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "errors.h"
#include "gl/debug_log.h"
#include "gl/gl.h"
#include "view/dropped_file.h"
#include "view/shown_names.h"
#include "view/window/display.h"
#include "view/window/glfw_window.h"
#include "view/window/input.h"
#include "view/window/interface.h"
#include "view/window/panel.h"
#include "view/window/status.h"

namespace fragtrace {

namespace {

constexpr int kSettleFrames = 3;        // that Dear ImGui takes to come to rest after an event
constexpr double kMovingSeconds = 0.2;  // after the last change, before full resolution
constexpr double kFrameSeconds = 1.0 / 60;
/// GLFW 3.3 on X11 sleeps on what another thread's glfwPostEmptyEvent() has read from the connection
/// meanwhile; so an event is late by this at most. Ten looks a second are no load.
constexpr double kLongestSleep = 0.1;
constexpr double kStatusSeconds = 0.05;  // between two status files

class Window {
 public:
  Window(const WindowStart& start, Exchange& exchange);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window() { exchange_.setWake({}); }
  void run();
  /// The last of the status file: why the window is closed; empty: it was wanted.
  void end(const std::string& failure);

 private:
  void wait();
  void take();
  void ask();
  void draw();
  void execute(const PlacedErrand& errand);
  void load(const RenderOptions& options);
  void cancelLoad();
  void takeDrops();
  void save(const char* extension);
  void copyCommand();
  void pasteCommand();
  RenderOptions shownOptions() const;
  void say(const std::string& message);
  void writeStatus();
  bool iconified() const { return glfwGetWindowAttrib(window_.get(), GLFW_ICONIFIED) != 0; }

  const WindowStart& start_;
  Exchange& exchange_;
  Glfw glfw_;
  WindowHandle window_;
  DebugLog driverLog_;
  Input input_;
  Interface interface_;
  Display display_;
  ViewState state_;
  ViewFacts facts_;
  WindowReport report_;
  RenderOptions wanted_;                 ///< of the scene that is shown, or being loaded
  std::optional<RenderOptions> pasted_;  ///< to be taken once their scene is loaded
  std::string status_;
  double statusTime_ = -1.0;
  bool statusWaits_ = false;
  int frames_ = kSettleFrames;  ///< still to be drawn
  double changed_ = -1.0;       ///< when the traced picture was last changed
  double fades_ = 1e30;         ///< when a message is to be drawn paler
  std::vector<RenderOptions> askedSides_;
  glm::ivec2 askedSize_{0};
  bool askedMoving_ = false;
  std::deque<std::pair<uint64_t, double>> unanswered_;  ///< requests, and when they were made
};

Window::Window(const WindowStart& start, Exchange& exchange)
    : start_(start),
      exchange_(exchange),
      window_(openWindow(start.options.resolution.value_or(glm::ivec2(1280, 720)),
                         windowTitle(start.options.scene))),
      input_(window_.get()),
      interface_(window_.get()) {
  state_.sides[0] = wanted_ = start.options;
  state_.treeBoxes = start.options.treeLevel.has_value();
  state_.treeLevel = start.options.treeLevel.value_or(state_.treeLevel);
  // In a small window the picture would be hidden.
  glm::ivec2 size(0);
  glfwGetFramebufferSize(window_.get(), &size.x, &size.y);
  state_.panel = fitsPanel(glm::vec2(size), interface_.scale());
  facts_.load = {true, start.options.scene.filename().string(), "starting", 0.0};
  exchange_.setWake([] { glfwPostEmptyEvent(); });
}

void Window::run() {
  while (!glfwWindowShouldClose(window_.get())) {
    wait();
    const double begin = glfwGetTime();
    take();
    if (frames_ > 0 && !iconified()) draw();
    play(state_, glfwGetTime());
    ask();
    writeStatus();
    const double ms = 1000.0 * (glfwGetTime() - begin);
    keepTime(report_.times.loopMs, ms);
    report_.times.longestLoopMs = std::max(report_.times.longestLoopMs, ms);
  }
}

void Window::wait() {
  double seconds = kLongestSleep;
  const double now = glfwGetTime();
  const auto atMost = [&](double limit) { seconds = std::clamp(limit, 0.0, seconds); };
  if (input_.active() || state_.playback.playing) atMost(kFrameSeconds);
  if (askedMoving_) atMost(changed_ + kMovingSeconds - now);
  if (now >= fades_) frames_ = std::max(frames_, 1);
  atMost(fades_ - now);
  if (statusWaits_) atMost(statusTime_ + kStatusSeconds - now);
  if (frames_ > 0 && !iconified()) atMost(0.0);
  if (seconds > 0.0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  if (input_.waiting() || input_.active() || askedMoving_) frames_ = std::max(frames_, kSettleFrames);
}

void Window::say(const std::string& message) {
  addMessage(facts_.messages, message, glfwGetTime());
  frames_ = std::max(frames_, 1);
}

void Window::take() {
  Delivery news = exchange_.take();
  if (news.failure) std::rethrow_exception(news.failure);
  if (news.scene) {
    showScene(state_, std::move(*news.scene));
    glfwSetWindowTitle(window_.get(), windowTitle(state_.scene->options.scene).c_str());
    wanted_ = state_.scene->options;
    if (pasted_ && sameScene(*pasted_, wanted_)) takeOptions(state_, *std::exchange(pasted_, {}));
    askedSides_.clear();
    facts_.pick.reset();
    frames_ = kSettleFrames;
  }
  const double now = glfwGetTime();
  for (const TracedPicture& picture : news.pictures) {
    display_.take(picture);
    facts_.statistics[picture.side] = picture.statistics;
    facts_.pictureSize[picture.side] = {picture.image.width, picture.image.height};
    facts_.lines[picture.side] = picture.lines;
    report_.answered = std::max(report_.answered, picture.request);
    while (!unanswered_.empty() && unanswered_.front().first <= picture.request) {
      keepTime(report_.times.answerMs, 1000.0 * (now - unanswered_.front().second));
      unanswered_.pop_front();
    }
    frames_ = std::max(frames_, 1);
  }
  if (news.pick) {
    if (news.pick->request.center && news.pick->hit) {
      state_.pose = centerOn(state_.pose, news.pick->point);
      state_.posed = true;
    }
    if (!news.pick->request.center) facts_.pick = std::move(news.pick);
    frames_ = kSettleFrames;
  }
  for (const std::string& message : news.messages) say(message);
  if (const std::string errors = takeGlfwErrors(); !errors.empty()) say("window: " + errors);
  const bool changed = news.load.busy != facts_.load.busy || news.load.step != facts_.load.step ||
                       news.load.fraction != facts_.load.fraction || news.note != facts_.note ||
                       news.error != facts_.error || news.resting != facts_.resting;
  if (changed && (state_.scene || news.load.busy || !news.error.empty())) {
    facts_.load = news.load;
    facts_.note = news.note;
    if (news.error != facts_.error) facts_.errorClosed = false;
    facts_.error = news.error;
    if (!facts_.error.empty() && !facts_.load.busy && state_.scene) {
      wanted_ = state_.scene->options;
      pasted_.reset();
    }
    facts_.resting = news.resting;
    frames_ = std::max(frames_, 2);
  }
  report_.seen = news.request;
}

void Window::ask() {
  if (!state_.scene || state_.size.x <= 0 || state_.size.y <= 0) return;
  std::vector<RenderOptions> sides = tracedSides(state_);
  bool other = sides.size() != askedSides_.size() || state_.size != askedSize_;
  for (size_t i = 0; !other && i < sides.size(); ++i) other = !drawsTheSame(sides[i], askedSides_[i]);
  const bool more = !other && sides != askedSides_;
  const double now = glfwGetTime();
  if (other) changed_ = now;
  const bool moving = changed_ >= 0.0 && now - changed_ < kMovingSeconds;
  if (!other && !more && moving == askedMoving_) return;
  const uint64_t number = exchange_.ask(sides, state_.size, moving);
  report_.asked = number;
  if (other) unanswered_.emplace_back(number, now);
  askedSides_ = std::move(sides);
  askedSize_ = state_.size;
  askedMoving_ = moving;
  // What goes on moving is drawn again and again.
  if (moving) frames_ = std::max(frames_, 1);
}

void Window::draw() {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(window_.get(), &size.x, &size.y);
  if (size.x <= 0 || size.y <= 0) return;
  state_.size = size;
  interface_.begin();
  input_.update(state_, interface_.scale(), [this](const PlacedErrand& errand) { execute(errand); });
  takeDrops();
  const bool panel = state_.panel && state_.scene;
  const OverlayLayout layout = layoutOf(glm::vec2(size), interface_.scale(), panel, state_.split);
  facts_.places.clear();
  const double now = glfwGetTime();
  if (drawOverlay(state_, facts_, layout, now)) cancelLoad();
  fades_ = now + secondsToFade(facts_.messages, now);
  if (panel) execute({drawPanel(state_, layout, facts_.places), {}});
  std::array<DisplaySide, 2> sides;
  for (size_t i = 0; i < 2; ++i) sides[i] = {state_.sides[i].exposure, state_.sides[i].toneMap};
  display_.draw(size, sides, state_.split ? state_.bar : 1.0);
  facts_.focus = Interface::focus();
  interface_.end();
  checkGl("drawing the window");
  glfwSwapBuffers(window_.get());
  for (const std::string& message : driverLog_.take()) {
    report_.glErrors.push_back(message);
    say("driver: " + message);
  }
  --frames_;
}

void Window::execute(const PlacedErrand& errand) {
  switch (errand.errand) {
    case Errand::None:
      return;
    case Errand::CenterOn:
    case Errand::Inspect: {
      const size_t side = state_.split && errand.place.x >= state_.bar ? 1 : 0;
      exchange_.pick({side, errand.place, errand.errand == Errand::CenterOn});
      return;
    }
    case Errand::CopyCommand:
      return copyCommand();
    case Errand::PasteCommand:
      return pasteCommand();
    case Errand::Reload:
      if (state_.scene) load(state_.scene->options);
      return;
    case Errand::Screenshot:
      return save(".png");
    case Errand::WriteExr:
      return save(".exr");
    case Errand::Close:
      if (facts_.load.busy && state_.scene) return cancelLoad();
      [[fallthrough]];
    case Errand::Quit:
      glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
      return;
  }
}

void Window::load(const RenderOptions& options) {
  wanted_ = options;
  pasted_.reset();
  exchange_.load(options);
}

void Window::cancelLoad() {
  exchange_.cancelLoad();
  if (!state_.scene) return glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
  wanted_ = state_.scene->options;
  pasted_.reset();
}

void Window::takeDrops() {
  const std::vector<std::filesystem::path> files = input_.takeDrops();
  if (files.empty()) return;
  const Drop drop = takeDrop(wanted_, files);
  for (const std::string& sentence : drop.refused) say(sentence);
  if (drop.load) load(*drop.load);
}

void Window::save(const char* extension) {
  if (!state_.scene) return;
  const RenderOptions& o = state_.options();
  exchange_.save({freePictureName(o.scene, extension), state_.active, o.exposure, o.toneMap});
}

/// Of the active side, with all that its picture on the screen depends on.
RenderOptions Window::shownOptions() const {
  RenderOptions o = renderOptionsOf(state_, state_.active);
  o.resolution = state_.size;
  o.sceneOrigin = state_.scene->description.origin;
  o.spp = std::max(facts_.statistics[state_.active].samples, 1);
  return o;
}

void Window::copyCommand() {
  if (!state_.scene) return;
  RenderOptions o = shownOptions();
  const bool layers = !o.aovFeatures.empty() || o.aovSamples || o.aovVariance;
  o.output = freePictureName(o.scene, layers ? ".exr" : ".png");
  glfwSetClipboardString(window_.get(), start_.commandText(o).c_str());
  say("copied the command that renders this picture");
}

void Window::pasteCommand() {
  if (!state_.scene) return;
  const char* text = glfwGetClipboardString(window_.get());
  // That the clipboard holds no text is no failure of the window.
  if (!text) takeGlfwErrors();
  try {
    const RenderOptions options =
        start_.withCommandText(renderOptionsOf(state_, state_.active), text ? text : "");
    if (sameScene(options, state_.scene->options)) return takeOptions(state_, options);
    load(options);
    pasted_ = options;
  } catch (const std::exception& error) {
    say(std::string("cannot paste: ") + error.what());
  }
}

void Window::end(const std::string& failure) {
  facts_.error = failure.empty() ? facts_.error : failure;
  report_.end = failure.empty() ? "closed" : "failed";
  statusTime_ = -1.0;
  writeStatus();
}

void Window::writeStatus() {
  if (start_.statusFile.empty()) return;
  const double now = glfwGetTime();
  statusWaits_ = statusTime_ >= 0.0 && now - statusTime_ < kStatusSeconds;
  if (statusWaits_) return;
  report_.camera = state_.scene ? start_.cameraText(shownOptions()) : "";
  std::string text = statusText(state_, facts_, report_);
  if (text == status_) return;
  status_ = std::move(text);
  statusTime_ = now;
  writeStatusFile(start_.statusFile, status_);
}

/// What ends the program stands in the status file, too, if that can be written.
template <typename Write>
void writeFailure(const Write& write) {
  try {
    write();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fragtrace: %s\n", error.what());
  }
}

/// Says that there is no window, and why, when it cannot be opened.
std::unique_ptr<Window> makeWindow(const WindowStart& start, Exchange& exchange) {
  try {
    return std::make_unique<Window>(start, exchange);
  } catch (const std::exception& error) {
    const std::string text = std::string("no window: ") + error.what();
    writeFailure([&] { writeStatusFile(start.statusFile, failureText(text)); });
    throw ContextError(text);
  }
}

void runWindow(const WindowStart& start, Exchange& exchange) {
  const std::unique_ptr<Window> window = makeWindow(start, exchange);
  start.opened();
  try {
    window->run();
  } catch (const std::exception& error) {
    writeFailure([&] { window->end(error.what()); });
    throw;
  }
  window->end({});
}

}  // namespace

}  // namespace fragtrace

extern "C" const fragtrace::WindowLibrary* fragtraceWindowLibrary() {
  static const fragtrace::WindowLibrary library{fragtrace::runWindow};
  return &library;
}
