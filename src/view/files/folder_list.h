// SPDX-License-Identifier: MIT
// The list of a folder's files, by which the window asks for one where the desktop has no dialog for it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "view/files/file_question.h"

namespace fragtrace {

struct FolderEntry {
  std::string name;
  bool isFolder = false;

  bool operator==(const FolderEntry&) const = default;
};

/// The entries of a folder without hidden ones: folders, then files, each in natural order.
struct FolderContent {
  std::filesystem::path folder;  ///< absolute, without . and ..
  std::vector<FolderEntry> entries;
  std::string error;  ///< why they cannot be read, or not all of them
};
FolderContent readFolder(const std::filesystem::path& folder);

/// Numbers in names by their value, letters whatever their case: "part 9.glb" before "Part 10.glb".
bool naturallyBefore(std::string_view a, std::string_view b);

/// The action of a key in the list.
enum class ListKey : uint8_t { Up, Down, PageUp, PageDown, Parent, Accept };

struct FolderList {
  FileQuestion question;
  size_t filter = 0;                ///< index in question.filters
  FolderContent content;            ///< content of the latest read
  std::array<char, 1024> text{};    ///< name to save under, or text to find in names; ends with a 0
  std::vector<FolderEntry> shown;   ///< entries that filter and text leave
  std::optional<size_t> chosen;     ///< index of the chosen entry
  std::string note;                 ///< obstacle to the choice; empty: none
  std::filesystem::path toReplace;  ///< the file that is there already, when the user was asked
};

/// The list asks for a folder to be read, or returns the file that was chosen.
struct ListStep {
  std::filesystem::path enter{};
  std::filesystem::path take{};
};

/// An empty list for the question; its folder is to be read.
FolderList listFor(FileQuestion question);

/// Empties the text to find in names, since another folder will be read. A name to save under stays.
void clearSearch(FolderList& list);

/// Shows what was read. The text stays: it may have been typed since.
void takeContent(FolderList& list, FolderContent content);

/// Must be called after a change of the text or the filter.
void findEntries(FolderList& list);

/// Chooses a shown entry. When saving, its name replaces the typed one.
void choose(FolderList& list, size_t entry);

/// Takes what is chosen or typed: a folder is entered; a file that would be replaced is asked about first.
ListStep accept(FolderList& list);

ListStep press(FolderList& list, ListKey key);

}  // namespace fragtrace
