// SPDX-License-Identifier: MIT
#include "base/worker.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace fragtrace {
namespace {

const WorkerKind kEscapes{"libfragtrace_escapes.so", "tests/faults/escaping_module.cpp", "", ""};

TEST(Worker, CanDoNothingButDecode) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "fragtrace-worker-test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "victim") << "content";
  Worker worker(kEscapes);
  const std::string input = folder.string();
  const WorkResult result = worker.perform({{reinterpret_cast<const uint8_t*>(input.data()), input.size()}},
                                           4096, {.cpuSeconds = 10});
  const std::string seen(result.output.begin(), result.output.end());
  const std::string why = whyUnconfined();
  std::filesystem::remove_all(folder);
  if (!why.empty()) GTEST_SKIP() << "workers have all system calls: " << why;
  EXPECT_EQ(seen, "");
}

}  // namespace
}  // namespace fragtrace
