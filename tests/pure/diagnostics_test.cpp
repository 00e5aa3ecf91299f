// SPDX-License-Identifier: MIT
// Tests the lines into which the loader's warnings are joined.
#include "gltf/read/diagnostics.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

using Lines = std::vector<std::string>;

TEST(Diagnostics, WarningsComeInTheirOrderWithFileAndPlace) {
  Diagnostics diagnostics("a.gltf");
  diagnostics.warn("/nodes/0", "is odd");
  diagnostics.warn("", "is large\n");
  EXPECT_EQ(diagnostics.warnings(), (Lines{"a.gltf: /nodes/0: is odd", "a.gltf: is large?"}));
}

TEST(Diagnostics, TheSameReasonIsCountedAtOnePlace) {
  Diagnostics diagnostics("a.gltf");
  diagnostics.warn("/meshes/0", "a normal is mended", 3);
  diagnostics.warn("/meshes/0", "a normal is mended");
  EXPECT_EQ(diagnostics.warnings(), (Lines{"a.gltf: /meshes/0: a normal is mended (4 times)"}));
}

TEST(Diagnostics, AJoinedLineNamesTheFirstPlacesAndCountsTheRest) {
  Diagnostics diagnostics("a.gltf");
  diagnostics.warn("/a", "is odd");
  diagnostics.warn("/b", "is odd", 2);
  EXPECT_EQ(diagnostics.warnings(), (Lines{"a.gltf: /a: is odd (3 times; also at /b)"}));
  for (const char* place : {"/c", "/d", "/e", "/f"}) diagnostics.warn(place, "is odd");
  EXPECT_EQ(diagnostics.warnings(),
            (Lines{"a.gltf: /a: is odd (7 times; also at /b, /c, /d and 2 more places)"}));
}

}  // namespace
}  // namespace fragtrace
