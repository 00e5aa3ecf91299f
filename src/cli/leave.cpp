// SPDX-License-Identifier: MIT
#include "cli/leave.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "base/errors.h"
#include "base/report.h"

namespace fragtrace {

namespace {

/// Returns true if standard output is a pipe that nobody reads any more.
bool readerHasLeft() {
  pollfd stream{STDOUT_FILENO, 0, 0};
  return ::poll(&stream, 1, 0) == 1 && (stream.revents & POLLERR) != 0;
}

}  // namespace

bool standardOutputIsClosed() { return (::fcntl(STDOUT_FILENO, F_GETFL) & O_ACCMODE) == O_RDONLY; }

void checkPrinted() {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
  if (readerHasLeft()) std::_Exit(1);  // `| head` is no error to read about
  throw RenderError("cannot write to standard output");
}

int leave(int status) {
  checkPrinted();
  reportEnd(status);
#ifndef __SANITIZE_ADDRESS__
  std::_Exit(status);
#endif
  return status;
}

}  // namespace fragtrace
