// SPDX-License-Identifier: MIT
#include "view/window/dialog/file_dialog.h"

#include <limits>

#include "view/files/file_uri.h"

namespace fragtrace {

namespace {

constexpr double kPatienceSeconds = 1.5;  // before the user is told what is waited for

}  // namespace

void FileDialog::ask(FileQuestion question, const std::string& window, double now) {
  question_ = std::move(question);
  asked_ = now;
  desktop_.start("portal", [question = question_, window](const std::atomic<bool>& givenUp) {
    return askPortal(question, window, givenUp);
  });
}

FileDialog::News FileDialog::take(double now) {
  News news;
  if (desktop_.busy() && now > asked_ + kPatienceSeconds) {
    asked_ = std::numeric_limits<double>::infinity();
    news.message = "waiting for the desktop's dialog; press the key again for another one";
  }
  const std::optional<PortalAnswer> answer = desktop_.take();
  if (!answer) return news;
  if (!answer->there) {
    news.message = "the desktop shows no dialog for files" + (answer->why.empty() ? "" : ": " + answer->why);
    news.message += question_.save
                        ? "; the file gets a free name"
                        : "; drop a file here, start with its name, or install xdg-desktop-portal-gtk";
    if (question_.save) news.file = question_.folder / question_.name;
  } else if (!answer->uri.empty()) {
    const std::optional<std::filesystem::path> file = fileOfUri(answer->uri);
    if (!file) news.message = answer->uri + " is not a file of this computer";
    news.file = file.value_or(std::filesystem::path());
  }
  return news;
}

}  // namespace fragtrace
