// SPDX-License-Identifier: MIT
// The desktop's dialog for files, by its portal (XDG Desktop Portal: org.freedesktop.portal.FileChooser).
#pragma once

#include <atomic>
#include <string>

#include "view/files/file_question.h"

namespace fragtrace {

struct PortalAnswer {
  bool there = false;  ///< the desktop has shown a dialog
  std::string why;     ///< the reason why it has not; empty: there is no portal
  std::string uri;     ///< the choice; empty: none
};

/// Shows the dialog over a window ("x11:" and its number in hexadecimal; empty: over none) and waits until
/// the user has answered, or `givenUp` is true: then the dialog is closed. Does not throw.
PortalAnswer askPortal(const FileQuestion& question, const std::string& window,
                       const std::atomic<bool>& givenUp);

}  // namespace fragtrace
