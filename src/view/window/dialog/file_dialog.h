// SPDX-License-Identifier: MIT
// Asks the user for a file: by the desktop's dialog, or where there is none, by a list in the window.
#pragma once

#include <string>

#include "view/files/background.h"
#include "view/files/folder_list.h"
#include "view/window/dialog/portal.h"
#include "view/window/draw/places.h"
#include "view/window_layout.h"

namespace fragtrace {

/// The dialog that is open.
enum class DialogKind : uint8_t { None, Desktop, List };

class FileDialog {
 public:
  /// Asks, over a window named as askPortal() takes it. While the desktop's dialog is open, the list takes
  /// its place: that one may not be seen.
  void ask(FileQuestion question, const std::string& window, double now);
  void close();
  DialogKind kind() const {
    return desktop_.busy() ? DialogKind::Desktop : list_ ? DialogKind::List : DialogKind::None;
  }

  /// Handles a key that the list takes, by its code of view/key_table.h.
  void press(int code);

  struct News {
    bool changed = false;        ///< the list is to be drawn again
    std::filesystem::path file;  ///< the chosen file; empty: none
    std::string message;         ///< text for the user; empty: none
  };
  /// Returns the dialog's news since the last call.
  News take(double now);

  /// The list, if that asks.
  void draw(Places& places, const WindowLayout& layout);

 private:
  void showList();
  void read(const std::filesystem::path& folder);
  void follow(const ListStep& step);
  void drawList(Places& places);
  void drawField(Places& places);
  void drawEntries(Places& places, float height);
  void drawFoot(Places& places);

  FileQuestion question_;
  Background<PortalAnswer> desktop_;
  Background<FolderContent> reading_;
  std::optional<FolderList> list_;
  std::filesystem::path chosen_;
  double asked_ = 0.0;    ///< the time at which the desktop was asked, in seconds; infinite: the user knows
  bool popup_ = false;    ///< Dear ImGui has one open for the list
  bool scrolls_ = false;  ///< the next frame scrolls to the chosen entry
  int field_ = 0;         ///< a new value makes Dear ImGui reload the text that is edited
};

}  // namespace fragtrace
