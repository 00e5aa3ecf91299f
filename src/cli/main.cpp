// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <new>
#include <system_error>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/leave.h"
#include "errors.h"

namespace {

enum ExitStatus { kDone = 0, kFailed = 1, kUsage = 2, kInput = 3, kNoContext = 4 };

int fail(ExitStatus status, const char* message) {
  std::fprintf(stderr, "fragtrace: %s\n", message);
  return status;
}

/// A stream that was closed would else be the first file that is opened, and get what is printed.
void openClosedStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The lowest free descriptor is the one just found closed.
    if (::fcntl(stream, F_GETFD) < 0) (void)::open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY);
  }
}

int run(int argc, char** argv) {
  using namespace fragtrace;
  openClosedStreams();
  // A full pipe or file gives an error where it is written to, which reaches the user.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  exitOnInterrupt();
  sayWhenCrashing();
  const std::optional<CommandLine> line = parseCommandLine(argc, argv);
  if (!line) return kDone;
  switch (line->command) {
    case Command::Render:
      return runRender(line->render);
    case Command::View:
      return runView(line->view);
    case Command::Info:
      return runInfo(line->info);
    case Command::Diff:
      return runDiff(line->diff);
    case Command::Merge:
      return runMerge(line->merge);
    case Command::Denoise:
      return runDenoise(line->denoise);
    case Command::BenchError:
      return runBenchError(line->benchError);
    case Command::BenchFrame:
      return runBenchFrame(line->benchFrame);
    case Command::BenchReport:
      return runBenchReport(line->benchReport);
    case Command::BenchVariants:
      return runBenchVariants(line->benchVariants);
    case Command::BenchScale:
      return runBenchScale(line->benchScale);
    case Command::BenchTraversal:
      return runBenchTraversal(line->benchTraversal);
    case Command::BenchStart:
      return runBenchStart(line->benchStart);
    case Command::BenchStress:
      return runBenchStress(line->benchStress);
  }
  return kUsage;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int status = run(argc, argv);
    fragtrace::checkPrinted();
    return status;
  } catch (const fragtrace::UsageError& error) {
    return fail(kUsage, error.what());
  } catch (const fragtrace::InputError& error) {
    return fail(kInput, error.what());
  } catch (const fragtrace::ContextError& error) {
    return fail(kNoContext, error.what());
  } catch (const std::bad_alloc&) {
    return fail(kInput, "out of memory");
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) return fail(kFailed, error.what());
    return fail(kFailed,
                "the system grants no further thread, perhaps for want of memory (ulimit -u, ulimit -v)");
  } catch (const std::exception& error) {
    return fail(kFailed, error.what());
  }
}
