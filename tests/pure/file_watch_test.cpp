// SPDX-License-Identifier: MIT
#include "view/files.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "image_test_folder.h"

namespace fragtrace {
namespace {

void write(const std::filesystem::path& path, const char* text) { std::ofstream(path) << text; }

using FileWatchTest = ImageTestFolder;

TEST_F(FileWatchTest, SeesWhatIsWrittenOnceAndWhatIsGoneForLong) {
  const auto scene = folder / "scene.gltf";
  const auto missing = folder / "missing.bin";
  write(scene, "one");
  FileWatch watch({scene, missing});
  EXPECT_FALSE(watch.changed());
  write(scene, "three");
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
  std::filesystem::remove(scene);
  EXPECT_FALSE(watch.changed());
  write(scene, "other");
  EXPECT_TRUE(watch.changed());
  std::filesystem::remove(scene);
  for (int look = 1; look <= 6; ++look) EXPECT_EQ(watch.changed(), look == 4) << look;  // gone for four looks
  write(scene, "other");
  EXPECT_TRUE(watch.changed());
  write(missing, "there");
  EXPECT_TRUE(watch.changed());
  // The file has the same size, but another time.
  std::filesystem::last_write_time(missing,
                                   std::filesystem::last_write_time(missing) + std::chrono::seconds(2));
  EXPECT_TRUE(watch.changed());
  EXPECT_EQ(filesIn(folder, ".gltf").size(), 1u);
  EXPECT_EQ(filesIn(folder / "none", ".gltf").size(), 0u);
  EXPECT_EQ(filesUnder(folder / "none").size(), 0u);
  std::filesystem::create_directory(folder / "inner");
  std::ofstream(folder / "inner" / "c.glsl") << "c";
  EXPECT_EQ(filesUnder(folder).size(), filesIn(folder, ".gltf").size() + filesIn(folder, ".bin").size() + 1);
}

}  // namespace
}  // namespace fragtrace
