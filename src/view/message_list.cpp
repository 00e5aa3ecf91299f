// SPDX-License-Identifier: MIT
#include "view/message_list.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fragtrace {

namespace {

constexpr size_t kMostMessages = 16;
constexpr double kWholeSeconds = 10.0;
constexpr double kStepSeconds = 0.1;
constexpr int kSteps = 5;
const std::string kWrote = "wrote ";
const std::string kWriting = "writing ";

/// Steps that have been taken, from 0 (all of it is seen) to kSteps (nothing is).
int stepsOf(const Message& message, double now) {
  if (message.closed) return kSteps;
  const double fading = now - message.latest - kWholeSeconds;
  return std::clamp(int(std::floor(fading / kStepSeconds)) + 1, 0, kSteps);
}

}  // namespace

void addMessage(MessageList& messages, const std::string& text, double now) {
  const std::string promise = text.starts_with(kWrote) ? kWriting + text.substr(kWrote.size()) : "";
  std::erase_if(messages, [&](const Message& message) {
    return message.text == text || (!promise.empty() && message.text.starts_with(promise));
  });
  messages.push_back({.text = text, .latest = now});
  if (messages.size() > kMostMessages) messages.pop_front();
}

void closeMessages(MessageList& messages) {
  for (Message& message : messages) message.closed = true;
}

double opacityOf(const Message& message, double now) { return 1.0 - double(stepsOf(message, now)) / kSteps; }

bool isSeen(const MessageList& messages, const std::string& text, double now) {
  return std::ranges::any_of(messages,
                             [&](const Message& m) { return m.text == text && stepsOf(m, now) < kSteps; });
}

double secondsToFade(const MessageList& messages, double now) {
  double least = std::numeric_limits<double>::infinity();
  for (const Message& message : messages) {
    const int steps = stepsOf(message, now);
    if (steps == kSteps) continue;
    least = std::min(least, message.latest + kWholeSeconds + kStepSeconds * steps - now);
  }
  return std::max(least, 0.0);
}

}  // namespace fragtrace
