// SPDX-License-Identifier: MIT
// Text over the picture: figures, what was clicked on, news, errors, progress, the sheet of keys.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>

#include "view/message_list.h"
#include "view/picture/histogram.h"
#include "view/picture/pixel_value.h"
#include "view/remembered.h"
#include "view/view_state.h"
#include "view/window/dialog/file_dialog.h"
#include "view/window/draw/places.h"
#include "view/window/recent_files.h"
#include "view/window_layout.h"

namespace fragtrace {

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
  std::map<std::filesystem::path, unsigned> thumbnails;  ///< textures, of environments; empty: the studio
  std::optional<glm::dvec2> cursor;  ///< over the picture: parts of its width and height, from the top left
  LoadStatus load;
  std::string note;
  std::string error;
  MessageList messages;
  std::optional<PickAnswer> pick;
  double picturesPerSecond = 0.0;  ///< rate of the first side while something moves; else 0
  bool wantsHistogram = false;     ///< the active side's histogram is shown
  bool wantsThumbnails = false;    ///< the list of environments is open
  bool errorClosed = false;        ///< it has been read
  bool resting = false;
  bool canUndo = false;
  bool canRedo = false;
  std::string status;  ///< text of the status bar
  Remembered remembered;
  RecentFiles recent;
  DialogKind dialog = DialogKind::None;
  size_t sheetLines = 0;          ///< lines of the sheet that the search has found
  const char* focus = "picture";  ///< receiver of keys (Interface::focus)
  Places places;                  ///< places in the latest frame
};

/// Draws all of that into Dear ImGui's frame, `now` being seconds of the messages' clock. Returns what is
/// left to be done.
Task drawOverlay(ViewState& state, ViewFacts& facts, const WindowLayout& layout, double now);

}  // namespace fragtrace
