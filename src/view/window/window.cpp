// SPDX-License-Identifier: MIT
// The window's thread: events in, requests to the tracing thread, its pictures onto the screen. It draws only
// when something has changed, and sleeps otherwise.
#include "view/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "errors.h"
#include "gl/debug_log.h"
#include "gl/gl.h"
#include "image/whole_file.h"
#include "view/dropped_file.h"
#include "view/window/display.h"
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
constexpr double kStatusSeconds = 0.05;   // between two status files
constexpr float kLeastForPanel = 720.0f;  // pixels of width at 96 dots an inch
constexpr size_t kMostMessages = 6;
constexpr size_t kMostTimes = 512;

std::string& glfwErrors() {
  static std::string text;
  return text;
}

/// GLFW for as long as it lives.
struct Glfw {
  Glfw() {
    glfwSetErrorCallback([](int, const char* text) {
      glfwErrors() += (glfwErrors().empty() ? "" : "; ") + std::string(text);
    });
    if (!glfwInit()) throw std::runtime_error(glfwErrors());
  }
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;
  ~Glfw() { glfwTerminate(); }
};

struct CloseWindow {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using WindowHandle = std::unique_ptr<GLFWwindow, CloseWindow>;

WindowHandle openWindow(glm::ivec2 size, const std::string& title) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
#ifndef NDEBUG
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
#endif
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  WindowHandle window(glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr));
  if (!window) throw std::runtime_error(glfwErrors());
  glfwMakeContextCurrent(window.get());
  if (gladLoadGL(glfwGetProcAddress) < GLAD_MAKE_VERSION(4, 5))
    throw std::runtime_error("the display's OpenGL is older than 4.5");
  glfwSwapInterval(1);
  return window;
}

/// The first name that no file has: SCENE-1.png, ...
std::filesystem::path freeName(const std::filesystem::path& scene, const char* extension) {
  for (int i = 1;; ++i) {
    std::filesystem::path path = scene.stem().string() + "-" + std::to_string(i) + extension;
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return path;
  }
}

class Window {
 public:
  Window(const WindowStart& start, Exchange& exchange);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window() { exchange_.setWake({}); }
  void run();

 private:
  void wait();
  void take();
  void ask();
  void draw();
  void execute(const PlacedErrand& errand);
  void takeDrop(const std::filesystem::path& path);
  void save(const char* extension);
  void copyCamera();
  void pasteCamera();
  std::string cameraText() const;
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
  std::string status_;
  double statusTime_ = -1.0;
  bool statusWaits_ = false;
  int frames_ = kSettleFrames;  ///< still to be drawn
  double changed_ = -1.0;       ///< when the traced picture was last changed
  std::vector<RenderOptions> askedSides_;
  glm::ivec2 askedSize_{0};
  bool askedMoving_ = false;
  std::deque<std::pair<uint64_t, double>> unanswered_;  ///< requests, and when they were made
};

Window::Window(const WindowStart& start, Exchange& exchange)
    : start_(start),
      exchange_(exchange),
      window_(openWindow(start.options.resolution.value_or(glm::ivec2(1280, 720)),
                         "fragtrace: " + start.options.scene.filename().string())),
      input_(window_.get()),
      interface_(window_.get()) {
  state_.sides[0] = start.options;
  state_.treeBoxes = start.options.treeLevel.has_value();
  state_.treeLevel = start.options.treeLevel.value_or(state_.treeLevel);
  // In a small window the picture would be hidden.
  glm::ivec2 size(0);
  glfwGetFramebufferSize(window_.get(), &size.x, &size.y);
  state_.panel = float(size.x) >= kLeastForPanel * interface_.scale();
  facts_.load = {true, start.options.scene.filename().string(), "starting", 0.0};
  exchange_.setWake([] { glfwPostEmptyEvent(); });
}

void Window::run() {
  while (!glfwWindowShouldClose(window_.get())) {
    wait();
    const double begin = glfwGetTime();
    take();
    if (frames_ > 0 && !iconified()) draw();
    ask();
    writeStatus();
    const double ms = 1000.0 * (glfwGetTime() - begin);
    std::deque<double>& loops = report_.times.loopMs;
    loops.push_back(ms);
    if (loops.size() > kMostTimes) loops.pop_front();
    report_.times.longestLoopMs = std::max(report_.times.longestLoopMs, ms);
  }
}

void Window::wait() {
  double seconds = kLongestSleep;
  const double now = glfwGetTime();
  const auto atMost = [&](double limit) { seconds = std::clamp(limit, 0.0, seconds); };
  if (input_.active()) atMost(kFrameSeconds);
  if (askedMoving_) atMost(changed_ + kMovingSeconds - now);
  if (statusWaits_) atMost(statusTime_ + kStatusSeconds - now);
  if (frames_ > 0 && !iconified()) atMost(0.0);
  if (seconds > 0.0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  if (input_.waiting() || input_.active() || askedMoving_) frames_ = std::max(frames_, kSettleFrames);
}

void Window::say(const std::string& message) {
  facts_.messages.push_back(message);
  if (facts_.messages.size() > kMostMessages) facts_.messages.pop_front();
  frames_ = std::max(frames_, 1);
}

void Window::take() {
  Delivery news = exchange_.take();
  if (news.failure) std::rethrow_exception(news.failure);
  if (news.scene) {
    showScene(state_, std::move(*news.scene));
    glfwSetWindowTitle(window_.get(),
                       ("fragtrace: " + state_.scene->options.scene.filename().string()).c_str());
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
      report_.times.answerMs.push_back(1000.0 * (now - unanswered_.front().second));
      if (report_.times.answerMs.size() > kMostTimes) report_.times.answerMs.pop_front();
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
  const bool changed = news.load.busy != facts_.load.busy || news.load.step != facts_.load.step ||
                       news.load.fraction != facts_.load.fraction || news.note != facts_.note ||
                       news.error != facts_.error || news.resting != facts_.resting;
  if (changed && (state_.scene || news.load.busy || !news.error.empty())) {
    facts_.load = news.load;
    facts_.note = news.note;
    facts_.error = news.error;
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
  const float scale = interface_.scale();
  for (const PlacedErrand& errand : input_.update(state_, scale)) execute(errand);
  for (const std::filesystem::path& path : input_.takeDrops()) takeDrop(path);
  if (drawOverlay(state_, facts_, scale)) {
    exchange_.cancelLoad();
    if (!state_.scene) glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
  }
  if (state_.panel && state_.scene) execute({drawPanel(state_, scale), {}});
  std::array<DisplaySide, 2> sides;
  for (size_t i = 0; i < 2; ++i) sides[i] = {state_.sides[i].exposure, state_.sides[i].toneMap};
  display_.draw(size, sides, state_.split ? state_.bar : 1.0);
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
    case Errand::CopyCamera:
      return copyCamera();
    case Errand::PasteCamera:
      return pasteCamera();
    case Errand::Reload:
      if (state_.scene) exchange_.load(state_.scene->options);
      return;
    case Errand::Screenshot:
      return save(".png");
    case Errand::WriteExr:
      return save(".exr");
    case Errand::Quit:
      glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
      return;
  }
}

void Window::takeDrop(const std::filesystem::path& path) {
  RenderOptions options = state_.scene ? state_.scene->options : start_.options;
  const DroppedFile kind = kindOfDropped(path);
  if (kind == DroppedFile::Scene) {
    options.scene = path;
    options.camera = {};
    options.cameraIndex.reset();
    options.sceneOrigin.reset();
    options.selection = {};
  } else if (kind == DroppedFile::Environment) {
    options.hdriFile = path;
  } else {
    return say(path.filename().string() +
               " is neither a scene (.gltf, .glb) nor an environment (.hdr, .exr, .pfm)");
  }
  exchange_.load(options);
}

void Window::save(const char* extension) {
  if (!state_.scene) return;
  const RenderOptions& o = state_.options();
  exchange_.save({freeName(o.scene, extension), state_.active, o.exposure, o.toneMap});
}

std::string Window::cameraText() const {
  RenderOptions o = renderOptionsOf(state_, state_.active);
  o.resolution = state_.size;
  o.sceneOrigin = state_.scene->description.origin;
  return start_.cameraText(o);
}

void Window::copyCamera() {
  if (!state_.scene) return;
  glfwSetClipboardString(window_.get(), cameraText().c_str());
  say("copied the camera");
}

void Window::pasteCamera() {
  const char* text = glfwGetClipboardString(window_.get());
  if (!state_.scene || !text) return;
  try {
    takeCamera(state_, start_.withCameraText(state_.options(), text));
  } catch (const std::exception& error) {
    say(std::string("cannot paste: ") + error.what());
  }
}

void Window::writeStatus() {
  if (start_.statusFile.empty()) return;
  const double now = glfwGetTime();
  statusWaits_ = now - statusTime_ < kStatusSeconds;
  if (statusWaits_) return;
  report_.camera = state_.scene ? cameraText() : "";
  std::string text = statusText(state_, facts_, report_);
  if (text == status_) return;
  status_ = std::move(text);
  statusTime_ = now;
  replaceFile(start_.statusFile, {reinterpret_cast<const uint8_t*>(status_.data()), status_.size()});
}

/// Says that there is no window, and why, when it cannot be opened.
std::unique_ptr<Window> makeWindow(const WindowStart& start, Exchange& exchange) {
  try {
    return std::make_unique<Window>(start, exchange);
  } catch (const std::exception& error) {
    throw ContextError(std::string("no window: ") + error.what());
  }
}

void runWindow(const WindowStart& start, Exchange& exchange) {
  const std::unique_ptr<Window> window = makeWindow(start, exchange);
  start.opened();
  window->run();
}

}  // namespace

}  // namespace fragtrace

extern "C" const fragtrace::WindowLibrary* fragtraceWindowLibrary() {
  static const fragtrace::WindowLibrary library{fragtrace::runWindow};
  return &library;
}
