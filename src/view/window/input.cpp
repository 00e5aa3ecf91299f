// SPDX-License-Identifier: MIT
#include "view/window/input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "view/window/interface.h"

namespace fragtrace {

namespace {

constexpr double kDragPixels = 3.0;  // below, a press and its release are a click
constexpr double kDoubleClickSeconds = 0.35;
constexpr double kBarPixels = 8.0;        // either side of the bar that takes hold of it
constexpr double kLongestFrame = 0.1;     // seconds that a held key counts at once
constexpr double kFirstFrame = 1.0 / 60;  // and at first

Input& inputOf(GLFWwindow* window) { return *static_cast<Input*>(glfwGetWindowUserPointer(window)); }

/// Held down, these go on; all else happens once a press.
bool repeats(Action action) {
  return action == Action::Exposure || action == Action::Widen || action == Action::TreeLevel;
}

}  // namespace

Input::Input(GLFWwindow* window) : window_(window) {
  glfwSetWindowUserPointer(window, this);
  glfwSetKeyCallback(window, [](GLFWwindow* w, int code, int, int action, int modifiers) {
    inputOf(w).events_.push_back({Kind::Key, mainKey(code), action, modifiers, {}});
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int code, int action, int modifiers) {
    inputOf(w).events_.push_back({Kind::Button, code, action, modifiers, {}});
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    inputOf(w).events_.push_back({Kind::Cursor, 0, 0, 0, {x, y}});
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
    inputOf(w).events_.push_back({Kind::Wheel, 0, 0, 0, {x, y}});
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    for (int i = 0; i < count; ++i) inputOf(w).drops_.emplace_back(paths[i]);
    inputOf(w).woken_ = true;
  });
  const auto wake = [](GLFWwindow* w) { inputOf(w).woken_ = true; };
  glfwSetWindowRefreshCallback(window, wake);
  glfwSetWindowCloseCallback(window, wake);
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { inputOf(w).woken_ = true; });
  glfwSetWindowIconifyCallback(window, [](GLFWwindow* w, int) { inputOf(w).woken_ = true; });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    // The release of a key that goes to another window is never seen here.
    if (!focused) inputOf(w).held_.clear();
    inputOf(w).woken_ = true;
  });
}

std::vector<std::filesystem::path> Input::takeDrops() { return std::exchange(drops_, {}); }

glm::dvec2 Input::place() const {
  glm::ivec2 size(1);
  glfwGetWindowSize(window_, &size.x, &size.y);
  return cursor_ / glm::dvec2(glm::max(size, 1));
}

void Input::update(ViewState& state, float scale, const RunErrand& run) {
  const ImGuiIO& io = ImGui::GetIO();
  for (const Event& event : std::exchange(events_, {})) {
    switch (event.kind) {
      case Kind::Key:
        if (!io.WantTextInput || event.action == GLFW_RELEASE) key(event, state, run);
        break;
      case Kind::Button:
        if (event.action == GLFW_RELEASE)
          release(event, state, run);
        else if (!io.WantCaptureMouse)
          press(event, state, scale);
        break;
      case Kind::Cursor:
        move(event, state);
        break;
      case Kind::Wheel:
        if (const Control* control = controlFor(Gesture::Wheel, 0, 0); control && !io.WantCaptureMouse)
          apply(state, *control, {.notches = event.value.y});
        break;
    }
  }
  const double now = glfwGetTime();
  for (const Control* control : held_)
    apply(state, *control, {.seconds = std::clamp(now - lastUpdate_, 0.0, kLongestFrame)});
  lastUpdate_ = now;
  woken_ = false;
}

void Input::key(const Event& event, ViewState& state, const RunErrand& run) {
  if (event.action == GLFW_RELEASE) {
    std::erase_if(held_, [&](const Control* c) { return c->code == event.code; });
    return;
  }
  const int modifiers = event.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL);
  const Control* hold = controlFor(Gesture::Hold, event.code, modifiers);
  if (hold && event.action == GLFW_PRESS) {
    // The first moment counts, however soon the key is released.
    apply(state, *hold, {.seconds = kFirstFrame});
    lastUpdate_ = glfwGetTime();
    held_.push_back(hold);
  }
  const Control* control = controlFor(Gesture::Press, event.code, modifiers);
  if (!control || (event.action == GLFW_REPEAT && !repeats(control->action))) return;
  if (control->action == Action::Close && Interface::closePopup()) return;
  const Errand errand = apply(state, *control, {});
  if (errand != Errand::None) run({errand, place()});
}

void Input::press(const Event& event, const ViewState& state, float scale) {
  if (button_.code >= 0) return;
  button_ = {event.code, event.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL), cursor_, false, false};
  glm::ivec2 size(1);
  glfwGetWindowSize(window_, &size.x, &size.y);
  const double away = std::abs(cursor_.x - state.bar * size.x);
  button_.bar = state.split && event.code == GLFW_MOUSE_BUTTON_LEFT && away <= kBarPixels * scale;
}

void Input::release(const Event& event, ViewState& state, const RunErrand& run) {
  if (event.code != button_.code) return;
  const Button button = std::exchange(button_, {});
  if (button.dragging || button.bar) return;
  if (state.split) state.active = place().x >= state.bar ? 1 : 0;
  const double now = glfwGetTime();
  const bool twice = lastClickTime_ >= 0.0 && now - lastClickTime_ <= kDoubleClickSeconds &&
                     glm::length(cursor_ - lastClick_) <= 2.0 * kDragPixels;
  lastClickTime_ = twice ? -1.0 : now;
  lastClick_ = cursor_;
  const Control* control =
      controlFor(twice ? Gesture::DoubleClick : Gesture::Click, button.code, button.modifiers);
  if (!control) return;
  const Errand errand = apply(state, *control, {});
  if (errand != Errand::None) run({errand, place()});
}

void Input::move(const Event& event, ViewState& state) {
  const glm::dvec2 from = std::exchange(cursor_, event.value);
  if (button_.code < 0) return;
  glm::ivec2 size(1);
  glfwGetWindowSize(window_, &size.x, &size.y);
  size = glm::max(size, 1);
  if (button_.bar) {
    state.bar = std::clamp(cursor_.x / size.x, 0.02, 0.98);
    return;
  }
  const bool begins = !button_.dragging && glm::length(cursor_ - button_.start) > kDragPixels;
  button_.dragging = button_.dragging || begins;
  if (!button_.dragging) return;
  const Control* control = controlFor(Gesture::Drag, button_.code, button_.modifiers);
  const glm::dvec2 moved = cursor_ - (begins ? button_.start : from);
  if (control) apply(state, *control, {.drag = moved / double(size.y)});
}

}  // namespace fragtrace
