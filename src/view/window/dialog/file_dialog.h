// SPDX-License-Identifier: MIT
// Asks the user for a file by the desktop's dialog.
#pragma once

#include <string>

#include "view/files/background.h"
#include "view/window/dialog/portal.h"

namespace fragtrace {

class FileDialog {
 public:
  /// Asks, over a window named as askPortal() takes it. A dialog that is open is closed: it may not be seen.
  void ask(FileQuestion question, const std::string& window, double now);
  bool open() const { return desktop_.busy(); }
  /// The latest question.
  const FileQuestion& question() const { return question_; }

  struct News {
    std::filesystem::path file;  ///< the chosen file; empty: none
    std::string message;         ///< text for the user; empty: none
  };
  /// Returns the dialog's news since the last call. Without a dialog, a file is saved under the question's
  /// name.
  News take(double now);

 private:
  FileQuestion question_;
  Background<PortalAnswer> desktop_;
  double asked_ = 0.0;  ///< the time at which the desktop was asked, in seconds; infinite: the user knows
};

}  // namespace fragtrace
