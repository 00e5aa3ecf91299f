// SPDX-License-Identifier: MIT
// The desktop's dialog for files, by its portal (XDG Desktop Portal: org.freedesktop.portal.FileChooser).
#pragma once

#include <string>

#include "view/background.h"
#include "view/files.h"

namespace fragtrace {

// Asks the user for a file by the desktop's dialog.

class FileDialog {
 public:
  /// Asks, over a window ("x11:" and its number in hexadecimal; empty: over none). A dialog that is open is
  /// closed: it may not be seen.
  void ask(FileQuestion question, const std::string& window, double now);
  bool open() const { return desktop_.busy(); }
  /// The latest question.
  const FileQuestion& question() const { return question_; }

  struct Answer {
    std::filesystem::path file;  ///< the chosen file; empty: none
    std::string message;         ///< text for the user; empty: none
  };
  /// Returns the dialog's answer since the last call. Without a dialog, a file is saved under the question's
  /// name.
  Answer take(double now);

 private:
  FileQuestion question_;
  Background<Answer> desktop_;
  double asked_ = 0.0;  ///< the time at which the desktop was asked, in seconds; infinite: the user knows
};

}  // namespace fragtrace
