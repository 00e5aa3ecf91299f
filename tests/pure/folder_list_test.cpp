// SPDX-License-Identifier: MIT
#include "view/files/folder_list.h"

#include <gtest/gtest.h>

#include <fstream>

#include "image_test_folder.h"
#include "view/files/file_uri.h"

namespace fragtrace {
namespace {

struct FolderLists : ImageTestFolder {
  void add(const std::string& name) const { std::ofstream(folder / name) << "x"; }
};

void type(FolderList& list, const std::string& text) {
  list.text.fill(0);
  text.copy(list.text.data(), list.text.size() - 1);
  findEntries(list);
}

std::vector<std::string> namesOf(const FolderList& list) {
  std::vector<std::string> names;
  for (const FolderEntry& entry : list.shown) names.push_back(entry.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(NaturalOrder, CountsAndIgnoresCase) {
  const Names ordered{"", "a", "A1", "a01", "a2", "a10b", "a10c", "B", "b1", "\xc3\xa9"};
  for (size_t i = 0; i < ordered.size(); ++i) {
    for (size_t j = 0; j < ordered.size(); ++j) {
      // "A1" and "a01" are as good as the same; any order will do that is one.
      if (i + j == 5 && i != j && (i == 2 || i == 3)) continue;
      EXPECT_EQ(naturallyBefore(ordered[i], ordered[j]), i < j) << ordered[i] << ", " << ordered[j];
    }
  }
  EXPECT_NE(naturallyBefore("A1", "a01"), naturallyBefore("a01", "A1"));
  EXPECT_TRUE(naturallyBefore("99999999999999999999998", "99999999999999999999999"));
}

TEST_F(FolderLists, ShowsWhatTheFilterPassesAndTheTextFinds) {
  std::filesystem::create_directories(folder / "models");
  for (const char* name : {"b10.GLB", "B9.gltf", "sky.hdr", ".hidden.glb", "notes.txt"}) add(name);
  FolderList list = listFor(openQuestion(folder, false));
  takeContent(list, readFolder(folder / "models/.."));
  EXPECT_EQ(list.content.folder, folder.lexically_normal());
  EXPECT_EQ(namesOf(list), (Names{"models", "B9.gltf", "b10.GLB", "sky.hdr"}));
  list.filter = 2;
  findEntries(list);
  EXPECT_EQ(namesOf(list), (Names{"models", "sky.hdr"}));
  list.filter = 0;
  type(list, "B1");
  EXPECT_EQ(namesOf(list), Names{"b10.GLB"});
  EXPECT_EQ(accept(list).take, folder / "b10.GLB");
  EXPECT_EQ(openQuestion(folder, true).filters[0].name, "Environments (.hdr, .exr, .pfm)");
  EXPECT_EQ(openQuestion(folder, true).title, "Open an environment");
}

TEST_F(FolderLists, KeysMoveWithinTheEndsAndEnterFolders) {
  std::filesystem::create_directories(folder / "models");
  for (int i = 0; i < 20; ++i) add(std::to_string(i) + ".glb");
  FolderList list = listFor(openQuestion(folder, false));
  EXPECT_TRUE(press(list, ListKey::Down).take.empty());  // nothing is read yet
  takeContent(list, readFolder(folder));
  for (const auto& [key, chosen] : std::vector<std::pair<ListKey, size_t>>{{ListKey::Up, 20},
                                                                           {ListKey::PageUp, 10},
                                                                           {ListKey::PageDown, 20},
                                                                           {ListKey::Down, 20},
                                                                           {ListKey::PageUp, 10},
                                                                           {ListKey::PageUp, 0},
                                                                           {ListKey::Up, 0}}) {
    press(list, key);
    EXPECT_EQ(list.chosen, chosen);
  }
  EXPECT_EQ(press(list, ListKey::Accept).enter, folder / "models");
  EXPECT_EQ(press(list, ListKey::Parent).enter, folder.parent_path());
  add("models/alone.glb");
  takeContent(list, readFolder(folder / "models"));
  EXPECT_EQ(press(list, ListKey::Accept).take, folder / "models/alone.glb");
}

TEST_F(FolderLists, TakesPathsThatAreTyped) {
  std::filesystem::create_directories(folder / "models");
  add("models/a.glb");
  FolderList list = listFor(openQuestion(folder, false));
  takeContent(list, readFolder(folder));
  type(list, "models/a.glb");
  EXPECT_EQ(accept(list).take, folder / "models/a.glb");
  type(list, (folder / "models").string());
  EXPECT_EQ(accept(list).enter, folder / "models");
  type(list, "models/b.glb");
  EXPECT_TRUE(accept(list).take.empty());
  EXPECT_NE(list.note.find("there is no "), std::string::npos) << list.note;
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  if (home.empty()) return;
  type(list, "~/");
  EXPECT_EQ(accept(list).enter, home + "/");
}

TEST_F(FolderLists, AsksBeforeAFileIsReplaced) {
  add("old.png");
  FolderList list = listFor(saveQuestion(folder / "new.png"));
  takeContent(list, readFolder(folder));
  EXPECT_EQ(accept(list).take, folder / "new.png");
  type(list, "old");
  EXPECT_TRUE(accept(list).take.empty());
  EXPECT_NE(list.note.find("old.png is there already"), std::string::npos) << list.note;
  EXPECT_EQ(accept(list).take, folder / "old.png");
  type(list, "new");
  type(list, "old.png");
  EXPECT_TRUE(accept(list).take.empty()) << "asked again after another name";
  for (const char* name : {"new.gif", "away/new.png", ""}) {
    type(list, name);
    EXPECT_TRUE(accept(list).take.empty()) << name;
    EXPECT_EQ(list.note.empty(), *name == 0) << name;
  }
  choose(list, 0);
  EXPECT_STREQ(list.text.data(), "old.png");
}

TEST_F(FolderLists, KeepTheTextThatIsTypedBeforeTheyAreRead) {
  for (const char* name : {"b10.glb", "c.glb"}) add(name);
  FolderList list = listFor(openQuestion(folder, false));
  type(list, "b1");
  takeContent(list, readFolder(folder));
  EXPECT_EQ(namesOf(list), Names{"b10.glb"});
  clearSearch(list);
  takeContent(list, readFolder(folder));
  EXPECT_EQ(namesOf(list), (Names{"b10.glb", "c.glb"}));
  list = listFor(saveQuestion(folder / "new.png"));
  type(list, "mine.png");
  takeContent(list, readFolder(folder));
  clearSearch(list);
  EXPECT_EQ(accept(list).take, folder / "mine.png");
}

TEST_F(FolderLists, SayThatAModelStaysInItsFolder) {
  EXPECT_NE(saveModelQuestion(folder / "a.gltf", true).title.find("in this folder"), std::string::npos);
  EXPECT_EQ(saveModelQuestion(folder / "a.gltf", false).title, "Save the model as");
}

TEST_F(FolderLists, SaysWhyAFolderCannotBeRead) {
  FolderList list = listFor(openQuestion(folder, false));
  takeContent(list, readFolder(folder / "away"));
  EXPECT_FALSE(list.content.error.empty());
  EXPECT_TRUE(list.shown.empty());
  EXPECT_EQ(press(list, ListKey::Parent).enter, folder);
}

TEST(FileUris, AreDecoded) {
  EXPECT_EQ(fileOfUri("file:///a%20b%25/%C3%A9.glb"), "/a b%/\xc3\xa9.glb");
  EXPECT_EQ(fileOfUri("file://localhost/a"), "/a");
  for (const char* uri : {"", "/a", "smb://host/a", "file://host/a", "file:a", "file:///a%2", "file:///a%zz",
                          "file:///a%00b", "file:///a%", "file:///a%+1"})
    EXPECT_FALSE(fileOfUri(uri)) << uri;
}

}  // namespace
}  // namespace fragtrace
