// SPDX-License-Identifier: MIT
// fragtrace_worker MODULE runs other people's libraries for the program, which starts it with a socket and
// sets its limits. It links none of them; the module does. A module whose name does not end in .so is a
// program that speaks the protocol itself.
#include <dlfcn.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <utility>

#if FRAGTRACE_SECCOMP
#include <seccomp.h>
#endif

#include "base/message.h"
#include "base/worker/leaves_first.h"
#include "base/worker/module.h"

namespace fragtrace {
namespace {

/// Leaves the process the system calls that decoding takes: memory without new code, threads of its own, the
/// clock, and reading and writing of files that are open. All others fail: it opens no file, no socket and no
/// process from now on. Returns why that is not so, such as a kernel that refuses; empty: it is so.
std::string confine();

#if defined(__SANITIZE_ADDRESS__)
std::string confine() { return "its report of errors reads files"; }
#elif FRAGTRACE_SECCOMP
constexpr int kAllowed[] = {
    // memory
    SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise),
    // threads and signals
    SCMP_SYS(futex), SCMP_SYS(set_robust_list), SCMP_SYS(rseq), SCMP_SYS(sched_yield),
    SCMP_SYS(sched_getaffinity), SCMP_SYS(gettid), SCMP_SYS(getpid), SCMP_SYS(rt_sigaction),
    SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(sigaltstack), SCMP_SYS(restart_syscall),
    SCMP_SYS(exit), SCMP_SYS(exit_group),
    // the clock and random numbers
    SCMP_SYS(clock_gettime), SCMP_SYS(clock_getres), SCMP_SYS(gettimeofday), SCMP_SYS(clock_nanosleep),
    SCMP_SYS(nanosleep), SCMP_SYS(getrandom),
    // what is open
    SCMP_SYS(read), SCMP_SYS(write), SCMP_SYS(lseek), SCMP_SYS(fstat), SCMP_SYS(close), SCMP_SYS(recvmsg),
    SCMP_SYS(sendto)};

/// A system call and what one of its arguments must be.
struct Condition {
  int call;
  scmp_arg_cmp argument;
};

int addRules(scmp_filter_ctx filter) {
  const scmp_datum_t thread = CLONE_VM | CLONE_THREAD;
  const Condition conditions[] = {
      {SCMP_SYS(mmap), SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0)},
      {SCMP_SYS(mprotect), SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0)},
      {SCMP_SYS(clone), SCMP_A0(SCMP_CMP_MASKED_EQ, thread, thread)},
      {SCMP_SYS(tgkill), SCMP_A0(SCMP_CMP_EQ, scmp_datum_t(::getpid()))},
  };
  int error = 0;
  for (const int call : kAllowed)
    error = error != 0 ? error : seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0);
  for (const Condition& c : conditions)
    error = error != 0 ? error : seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, c.call, 1, &c.argument);
  // A filter cannot see the flags of clone3. The C library takes clone where there is no clone3.
  return error != 0 ? error : seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
}

std::string confine() {
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (filter == nullptr) return "there is no memory for it";
  // Libraries may have started threads when they were loaded.
  int error = seccomp_attr_set(filter, SCMP_FLTATR_CTL_TSYNC, 1);
  if (error == 0) error = addRules(filter);
  if (error == 0) error = seccomp_load(filter);
  seccomp_release(filter);
  return error == 0 ? "" : std::strerror(-error);
}
#else
std::string confine() { return "fragtrace was built without libseccomp"; }
#endif

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
