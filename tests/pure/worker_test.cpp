// SPDX-License-Identifier: MIT
#include "base/worker.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "base/parallel.h"

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

/// Lets this process open only so many more files while it exists.
class FewFiles {
 public:
  explicit FewFiles(int count) {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    int last = -1;
    while (count > 0) count -= ::fcntl(++last, F_GETFD) < 0 ? 1 : 0;
    const rlimit few{rlim_t(last + 1), before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
  }
  ~FewFiles() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  FewFiles(const FewFiles&) = delete;
  FewFiles& operator=(const FewFiles&) = delete;

 private:
  rlimit before_{};
};

TEST(Worker, ThreadsShareAProcessWhereTheSystemGrantsNoOther) {
  Worker worker(kEscapes);
  const std::string input = "/nowhere";
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(input.data()), input.size());
  // Each of two threads needs one for its memory; the first process takes two and keeps one.
  const FewFiles limited(4);
  const auto work = [&](size_t) { EXPECT_NO_THROW(worker.perform({bytes}, 4096, {.cpuSeconds = 10})); };
  forEachIndex(100, work, 2);
}

}  // namespace
}  // namespace fragtrace
