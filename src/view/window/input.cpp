// SPDX-License-Identifier: MIT
#include "view/window/input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "view/window/glfw_window.h"

namespace fragtrace {

namespace {

constexpr double kDragPixels = 3.0;  // below, a press and its release are a click
constexpr double kDoubleClickSeconds = 0.35;
constexpr double kBarPixels = 8.0;        // either side of the bar that takes hold of it
constexpr double kLongestFrame = 0.1;     // seconds that a held key counts at once
constexpr double kFirstFrame = 1.0 / 60;  // seconds that it counts at first
constexpr double kShiftFaster = 4.0;

Input& inputOf(GLFWwindow* window) { return *static_cast<Input*>(glfwGetWindowUserPointer(window)); }

/// Held down, these continue; all else happens once a press.
bool repeats(Command command) {
  return command == Command::Exposure || command == Command::Widen || command == Command::TreeLevel;
}

}  // namespace

int labelOf(int code, int scanCode) {
  const bool prints = code > GLFW_KEY_SPACE && code <= GLFW_KEY_WORLD_2;
  const char* name = prints ? glfwGetKeyName(code, scanCode) : nullptr;
  const char letter = name && name[0] != '\0' && name[1] == '\0' ? name[0] : '\0';
  if (letter >= 'a' && letter <= 'z') return letter - 'a' + 'A';
  return letter >= 'A' && letter <= 'Z' ? letter : code;
}

Input::Input(GLFWwindow* window) : window_(window) {
  glfwSetWindowUserPointer(window, this);
  glfwSetKeyCallback(window, [](GLFWwindow* w, int code, int scanCode, int action, int modifiers) {
    inputOf(w).events_.push_back(
        {Kind::Key, mainKey(code), action, modifiers, {}, mainKey(labelOf(code, scanCode))});
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int code, int action, int modifiers) {
    inputOf(w).events_.push_back({Kind::Button, code, action, modifiers, {}});
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    inputOf(w).events_.push_back({Kind::Cursor, 0, 0, 0, {x, y}});
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
    const bool control = glfwGetKey(w, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS ||
                         glfwGetKey(w, GLFW_KEY_RIGHT_CONTROL) == GLFW_PRESS;
    inputOf(w).events_.push_back({Kind::Wheel, 0, 0, control ? kControlModifier : 0, {x, y}});
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    for (int i = 0; i < count; ++i) inputOf(w).drops_.emplace_back(paths[i]);
    inputOf(w).woken_ = true;
  });
  const auto wake = [](GLFWwindow* w, auto...) { inputOf(w).woken_ = true; };
  glfwSetWindowRefreshCallback(window, wake);
  glfwSetWindowCloseCallback(window, wake);
  glfwSetFramebufferSizeCallback(window, wake);
  glfwSetWindowIconifyCallback(window, wake);
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    // The release of a key that goes to another window is never seen here.
    if (!focused) inputOf(w).held_.clear();
    inputOf(w).woken_ = true;
  });
}

glm::dvec2 Input::place() const { return cursor_ / glm::dvec2(layout_.picture); }

std::optional<glm::dvec2> Input::update(ViewState& state, const WindowLayout& layout, const RunCommand& run) {
  layout_ = layout;
  const ImGuiIO& io = ImGui::GetIO();
  for (const Event& event : std::exchange(events_, {})) {
    const bool isPressed = event.kind == Kind::Key || event.kind == Kind::Button;
    presses_ += isPressed && event.action == GLFW_PRESS;
    switch (event.kind) {
      case Kind::Key:
        if (!io.WantTextInput || event.action == GLFW_RELEASE) key(event, state, run);
        break;
      case Kind::Button:
        if (event.action == GLFW_RELEASE)
          release(event, state, run);
        else if (!io.WantCaptureMouse || onEdge())
          press(event, state);
        break;
      case Kind::Cursor:
        move(event, state, run);
        break;
      case Kind::Wheel:
        if (!io.WantCaptureMouse) wheel(event, run);
        break;
    }
  }
  const double now = glfwGetTime();
  const double passed = std::clamp(now - lastUpdate_, 0.0, kLongestFrame);
  for (const Control* control : held_) run(invocationOf(*control, {.seconds = hurry() * passed}));
  lastUpdate_ = now;
  woken_ = false;
  const glm::dvec2 at = place();
  const bool inside =
      glm::all(glm::greaterThanEqual(at, glm::dvec2(0.0))) && glm::all(glm::lessThan(at, glm::dvec2(1.0)));
  return inside && !io.WantCaptureMouse ? std::optional(at) : std::nullopt;
}

/// The factor by which a camera flies faster than its speed.
double Input::hurry() const {
  const bool shift = glfwGetKey(window_, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                     glfwGetKey(window_, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
  return shift ? kShiftFaster : 1.0;
}

void Input::wheel(const Event& event, const RunCommand& run) {
  const int modifiers = event.modifiers;
  const Control* control =
      held_.empty() ? controlFor(Gesture::Wheel, 0, modifiers) : controlFor(Gesture::HoldWheel, 0, 0);
  if (control) run(invocationOf(*control, {.notches = event.value.y, .place = place()}));
}

void Input::key(const Event& event, const ViewState& state, const RunCommand& run) {
  if (event.action == GLFW_RELEASE) {
    std::erase_if(held_, [&](const Control* c) { return c->code == event.code; });
    return;
  }
  // Shortcuts of the desktop.
  if ((event.modifiers & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0) return;
  const int modifiers = event.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL);
  const Control* hold = controlFor(Gesture::Hold, event.code, modifiers & ~kShiftModifier);
  // A key that flies by its place does nothing by its label. The key with the label of such a place stands
  // in: on a French keyboard W is where Z is on a US one.
  const bool standsIn = (modifiers & kControlModifier) == 0 && controlFor(Gesture::Hold, event.label, 0);
  const Control* control =
      hold ? nullptr : controlFor(Gesture::Press, standsIn ? event.code : event.label, modifiers);
  // No key acts behind an open list, and one closes it.
  if (Interface::hasPopup()) {
    if (control && control->command == Command::Close) Interface::closePopup();
    return;
  }
  if (hold && event.action == GLFW_PRESS && isUsable(state, hold->command)) {
    // The first moment counts, however soon the key is released.
    run(invocationOf(*hold, {.seconds = hurry() * kFirstFrame}));
    lastUpdate_ = glfwGetTime();
    held_.push_back(hold);
  }
  if (!control || !isUsable(state, control->command)) return;
  if (event.action == GLFW_REPEAT && !repeats(control->command)) return;
  run(invocationOf(*control, {.place = place()}));
}

/// Events are seen here in their order, and Dear ImGui sees where the cursor is at the end of them: so what
/// is to be dragged quickly is held here.
bool Input::onEdge() const {
  return layout_.docked && cursor_.y < layout_.picture.y &&
         std::abs(cursor_.x - layout_.picture.x) <= kEdgePixels * layout_.scale;
}

void Input::press(const Event& event, const ViewState& state) {
  if (button_.code >= 0) return;
  button_ = {.code = event.code,
             .modifiers = event.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL),
             .start = cursor_};
  button_.edge = event.code == GLFW_MOUSE_BUTTON_LEFT && onEdge();
  const double away = std::abs(place().x - state.bar) * layout_.picture.x;
  button_.bar = state.compares() && state.comparison == CompareMode::Bar &&
                event.code == GLFW_MOUSE_BUTTON_LEFT && away <= kBarPixels * layout_.scale;
}

void Input::release(const Event& event, ViewState& state, const RunCommand& run) {
  if (event.code != button_.code) return;
  const Button button = std::exchange(button_, {});
  if (button.dragging || button.bar || button.edge) return;
  const size_t side = sideAt(state, place());
  if (state.overview && button.code == GLFW_MOUSE_BUTTON_LEFT) {
    const Control* stage = controlOf(Command::StagesUpTo, int(side));
    if (stage) run(invocationOf(*stage));
    return;
  }
  const bool chooses =
      state.tracedCount() == 2 && state.comparison == CompareMode::Bar && state.edit.active != side;
  if (chooses) state.edit.active = side;
  const double now = glfwGetTime();
  const bool twice = lastClickTime_ >= 0.0 && now - lastClickTime_ <= kDoubleClickSeconds &&
                     glm::length(cursor_ - lastClick_) <= 2.0 * kDragPixels;
  lastClickTime_ = twice ? -1.0 : now;
  lastClick_ = cursor_;
  const Control* control =
      controlFor(twice ? Gesture::DoubleClick : Gesture::Click, button.code, button.modifiers);
  // A click that chooses a side selects nothing.
  if (!control || (chooses && control->command == Command::Inspect)) return;
  if (isUsable(state, control->command)) run(invocationOf(*control, {.place = place()}));
}

void Input::move(const Event& event, ViewState& state, const RunCommand& run) {
  const glm::dvec2 from = std::exchange(cursor_, event.value);
  if (button_.code < 0) return;
  if (button_.edge) {
    glm::ivec2 size(1);
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    state.panelWidth = readablePanelWidth(float(size.x - cursor_.x) / layout_.scale);
    return;
  }
  if (button_.bar) {
    state.bar = std::clamp(place().x, 0.02, 0.98);
    return;
  }
  const bool begins = !button_.dragging && glm::length(cursor_ - button_.start) > kDragPixels;
  button_.dragging = button_.dragging || begins;
  if (!button_.dragging) return;
  const Control* control = controlFor(Gesture::Drag, button_.code, button_.modifiers);
  const glm::dvec2 moved = cursor_ - (begins ? button_.start : from);
  if (control) run(invocationOf(*control, {.drag = moved / double(layout_.picture.y)}));
}

}  // namespace fragtrace
