// SPDX-License-Identifier: MIT
// Keys and characters in the order in which they were typed, frame by frame.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace fragtrace {

/// A key that goes down, repeats or goes up, or a character that is typed, as GLFW tells it.
struct TypedEvent {
  bool isText = false;
  int code = 0;  ///< code of the key
  int scanCode = 0;
  int action = 0;
  int modifiers = 0;
  uint32_t character = 0;  ///< Unicode, of a text

  bool operator==(const TypedEvent&) const = default;
};

using KeyQueue = std::deque<TypedEvent>;

/// Takes what one frame can be told. A frame sees the characters typed in it without their place among its
/// keys, and nothing of a key that went down and up again within it. So a key that commands ends the frame's
/// events, and waits where characters stand before it.
std::vector<TypedEvent> takeFrame(KeyQueue& queue);

}  // namespace fragtrace
