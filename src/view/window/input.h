// SPDX-License-Identifier: MIT
// From what GLFW reports to the controls of the table.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "view/view_state.h"
#include "view/window_layout.h"

struct GLFWwindow;

namespace fragtrace {

/// Either side of the edge between picture and panel, that takes hold of it; at 96 dots an inch.
inline constexpr float kEdgePixels = 5.0f;

/// Returns the Latin letter on a key in the user's layout, as GLFW's code; if there is none, the place
/// `code`.
int labelOf(int code, int scanCode);

using RunCommand = std::function<void(const Invocation&)>;

class Input {
 public:
  /// Takes over the window's callbacks; to be made before Dear ImGui, which passes on what it gets.
  explicit Input(GLFWwindow* window);
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// Gives `run` the commands of what has happened since the last call, in its order; to be
  /// called inside Dear ImGui's frame, which knows by then whether mouse and keys are its own. Returns where
  /// the cursor is over the picture, parts of its width and height from the top left.
  std::optional<glm::dvec2> update(ViewState& state, const WindowLayout& layout, const RunCommand& run);

  /// Returns true if anything has happened since the last update().
  bool waiting() const { return !events_.empty() || woken_; }
  /// Returns true if a key is held or something dragged, so that the next frame is not the last.
  bool active() const { return !held_.empty() || button_.code >= 0; }
  std::vector<std::filesystem::path> takeDrops() { return std::exchange(drops_, {}); }
  /// The number of keys and buttons that have been pressed so far.
  int presses() const { return presses_; }

 private:
  enum class Kind : uint8_t { Key, Button, Cursor, Wheel };
  struct Event {
    Kind kind = Kind::Key;
    int code = 0;
    int action = 0;
    int modifiers = 0;
    glm::dvec2 value{0.0};  ///< the cursor's place, or the wheel's notches
    int label = 0;          ///< labelOf() of a key; `code` is its place
  };
  struct Button {
    int code = -1;  ///< none is down
    int modifiers = 0;
    glm::dvec2 start{0.0};
    bool dragging = false;
    bool bar = false;   ///< the split view's bar is dragged
    bool edge = false;  ///< the panel's edge is dragged
  };

  void key(const Event& event, const ViewState& state, const RunCommand& run);
  void press(const Event& event, const ViewState& state);
  void release(const Event& event, ViewState& state, const RunCommand& run);
  void move(const Event& event, ViewState& state, const RunCommand& run);
  void wheel(const Event& event, const RunCommand& run);
  double hurry() const;
  bool onEdge() const;
  /// The place of the cursor, in parts of the picture.
  glm::dvec2 place() const;

  GLFWwindow* window_;
  std::vector<Event> events_;
  std::vector<std::filesystem::path> drops_;
  std::vector<const Control*> held_;
  Button button_;
  glm::dvec2 cursor_{-1.0};  ///< pixels, as Interface hands them on; outside, until it has moved
  glm::dvec2 lastClick_{0.0};
  double lastClickTime_ = -1.0;  ///< seconds; negative: the next click is the first
  double lastUpdate_ = 0.0;
  bool woken_ = true;
  int presses_ = 0;
  WindowLayout layout_;  ///< layout at the latest update()
};

}  // namespace fragtrace
