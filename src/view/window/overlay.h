// SPDX-License-Identifier: MIT
// Text over the picture: figures, what was clicked on, messages, errors, progress, the sheet of keys.
#pragma once

#include <array>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gl/gl.h"
#include "view/files.h"
#include "view/pictures.h"
#include "view/shown_text.h"
#include "view/view_state.h"
#include "view/window_layout.h"

namespace fragtrace {

// The places of things in the window, for scripts that click on them (docs/viewer.md).

/// Left, top, width and height by name, in pixels of the window, in the latest frame.
std::map<std::string, std::array<float, 4>>& places();

/// Adds the window of Dear ImGui that is being made.
void addWindowPlace(const std::string& name);

/// Adds the item of Dear ImGui that was made last, and returns what that returned.
bool placed(const std::string& name, bool result = true);

/// The histogram that was drawn last, and of what.
struct ShownHistogram {
  Histogram histogram;
  uint64_t picture = 0;
  size_t side = 0;
  double exposure = 0.0;
};

/// The window's knowledge besides the state that its user sets.
struct ViewFacts {
  std::array<SideStatistics, kMostSides> statistics;
  std::array<glm::ivec2, kMostSides>
      pictureSize{};  ///< size of the pictures shown; lower than the window's while moving
  std::array<std::vector<PictureLine>, kMostSides> lines;
  std::array<PictureValues, kMostSides>
      values;  ///< values under the cursor, of the enlarged area, of the whole
  ShownHistogram histogram;
  std::map<std::filesystem::path, GlTexture> thumbnails;  ///< by environment; empty path: studio
  std::optional<glm::dvec2> cursor;  ///< over the picture: parts of its width and height, from the top left
  TraceStatus trace;
  MessageList messages;
  std::optional<PickAnswer> pick;
  double picturesPerSecond = 0.0;  ///< rate of the first side while something moves; else 0
  bool wantsHistogram = false;     ///< the active side's histogram is shown
  bool wantsThumbnails = false;    ///< the list of environments is open
  bool errorClosed = false;        ///< the user has read the error
  bool asksToSave = false;         ///< the window is to be closed, and numbers are not saved
  bool canUndo = false;
  bool canRedo = false;
  std::string status;  ///< text of the status bar
  Remembered remembered;
  bool dialog = false;               ///< the desktop's dialog for a file is open
  size_t sheetLines = 0;             ///< lines of the sheet that the search has found
  std::vector<Invocation> commands;  ///< commands of the latest frame's widgets
};

/// Draws all of that into Dear ImGui's frame, `now` being seconds of the messages' clock.
void drawOverlay(ViewState& state, ViewFacts& facts, const WindowLayout& layout, double now);

/// The pixels of a side's picture, of that size, that somebody looks at.
PixelArea wantedArea(const ViewState& state, const ViewFacts& facts, size_t side, glm::ivec2 whole);

// The state of the window as JSON, for programs that drive it from outside (docs/viewer.md).

/// Adds one; of 512 the oldest is forgotten.
void keepTime(std::deque<double>& times, double ms);

struct WindowReport {
  uint64_t asked = 0;         ///< the latest request
  uint64_t answered = 0;      ///< the latest change that a picture shown answers
  uint64_t pictures = 0;      ///< pictures of all sides that came
  uint64_t frames = 0;        ///< frames of the window that were drawn
  std::string camera;         ///< the camera, as options of the command line
  const char* end = nullptr;  ///< "closed" or "failed"; null: the window is open
  std::vector<std::string> glErrors;
  // Delays that a user would notice, in milliseconds.
  std::deque<double> loopMs;    ///< the event loop's latest turns, without waiting
  std::deque<double> answerMs;  ///< latest times from a change to its first picture
  double longestLoopMs = 0.0;
};

/// The text of the status file if no window could be opened.
std::string failureText(const std::string& error);

std::string statusText(const ViewState& state, const ViewFacts& facts, const WindowReport& report);

/// Replaces the file as a whole; nothing where its name is empty. Throws RenderError.
void writeStatusFile(const std::filesystem::path& file, const std::string& text);

}  // namespace fragtrace
