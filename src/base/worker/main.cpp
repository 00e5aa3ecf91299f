// SPDX-License-Identifier: MIT
// fragtrace_worker MODULE runs other people's libraries for the program, which starts it with a socket and
// sets its limits. It links none of them; the module does. A module whose name does not end in .so is a
// program that speaks the protocol itself.
#include <dlfcn.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "base/message.h"
#include "base/worker/confine.h"
#include "base/worker/leaves_first.h"
#include "base/worker/module.h"

namespace fragtrace {
namespace {

bool isStartedByProgram() {
  struct stat status {};
  return ::fstat(kWorkerSocket, &status) == 0 && S_ISSOCK(status.st_mode);
}

WorkFunction* openModule(const char* path) {
  loadLeavesFirst(path);
  void* const module = ::dlopen(path, RTLD_LAZY | RTLD_LOCAL);
  return module == nullptr ? nullptr : reinterpret_cast<WorkFunction*>(::dlsym(module, kWorkFunction));
}

void setReason(WorkReply& reply, const char* reason) {
  std::strncpy(reply.reason, reason, sizeof reply.reason - 1);
}

WorkReply answer(WorkFunction* work, const WorkRequest& request, int file) {
  WorkReply reply;
  try {
    const SharedMemory memory(file, request.outputOffset() + request.outputBytes);
    WorkOutput output{memory.bytes().subspan(request.outputOffset(), request.outputBytes)};
    work(memory.bytes().first(request.inputBytes), output);
    reply.outputBytes = output.used;
    reply.done = 1;
  } catch (const std::bad_alloc&) {
    setReason(reply, "does not fit into memory");
  } catch (const std::exception& error) {
    setReason(reply, error.what());
  }
  return reply;
}

}  // namespace
}  // namespace fragtrace

int main(int argumentCount, char** arguments) {
  using namespace fragtrace;
  if (argumentCount < 2 || !isStartedByProgram()) {
    std::fputs("fragtrace_worker: started by fragtrace, not by hand\n", stderr);
    return 2;
  }
  if (!std::string(arguments[1]).ends_with(".so")) {
    ::execv(arguments[1], arguments + 1);
    return kNotLoaded;
  }
  WorkFunction* const work = openModule(arguments[1]);
  if (work == nullptr) return kNotLoaded;
  WorkOutput nothing;
  work({}, nothing);
  bool opensFiles = argumentCount > 2 && std::string(arguments[2]) == kOpensFiles;
  std::string unconfined = opensFiles ? "" : confine();
  WorkRequest request;
  int file = -1;
  while (receiveWithFile(kWorkerSocket, asMessage(request), file)) {
    WorkReply reply = answer(work, request, file);
    if (std::exchange(opensFiles, false)) unconfined = confine();
    std::strncpy(reply.unconfined, unconfined.c_str(), sizeof reply.unconfined - 1);
    if (::send(kWorkerSocket, &reply, sizeof reply, MSG_NOSIGNAL) != ssize_t(sizeof reply)) break;
  }
  // The libraries' own end is left out: all they have goes with the process.
  ::_exit(0);
}
