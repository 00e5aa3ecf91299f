// SPDX-License-Identifier: MIT
#include "base/folder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "image_test_folder.h"
#include "view/files.h"

namespace fragtrace {
namespace {

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

struct Folders : ImageTestFolder {};

TEST_F(Folders, AreReadWithoutHiddenFilesFoldersFirst) {
  std::filesystem::create_directories(folder / "models");
  for (const char* name : {"b10.GLB", "B9.gltf", "sky.hdr", ".hidden.glb"})
    std::ofstream(folder / name) << "x";
  const FolderContent content = readFolder(folder / "models/..");
  EXPECT_EQ(content.folder, folder.lexically_normal());
  EXPECT_EQ(content.error, "");
  EXPECT_EQ(content.entries,
            (std::vector<FolderEntry>{
                {"models", true}, {"B9.gltf", false}, {"b10.GLB", false}, {"sky.hdr", false}}));
}

TEST_F(Folders, SayWhyTheyCannotBeRead) {
  const FolderContent content = readFolder(folder / "away");
  EXPECT_FALSE(content.error.empty());
  EXPECT_TRUE(content.entries.empty());
}

TEST(FileQuestions, HaveFiltersAndTitles) {
  const FileQuestion environment = openQuestion("/", true);
  EXPECT_EQ(environment.title, "Open an environment");
  EXPECT_EQ(environment.filters[0].name, "Environments (.hdr, .exr, .pfm)");
  EXPECT_TRUE(passes(openQuestion("/", false).filters[0], "b10.GLB"));
  EXPECT_FALSE(passes(environment.filters[0], "b10.glb"));
  EXPECT_NE(saveModelQuestion("/a.gltf", true).title.find("in this folder"), std::string::npos);
  EXPECT_EQ(saveModelQuestion("/a.gltf", false).title, "Save the model as");
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
