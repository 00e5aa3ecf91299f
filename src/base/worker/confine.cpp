// SPDX-License-Identifier: MIT
#include "base/worker/confine.h"

#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#if FRAGTRACE_SECCOMP
#include <seccomp.h>
#endif

namespace fragtrace {

#if defined(__SANITIZE_ADDRESS__)
std::string confine() { return "its report of errors reads files"; }
#elif FRAGTRACE_SECCOMP
namespace {

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

}  // namespace

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

}  // namespace fragtrace
