// SPDX-License-Identifier: MIT
#include "base/worker.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace fragtrace {
namespace {

const WorkerKind kInPython{FRAGTRACE_DOCS "/../src/python/fragtrace_pictures", "the image library", "", ""};
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

/// The worker of the Python package speaks the protocol by structs of its own. Its libraries are stand-ins.
TEST(Worker, InPythonAnswersInTheSameWords) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "fragtrace-python-worker";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "numpy.py") << "";
  std::ofstream(folder / "OpenImageIO.py") << "def attribute(*values): pass\n";
  ::setenv("PYTHONPATH", folder.c_str(), 1);
  Worker worker(kInPython);
  const WorkResult nothing = worker.perform({}, 1, {.cpuSeconds = 10});
  EXPECT_EQ(nothing.output.size(), 0u);
  EXPECT_EQ(whyUnconfined(), "pictures are read by Python's OpenImageIO");
  const std::string broken = "short";
  const std::span<const uint8_t> input(reinterpret_cast<const uint8_t*>(broken.data()), broken.size());
  try {
    worker.perform({input}, 1, {.cpuSeconds = 10});
    FAIL() << "a broken request is answered";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("unpack_from"), std::string::npos) << error.what();
  }
  ::unsetenv("PYTHONPATH");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace fragtrace
