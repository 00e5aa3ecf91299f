// SPDX-License-Identifier: MIT
// A folder of its own for each test, removed with all it holds.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace fragtrace {

struct ImageTestFolder : testing::Test {
  std::filesystem::path folder;

  void SetUp() override {
    const std::string name = std::string("fragtrace-") + std::to_string(::getpid()) + "-" +
                             testing::UnitTest::GetInstance()->current_test_info()->name();
    folder = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  size_t fileCount() const {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) count += entry.exists() ? 1 : 0;
    return count;
  }
};

}  // namespace fragtrace
