// SPDX-License-Identifier: MIT
#include "cli/leave.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "errors.h"
#include "process/report.h"

namespace fragtrace {

bool standardOutputIsClosed() { return (::fcntl(STDOUT_FILENO, F_GETFL) & O_ACCMODE) == O_RDONLY; }

void checkPrinted() {
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout))
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
