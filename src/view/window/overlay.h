// SPDX-License-Identifier: MIT
// Text over the picture: figures, what was clicked on, messages, errors, progress, the sheet of keys.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "view/message_list.h"
#include "view/pictures.h"
#include "view/remembered.h"
#include "view/view_state.h"
#include "view/window_layout.h"

namespace fragtrace {

// The places of things in the window, for scripts that click on them (docs/viewer.md).

/// Left, top, width and height by name, in pixels of the window.
using Places = std::map<std::string, std::array<float, 4>>;

/// Adds the window of Dear ImGui that is being made.
void addWindowPlace(Places& places, const std::string& name);

/// Adds the item of Dear ImGui that was made last, and returns what that returned.
bool placed(Places& places, const std::string& name, bool result = true);

// The files that were shown before, as a list to choose from.

/// The recent files as they were when the list was opened: the disk is not asked in each frame.
struct RecentFiles {
  std::vector<std::filesystem::path> files;
  std::vector<bool> gone;
  int frame = -1;  ///< Dear ImGui's frame in which the list was drawn last
};

/// The histogram that was drawn last, and of what.
struct ShownHistogram {
  Histogram histogram;
  uint64_t picture = 0;
  size_t side = 0;
  double exposure = 0.0;
};

/// The window's knowledge beside the state that its user sets.
struct ViewFacts {
  std::array<SideStatistics, kMostSides> statistics;
  std::array<glm::ivec2, kMostSides>
      pictureSize{};  ///< size of the pictures shown; lower than the window's while moving
  std::array<std::vector<PictureLine>, kMostSides> lines;
  std::array<PictureValues, kMostSides>
      values;  ///< values under the cursor, of the enlarged area, of the whole
  ShownHistogram histogram;
  std::map<std::filesystem::path, unsigned> thumbnails;  ///< textures by environment; empty path: studio
  std::optional<glm::dvec2> cursor;  ///< over the picture: parts of its width and height, from the top left
  LoadStatus load;
  std::string note;
  std::string error;
  MessageList messages;
  std::optional<PickAnswer> pick;
  double picturesPerSecond = 0.0;  ///< rate of the first side while something moves; else 0
  bool wantsHistogram = false;     ///< the active side's histogram is shown
  bool wantsThumbnails = false;    ///< the list of environments is open
  bool errorClosed = false;        ///< the user has read the error
  bool asksToSave = false;         ///< the window is to be closed, and numbers are not saved
  bool resting = false;
  bool canUndo = false;
  bool canRedo = false;
  std::string status;  ///< text of the status bar
  Remembered remembered;
  RecentFiles recent;
  bool dialog = false;               ///< the desktop's dialog for a file is open
  size_t sheetLines = 0;             ///< lines of the sheet that the search has found
  const char* focus = "picture";     ///< receiver of keys (Interface::focus)
  std::optional<glm::vec2> mouse;    ///< Interface::mouse
  Places places;                     ///< places in the latest frame
  std::vector<Invocation> commands;  ///< commands of the latest frame's widgets
};

/// Draws all of that into Dear ImGui's frame, `now` being seconds of the messages' clock.
void drawOverlay(ViewState& state, ViewFacts& facts, const WindowLayout& layout, double now);

/// The linear value at a place: of a side, or its difference from the other; none if it is not known.
std::optional<glm::dvec3> shownValue(const ViewFacts& facts, size_t side, bool difference,
                                     const glm::dvec2& place);

/// The pixels of a side's picture, of that size, that somebody looks at.
PixelArea wantedArea(const ViewState& state, const ViewFacts& facts, size_t side, glm::ivec2 whole);

/// Returns true if pixels are enlarged enough for values in them.
bool showsPixelValues(const ViewState& state);

/// Writes the linear red, green and blue of the pixels into them, if they are enlarged enough.
void drawPixelValues(const ViewState& state, const ViewFacts& facts, const WindowLayout& layout);

/// Draws the figures at the top left, of one side or of both below each other: what the picture shown has
/// cost, and how good it is.
void drawFigures(const ViewState& state, ViewFacts& facts, const WindowLayout& layout);

/// Draws the status bar below the picture: how good it is, how long it will take, and the pixel under the
/// cursor. What has no room is left out, the least important first.
void drawStatusBar(const ViewState& state, ViewFacts& facts, const WindowLayout& layout);

/// Draws the stages above it in the same way, each a click away, and what is wanted beside them at any time.
void drawStageBar(const ViewState& state, ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
