// SPDX-License-Identifier: MIT
#include "view/files/folder_list.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "base/text.h"

namespace fragtrace {

namespace {

namespace fs = std::filesystem;

constexpr size_t kMostEntries = 100000;
constexpr std::ptrdiff_t kPage = 10;  // entries

bool isFigure(char c) { return c >= '0' && c <= '9'; }

/// Removes the number at the front of the text and returns it without leading zeros.
std::string_view takeNumber(std::string_view& text) {
  const size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
  const size_t zeros = std::min(text.find_first_not_of('0'), end);
  const std::string_view number = text.substr(zeros, end - zeros);
  text.remove_prefix(end);
  return number;
}

/// The path of a typed name: from the root, from home, or in the folder that is shown.
fs::path typedPath(const FolderList& list) {
  const std::string text = list.text.data();
  const char* home = std::getenv("HOME");
  if (home != nullptr && (text == "~" || text.starts_with("~/")))
    return fs::path(home) / text.substr(std::min<size_t>(2, text.size()));
  return list.content.folder / text;
}

void setListText(FolderList& list, const std::string& text) {
  list.text.fill(0);
  std::memcpy(list.text.data(), text.data(), std::min(text.size(), list.text.size() - 1));
}

ListStep acceptSave(FolderList& list) {
  if (list.text[0] == 0) return {};
  fs::path path = typedPath(list);
  std::error_code error;
  if (fs::is_directory(path, error)) return {.enter = path};
  const FileFilter& filter = list.question.filters.at(list.filter);
  if (path.extension().empty()) path += filter.extensions.front();
  if (!passes(filter, path)) {
    list.note = path.extension().string() + " cannot be written here: " + filter.name;
    return {};
  }
  if (!fs::is_directory(path.parent_path(), error)) {
    list.note = "there is no folder " + path.parent_path().string();
    return {};
  }
  if (!fs::exists(path, error) || list.toReplace == path) return {.take = path};
  list.toReplace = path;
  list.note = path.filename().string() + " is there already: Enter again replaces it";
  return {};
}

}  // namespace

bool naturallyBefore(std::string_view a, std::string_view b) {
  const std::string_view wholeA = a;
  const std::string_view wholeB = b;
  while (!a.empty() && !b.empty()) {
    if (isFigure(a[0]) && isFigure(b[0])) {
      const std::string_view x = takeNumber(a);
      const std::string_view y = takeNumber(b);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
      continue;
    }
    const auto x = static_cast<unsigned char>(lowered(a[0]));
    const auto y = static_cast<unsigned char>(lowered(b[0]));
    if (x != y) return x < y;
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return wholeA < wholeB;
}

FolderContent readFolder(const fs::path& folder) {
  FolderContent content{fs::absolute(folder).lexically_normal(), {}, {}};
  if (content.folder.filename().empty() && content.folder.has_relative_path())
    content.folder = content.folder.parent_path();  // a slash at the end
  std::error_code error;
  for (fs::directory_iterator entry(content.folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (name.starts_with('.')) continue;
    if (content.entries.size() >= kMostEntries) {
      content.error = "there are more files than the list has room for";
      break;
    }
    std::error_code unknown;
    content.entries.push_back({std::move(name), entry->is_directory(unknown)});
  }
  if (error) content.error = error.message();
  std::ranges::sort(content.entries, [](const FolderEntry& a, const FolderEntry& b) {
    return a.isFolder != b.isFolder ? a.isFolder : naturallyBefore(a.name, b.name);
  });
  return content;
}

FolderList listFor(FileQuestion question) {
  FolderList list;
  list.content.folder = question.folder;
  if (question.save) setListText(list, question.name);
  list.question = std::move(question);
  return list;
}

void clearSearch(FolderList& list) {
  if (!list.question.save) setListText(list, {});
}

void takeContent(FolderList& list, FolderContent content) {
  list.content = std::move(content);
  findEntries(list);
  // Enter opens what is alone.
  if (!list.question.save && list.shown.size() == 1) list.chosen = 0;
}

void findEntries(FolderList& list) {
  const std::string wanted = list.question.save ? "" : lowered(list.text.data());
  const FileFilter& filter = list.question.filters.at(list.filter);
  list.shown = list.content.entries;
  std::erase_if(list.shown, [&](const FolderEntry& entry) {
    if (!entry.isFolder && !passes(filter, entry.name)) return true;
    return lowered(entry.name).find(wanted) == std::string::npos;
  });
  list.chosen.reset();
  if (!wanted.empty() && !list.shown.empty()) list.chosen = 0;
  list.note.clear();
  list.toReplace.clear();
}

void choose(FolderList& list, size_t entry) {
  list.chosen = entry;
  list.note.clear();
  list.toReplace.clear();
  if (list.question.save && !list.shown.at(entry).isFolder) setListText(list, list.shown.at(entry).name);
}

ListStep accept(FolderList& list) {
  if (list.chosen) {
    const FolderEntry& entry = list.shown.at(*list.chosen);
    const fs::path path = list.content.folder / entry.name;
    if (entry.isFolder) return {.enter = path};
    if (!list.question.save) return {.take = path};
  }
  if (list.question.save) return acceptSave(list);
  if (list.text[0] == 0) return {};
  const fs::path path = typedPath(list);
  std::error_code error;
  if (fs::is_directory(path, error)) return {.enter = path};
  if (fs::exists(path, error)) return {.take = path};
  list.note = "there is no " + path.string();
  return {};
}

ListStep press(FolderList& list, ListKey key) {
  if (key == ListKey::Accept) return accept(list);
  if (key == ListKey::Parent) return {.enter = list.content.folder.parent_path()};
  if (list.shown.empty()) return {};
  const std::ptrdiff_t step = key == ListKey::Up       ? -1
                              : key == ListKey::Down   ? 1
                              : key == ListKey::PageUp ? -kPage
                                                       : kPage;
  const auto last = std::ptrdiff_t(list.shown.size()) - 1;
  const std::ptrdiff_t from = list.chosen ? std::ptrdiff_t(*list.chosen) : step > 0 ? -1 : last + 1;
  choose(list, size_t(std::clamp<std::ptrdiff_t>(from + step, 0, last)));
  return {};
}

}  // namespace fragtrace
