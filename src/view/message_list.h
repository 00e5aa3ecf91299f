// SPDX-License-Identifier: MIT
// The messages of the viewer: each text once, for some seconds.
#pragma once

#include <deque>
#include <string>

namespace fragtrace {

struct Message {
  std::string text;
  double latest = 0.0;  ///< the time of the latest repetition, seconds
  bool closed = false;
};

/// The latest last; at most 16, older ones are forgotten.
using MessageList = std::deque<Message>;

/// A text that is there already moves to the end. "wrote FILE" takes the place of "writing FILE ...".
void addMessage(MessageList& messages, const std::string& text, double now);

void closeMessages(MessageList& messages);

/// Returns true if that text is there, and still seen.
bool isSeen(const MessageList& messages, const std::string& text, double now);

/// The opacity of a message, 0..1: it fades in steps, which cost one frame each.
double opacityOf(const Message& message, double now);

/// Seconds until one of them is seen less; infinite when none is seen.
double secondsToFade(const MessageList& messages, double now);

}  // namespace fragtrace
