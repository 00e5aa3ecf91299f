// SPDX-License-Identifier: MIT
#include "cli/program.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

#include "base/errors.h"
#include "base/plugin.h"
#include "base/report.h"
#include "base/timeline.h"
#include "cli/command_line.h"
#include "session/interrupt.h"
#include "session/outputs.h"

namespace fragtrace {

namespace {

enum ExitStatus { kDone = 0, kFailed = 1, kUsage = 2, kInput = 3, kNoContext = 4 };

/// Before the tables are made that functions read: they need memory, too.
[[gnu::constructor(101)]] void sayFromTheStart() { sayWhenThrowing(); }

int fail(ExitStatus status, const char* message) {
  reportError(message);
  return status;
}

/// A stream that was closed would else be the first file that is opened, and get what is printed. Standard
/// output is opened for reading, by which standardOutputIsClosed() knows it.
void openClosedStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The lowest free descriptor is the one just found closed.
    if (::fcntl(stream, F_GETFD) < 0)
      (void)::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

int prepareAndRun(const MainFunction& run, int argc, char** argv) {
  openClosedStreams();
  // Writing to a closed pipe, or past the limit of a file, then returns an error, which reaches the user.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  if (asksForJson({argv, size_t(argc)})) reportAsJson(false);
  exitOnInterrupt();
  sayWhenCrashing();
  return run(argc, argv);
}

/// Returns true if standard output is a pipe that nobody reads any more.
bool readerHasLeft() {
  pollfd stream{STDOUT_FILENO, 0, 0};
  return ::poll(&stream, 1, 0) == 1 && (stream.revents & POLLERR) != 0;
}

/// Throws RenderError where standard output could not take all that was printed; ends the process with
/// status 1, without a word, where that is a pipe whose reader has left.
void checkPrinted() {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
  if (readerHasLeft()) std::_Exit(1);  // a reader that leaves early, such as `| head`, needs no error message
  throw RenderError("cannot write to standard output");
}

int statusOf(const MainFunction& run, int argc, char** argv) {
  try {
    const int status = prepareAndRun(run, argc, argv);
    checkPrinted();
    return status;
  } catch (const UsageError& error) {
    return fail(kUsage, error.what());
  } catch (const InputError& error) {
    return fail(kInput, error.what());
  } catch (const ContextError& error) {
    return fail(kNoContext, error.what());
  } catch (const std::bad_alloc&) {
    return fail(kInput, "out of memory");
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) return fail(kFailed, error.what());
    return fail(kFailed,
                "the system grants no further thread, perhaps because memory ran out (ulimit -u, ulimit -v)");
  } catch (const std::exception& error) {
    return fail(kFailed, error.what());
  }
}

}  // namespace

int runProgram(const MainFunction& run, int argc, char** argv) {
  const int status = statusOf(run, argc, argv);
  reportEnd(status);
  endAsMeant();
#ifndef __SANITIZE_ADDRESS__
  // After an error the driver's end may wait for ever (~EglContext).
  if (status != 0) {
    std::cout.flush();
    std::fflush(nullptr);
    std::_Exit(status);
  }
#endif
  return status;
}

std::filesystem::path ownProgram(const std::string& name, const std::string& user) {
  try {
    return ownFile(name);
  } catch (const std::runtime_error& error) {
    throw RenderError(user + ": the program " + error.what() +
                      "; the package fragtrace holds it, and scripts/build makes it");
  }
}

bool standardOutputIsClosed() { return (::fcntl(STDOUT_FILENO, F_GETFL) & O_ACCMODE) == O_RDONLY; }

void writeTimeline() {
  if (const std::optional<TimelineFile> timeline = takeTimeline())
    replaceText(timeline->path, timeline->text);
}

int leave(int status) {
  writeTimeline();
  checkPrinted();
  reportEnd(status);
#ifndef __SANITIZE_ADDRESS__
  std::_Exit(status);
#endif
  return status;
}

}  // namespace fragtrace
