// SPDX-License-Identifier: MIT
#include "view/window/dialog/file_dialog.h"

#include <imgui.h>

#include <algorithm>
#include <limits>

#include "view/files/file_uri.h"
#include "view/key_table.h"
#include "view/window/draw/text.h"

namespace fragtrace {

namespace {

constexpr double kPatienceSeconds = 1.5;  // before the user is told what is waited for
constexpr float kListWidth = 620.0f;
constexpr float kListHeight = 460.0f;
constexpr const char* kPopup = "file list";

}  // namespace

void FileDialog::ask(FileQuestion question, const std::string& window, double now) {
  if (list_) return;
  const bool open = desktop_.busy();
  desktop_.giveUp();
  question_ = std::move(question);
  if (open) return showList();
  asked_ = now;
  desktop_.start("portal", [question = question_, window](const std::atomic<bool>& givenUp) {
    return askPortal(question, window, givenUp);
  });
}

void FileDialog::close() {
  desktop_.giveUp();
  reading_.giveUp();
  list_.reset();
}

void FileDialog::showList() {
  list_ = listFor(question_);
  ++field_;
  read(question_.folder);
}

void FileDialog::read(const std::filesystem::path& folder) {
  reading_.start("folder", [folder](const std::atomic<bool>&) { return readFolder(folder); });
}

void FileDialog::follow(const ListStep& step) {
  ++field_;
  scrolls_ = true;
  if (!step.enter.empty()) {
    clearSearch(*list_);
    read(step.enter);
  }
  if (step.take.empty()) return;
  chosen_ = step.take;
  close();
}

void FileDialog::press(int code) {
  if (!list_) return;
  const auto follow = [this](ListKey key) { this->follow(fragtrace::press(*list_, key)); };
  switch (code) {
    case key::kUp:
      return follow(ListKey::Up);
    case key::kDown:
      return follow(ListKey::Down);
    case key::kPageUp:
      return follow(ListKey::PageUp);
    case key::kPageDown:
      return follow(ListKey::PageDown);
    case key::kEnter:
      return follow(ListKey::Accept);
    case key::kBackspace:
      if (list_->text[0] == 0) follow(ListKey::Parent);
      return;
    case key::kEscape:
      return close();
    default:
      return;
  }
}

FileDialog::News FileDialog::take(double now) {
  News news;
  if (desktop_.busy() && now > asked_ + kPatienceSeconds) {
    asked_ = std::numeric_limits<double>::infinity();
    news.message = "waiting for the desktop's dialog; press the key again for a list in this window";
  }
  if (const std::optional<PortalAnswer> answer = desktop_.take()) {
    if (!answer->there) {
      if (!answer->why.empty()) news.message = "the desktop shows no dialog: " + answer->why;
      showList();
      news.changed = true;
    } else if (!answer->uri.empty()) {
      const std::optional<std::filesystem::path> file = fileOfUri(answer->uri);
      if (file)
        chosen_ = *file;
      else
        news.message = answer->uri + " is not a file of this computer";
    }
  }
  if (std::optional<FolderContent> content = reading_.take(); content && list_) {
    takeContent(*list_, std::move(*content));
    scrolls_ = true;
    news.changed = true;
  }
  news.file = std::exchange(chosen_, {});
  return news;
}

void FileDialog::drawField(Places& places) {
  FolderList& list = *list_;
  ImGui::PushID(field_);
  // Whatever was clicked on, keys are for the field. While a button is held it would take the click from what
  // lies below the mouse (Dear ImGui 1.90).
  if (!ImGui::IsAnyItemActive() && !ImGui::IsAnyMouseDown()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1.0f);
  if (ImGui::InputTextWithHint("##name", list.question.save ? "Name" : "Search, or a path", list.text.data(),
                               list.text.size())) {
    findEntries(list);
    scrolls_ = true;
  }
  addItemPlace(places, "file name");
  ImGui::PopID();
}

void FileDialog::drawEntries(Places& places, float height) {
  FolderList& list = *list_;
  ListStep step;
  if (ImGui::BeginChild("entries", {0.0f, height}, true)) {
    const float row = ImGui::GetTextLineHeightWithSpacing();
    if (scrolls_ && list.chosen)
      ImGui::SetScrollY(row * float(*list.chosen) - 0.5f * (ImGui::GetWindowHeight() - row));
    else if (scrolls_)
      ImGui::SetScrollY(0.0f);
    scrolls_ = false;
    ImGuiListClipper clipper;
    clipper.Begin(int(list.shown.size()), row);
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const FolderEntry& entry = list.shown[size_t(i)];
        const std::string text = shownText(entry.name, kMostLineCharacters) + (entry.isFolder ? "/" : "") +
                                 "##" + std::to_string(i);
        if (ImGui::Selectable(text.c_str(), list.chosen == size_t(i),
                              ImGuiSelectableFlags_AllowDoubleClick)) {
          choose(list, size_t(i));
          ++field_;
          if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) step = accept(list);
        }
        addItemPlace(places, "file " + entry.name);
      }
    }
    if (reading_.busy() && list.content.entries.empty())
      ImGui::TextDisabled("reading");
    else if (list.shown.empty()) {
      ImGui::TextDisabled("none here: %s", list.question.filters[list.filter].name.c_str());
      addItemPlace(places, "nothing here");
    }
    if (!list.content.error.empty()) drawText(list.content.error, kMostLineCharacters);
  }
  ImGui::EndChild();
  if (!step.enter.empty() || !step.take.empty()) follow(step);
}

void FileDialog::drawFoot(Places& places) {
  FolderList& list = *list_;
  const std::vector<FileFilter>& filters = list.question.filters;
  if (!list.note.empty()) {
    ImGui::PushTextWrapPos(0.0f);
    drawText(list.note, kMostLineCharacters);
    ImGui::PopTextWrapPos();
  }
  const ImGuiStyle& style = ImGui::GetStyle();
  const char* name = list.question.save ? "Save" : "Open";
  const float buttons = ImGui::CalcTextSize("Cancel").x + ImGui::CalcTextSize(name).x +
                        4 * style.FramePadding.x + 2 * style.ItemSpacing.x;
  ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - buttons, 1.0f));
  if (ImGui::BeginCombo("##filter", filters[list.filter].name.c_str())) {
    for (size_t i = 0; i < filters.size(); ++i) {
      if (!ImGui::Selectable(filters[i].name.c_str(), i == list.filter)) continue;
      list.filter = i;
      findEntries(list);
    }
    ImGui::EndCombo();
  }
  addItemPlace(places, "file filter");
  ImGui::SameLine();
  const bool taken = ImGui::Button(name);
  addItemPlace(places, "file accept");
  ImGui::SameLine();
  const bool closed = ImGui::Button("Cancel");
  addItemPlace(places, "file cancel");
  if (taken) follow(accept(list));
  if (closed) close();
}

void FileDialog::draw(Places& places, const WindowLayout& layout) {
  if (!list_ && !popup_) return;
  if (list_ && !std::exchange(popup_, true)) ImGui::OpenPopup(kPopup);
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(kListWidth * layout.scale, display.x - 2 * layout.margin),
                            std::min(kListHeight * layout.scale, display.y - 2 * layout.margin)});
  if (!ImGui::BeginPopupModal(kPopup, nullptr,
                              ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                  ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    popup_ = false;
    return close();
  }
  // A key, or what was chosen, may have ended it.
  if (list_) drawList(places);
  if (!list_) {
    ImGui::CloseCurrentPopup();
    popup_ = false;
  }
  ImGui::EndPopup();
}

void FileDialog::drawList(Places& places) {
  addWindowPlace(places, "file list");
  ImGui::TextUnformatted(list_->question.title.c_str());
  if (ImGui::Button("Up")) follow(fragtrace::press(*list_, ListKey::Parent));
  addItemPlace(places, "file parent");
  ImGui::SameLine();
  drawText(list_->content.folder.string(), kMostLineCharacters);
  drawField(places);
  // The note may take two lines.
  const float note = list_->note.empty() ? 0.0f : 2 * ImGui::GetTextLineHeightWithSpacing();
  const float foot = ImGui::GetFrameHeightWithSpacing() + note;
  drawEntries(places, -foot);
  // A double click has ended the list, so there is no foot.
  if (list_) drawFoot(places);
}

}  // namespace fragtrace
