// SPDX-License-Identifier: MIT
// From what GLFW reports to the controls of the table.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "view/view_state.h"

struct GLFWwindow;

namespace fragtrace {

/// An errand, and where the cursor was: parts of width and height, from the top left.
struct PlacedErrand {
  Errand errand = Errand::None;
  glm::dvec2 place{0.0};
};

using RunErrand = std::function<void(const PlacedErrand&)>;

class Input {
 public:
  /// Takes over the window's callbacks; to be made before Dear ImGui, which passes on what it gets.
  explicit Input(GLFWwindow* window);
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// Applies what has happened since the last call, in its order, and gives `run` the errands among it; to be
  /// called inside Dear ImGui's frame, which knows by then whether mouse and keys are its own. `scale`: as
  /// for the panel.
  void update(ViewState& state, float scale, const RunErrand& run);

  /// Whether anything has happened since the last update().
  bool waiting() const { return !events_.empty() || woken_; }
  /// Whether a key is held or something dragged, so that the next frame is not the last.
  bool active() const { return !held_.empty() || button_.code >= 0; }
  std::vector<std::filesystem::path> takeDrops();

 private:
  enum class Kind : uint8_t { Key, Button, Cursor, Wheel };
  struct Event {
    Kind kind = Kind::Key;
    int code = 0;
    int action = 0;
    int modifiers = 0;
    glm::dvec2 value{0.0};  ///< the cursor's place, or the wheel's notches
  };
  struct Button {
    int code = -1;  ///< none is down
    int modifiers = 0;
    glm::dvec2 start{0.0};
    bool dragging = false;
    bool bar = false;  ///< that of the split view is dragged
  };

  void key(const Event& event, ViewState& state, const RunErrand& run);
  void press(const Event& event, const ViewState& state, float scale);
  void release(const Event& event, ViewState& state, const RunErrand& run);
  void move(const Event& event, ViewState& state);
  glm::dvec2 place() const;

  GLFWwindow* window_;
  std::vector<Event> events_;
  std::vector<std::filesystem::path> drops_;
  std::vector<const Control*> held_;
  Button button_;
  glm::dvec2 cursor_{0.0};
  glm::dvec2 lastClick_{0.0};
  double lastClickTime_ = -1.0;  ///< seconds; negative: the next click is the first
  double lastUpdate_ = 0.0;
  bool woken_ = true;
};

}  // namespace fragtrace
