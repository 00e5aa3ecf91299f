// SPDX-License-Identifier: MIT
#include "base/folder.h"

#include <algorithm>
#include <system_error>

#include "base/text.h"

namespace fragtrace {

namespace {

namespace fs = std::filesystem;

constexpr size_t kMostEntries = 100000;

bool isFigure(char c) { return c >= '0' && c <= '9'; }

/// Removes the number at the front of the text and returns it without leading zeros.
std::string_view takeNumber(std::string_view& text) {
  const size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
  const size_t zeros = std::min(text.find_first_not_of('0'), end);
  const std::string_view number = text.substr(zeros, end - zeros);
  text.remove_prefix(end);
  return number;
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
      content.error = "there are more files than are read";
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

}  // namespace fragtrace
