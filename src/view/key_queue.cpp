// SPDX-License-Identifier: MIT
#include "view/key_queue.h"

#include "view/key_table.h"

namespace fragtrace {

namespace {

// GLFW's numbers.
constexpr int kPress = 1;
constexpr int kFirstOther = 256;  // the first that types no character
constexpr int kFirstModifier = 340;
constexpr int kLastModifier = 347;
constexpr int kLeftControl = 341;
constexpr int kRightControl = 345;

bool isPress(const TypedEvent& event) { return !event.isText && event.action == kPress; }

/// Does something rather than type.
bool commands(const TypedEvent& event) {
  const bool modifies = event.code >= kFirstModifier && event.code <= kLastModifier;
  return isPress(event) && !modifies &&
         (event.code >= kFirstOther || (event.modifiers & kControlModifier) != 0);
}

}  // namespace

std::vector<TypedEvent> takeFrame(KeyQueue& queue) {
  std::vector<TypedEvent> events;
  bool text = false;
  while (!queue.empty()) {
    const TypedEvent event = queue.front();
    // While Ctrl is held, characters do not count.
    const bool control = isPress(event) && (event.code == kLeftControl || event.code == kRightControl);
    if (text && (control || commands(event))) break;
    queue.pop_front();
    events.push_back(event);
    text = text || event.isText;
    if (commands(event)) break;
  }
  return events;
}

}  // namespace fragtrace
