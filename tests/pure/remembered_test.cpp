// SPDX-License-Identifier: MIT
#include "view/files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/errors.h"
#include "image_test_folder.h"

namespace fragtrace {
namespace {

struct RememberedFiles : ImageTestFolder {};

TEST_F(RememberedFiles, IsReadAsItWasWritten) {
  const std::filesystem::path file = folder / "deep/er/viewer.json";
  EXPECT_EQ(readRemembered(file), Remembered{});
  Remembered written;
  for (int i = 0; i < 20; ++i) addRecent(written, "/scenes/" + std::to_string(i) + ".glb");
  addRecent(written, "/scenes/15.glb");
  EXPECT_EQ(written.recent.size(), kMostRecent);
  EXPECT_EQ(written.recent[0], "/scenes/15.glb");
  EXPECT_EQ(written.recent[1], "/scenes/19.glb");
  written.bookmarks["/scenes/1.glb"] = {{"a \"name\"", "--camera-index 1"}, {"\xff", ""}};
  writeRemembered(file, written);
  written.bookmarks["/scenes/1.glb"][1].name = "\xEF\xBF\xBD";  // bytes that are no text are replaced
  EXPECT_EQ(readRemembered(file), written);
}

TEST_F(RememberedFiles, OtherFilesAreRefusedAndStay) {
  const std::filesystem::path file = folder / "viewer.json";
  for (const char* text :
       {"", "{", "[]", R"({"recent": 1, "bookmarks": {}})", R"({"recent": [1], "bookmarks": {}})",
        R"({"recent": [], "bookmarks": {"a": [{}]}})"}) {
    std::ofstream(file) << text;
    EXPECT_THROW(readRemembered(file), InputError) << text;
  }
}

TEST(Remembered, NothingIsWrittenWhereThereIsNoFolder) {
  EXPECT_NO_THROW(writeRemembered({}, {}));
  EXPECT_EQ(readRemembered({}), Remembered{});
}

}  // namespace
}  // namespace fragtrace
