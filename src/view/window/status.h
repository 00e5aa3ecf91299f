// SPDX-License-Identifier: MIT
// The state of the window as JSON, for programs that drive it from outside (docs/viewer.md).
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "view/window/overlay.h"

namespace fragtrace {

/// Delays that a user would notice, in milliseconds.
struct Responsiveness {
  std::deque<double> loopMs;    ///< the event loop's latest turns, without waiting
  std::deque<double> answerMs;  ///< latest times from a change to its first picture
  double longestLoopMs = 0.0;
};

/// Adds one; of 512 the oldest is forgotten.
void keepTime(std::deque<double>& times, double ms);

struct WindowReport {
  uint64_t asked = 0;         ///< the latest request
  uint64_t seen = 0;          ///< the latest change that the tracing thread has seen
  uint64_t answered = 0;      ///< the latest change that a picture shown answers
  uint64_t pictures = 0;      ///< pictures of all sides that came
  uint64_t frames = 0;        ///< frames of the window that were drawn
  std::string camera;         ///< the camera, as options of the command line
  const char* end = nullptr;  ///< "closed" or "failed"; null: the window is open
  std::vector<std::string> glErrors;
  Responsiveness times;
};

/// The text of the status file if no window could be opened.
std::string failureText(const std::string& error);

std::string statusText(const ViewState& state, const ViewFacts& facts, const WindowReport& report);

/// Replaces the file as a whole; nothing where its name is empty. Throws RenderError.
void writeStatusFile(const std::filesystem::path& file, const std::string& text);

}  // namespace fragtrace
