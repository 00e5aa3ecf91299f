// SPDX-License-Identifier: MIT
#include "view/dropped_file.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

TEST(DroppedFile, IsToldByItsExtension) {
  for (const char* name : {"a.gltf", "b.GLB", "dir.hdr/c.Gltf"})
    EXPECT_EQ(kindOfDropped(name), DroppedFile::Scene) << name;
  for (const char* name : {"a.hdr", "b.EXR", "c.pfm"})
    EXPECT_EQ(kindOfDropped(name), DroppedFile::Environment) << name;
  for (const char* name : {"a.png", "gltf", "", "folder", "x.gltf.bak"})
    EXPECT_EQ(kindOfDropped(name), DroppedFile::Unknown) << name;
}

}  // namespace
}  // namespace fragtrace
