// SPDX-License-Identifier: MIT
#include "base/worker/leaves_first.h"

#include <gtest/gtest.h>
#include <link.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "base/plugin.h"

namespace fragtrace {
namespace {

int loadedObjects() {
  int count = 0;
  const auto add = [](dl_phdr_info* /*info*/, size_t /*size*/, void* sum) {
    ++*static_cast<int*>(sum);
    return 0;
  };
  ::dl_iterate_phdr(add, &count);
  return count;
}

TEST(LeavesFirst, LoadsWhatTheObjectNeedsAndNotTheObject) {
  const int before = loadedObjects();
  loadLeavesFirst(ownFile("libfragtrace_pictures.so"));
  const int after = loadedObjects();
  EXPECT_GT(after, before + 10);
  loadLeavesFirst(ownFile("libfragtrace_pictures.so"));
  EXPECT_EQ(loadedObjects(), after);
}

TEST(LeavesFirst, LeavesOtherFilesAlone) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "fragtrace-broken.so";
  loadLeavesFirst(file);
  std::ifstream whole(ownFile("libfragtrace_pictures.so"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string part = bytes.substr(0, size_t(i) < 100 ? size_t(i) : random() % bytes.size());
    // The headers, and the dynamic section wherever it is.
    for (int j = 0; j < 40 && part.size() > 64; ++j) part[4 + random() % (part.size() - 4)] = char(random());
    for (int j = 0; j < 4 && part.size() > 64; ++j) part[4 + random() % 60] = char(random());
    std::ofstream(file, std::ios::binary | std::ios::trunc) << part;
    loadLeavesFirst(file);
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace fragtrace
