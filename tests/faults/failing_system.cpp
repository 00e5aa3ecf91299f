// SPDX-License-Identifier: MIT
// A library for LD_PRELOAD. It counts the system's calls that fragtrace's own code makes (return addresses in
// the program or in libfragtrace_*.so), makes one of them fail, interrupts them, or delays them. The
// environment says how:
//   FRAGTRACE_SYSTEM_PROGRAM  the program whose calls count and fail: fragtrace or fragtrace_worker
//   FRAGTRACE_SYSTEM_COUNTS   a file that gets the number of calls of each kind, 8 bytes each, as in kKinds
//   FRAGTRACE_SYSTEM_FAIL     KIND,N: the N-th call of that kind fails
//   FRAGTRACE_SYSTEM_EINTR    1: every second call that a signal may interrupt returns EINTR
//   FRAGTRACE_SYSTEM_POWER_CUT  1: a file that is renamed before the disk has it (fsync) is left empty
//   FRAGTRACE_SYSTEM_DELAY    SEED,MICROSECONDS: calls wait at random for at most so long, starts of programs
//                             for ten times as long; locks do so rarely; writes are short
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <poll.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>
#include <string_view>
#include <system_error>

#include "mixed.h"

// The names are glibc's. NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
}
// NOLINTEND(bugprone-reserved-identifier)

/// The function of that name behind this library; looked up once.
// The name is also made a text. NOLINTBEGIN(bugprone-macro-parentheses)
#define REAL(function)                                                                                 \
  ([] {                                                                                                \
    static const auto next = reinterpret_cast<decltype(&function)>(::dlsym(RTLD_NEXT, #function + 2)); \
    return next;                                                                                       \
  }())
// NOLINTEND(bugprone-macro-parentheses)

namespace {

enum Kind { Open, Read, Write, Sync, Rename, Map, Spawn, Thread, Memory, Socket, KindCount };
constexpr std::array<std::string_view, KindCount> kKinds = {"open", "read",  "write",  "fsync",  "rename",
                                                            "mmap", "spawn", "thread", "memory", "socket"};
/// Each kind fails in the first way where N is odd, in the second where it is even.
constexpr std::array<std::array<int, 2>, KindCount> kErrors = {{{EMFILE, EACCES},
                                                                {EIO, EISDIR},
                                                                {ENOSPC, EIO},
                                                                {EIO, EDQUOT},
                                                                {EIO, EACCES},
                                                                {ENOMEM, EAGAIN},
                                                                {EAGAIN, ENOMEM},
                                                                {EAGAIN, EAGAIN},
                                                                {ENOMEM, ENOMEM},
                                                                {EMFILE, ENOMEM}}};

struct Range {
  uintptr_t first = 0;
  uintptr_t last = 0;
};

/// Ranges of code; plain arrays, since nothing here may allocate.
struct Code {
  std::array<Range, 32> ranges{};
  std::atomic<size_t> count = 0;

  bool holds(uintptr_t at) const {
    const size_t n = count;
    for (size_t i = 0; i < n; ++i)
      if (at >= ranges[i].first && at < ranges[i].last) return true;
    return false;
  }
  bool holds(const void* address) const { return holds(reinterpret_cast<uintptr_t>(address)); }
  void add(Range range) {
    if (holds(range.first) || count == ranges.size()) return;
    ranges[count] = range;
    ++count;
  }
};

struct Plan {
  bool counts = false;  ///< this is the program that was named
  Kind failing = KindCount;
  uint64_t failingCall = 0;
  bool interrupts = false;
  bool losesUnsynced = false;
  uint64_t seed = 0;
  long delay = 0;  ///< microseconds
};

Code own;      // fragtrace's
Code between;  // the standard library's, which own code calls
Plan plan;
std::atomic<bool> ready = false;
std::array<std::atomic<uint64_t>, KindCount> unshared;
std::atomic<uint64_t>* counts = unshared.data();
std::atomic<uint64_t> interruptible = 0;
std::atomic<uint64_t> dice = 0;
std::atomic<ino_t> onDisk = 0;  // the file that was synced last, unless something was written since

int addModule(dl_phdr_info* info, size_t, void*) {
  const std::string_view name = info->dlpi_name;
  const bool isMain = name.empty();
  const bool isProgram = std::string_view(program_invocation_short_name).starts_with("fragtrace");
  const bool mine = (isMain && isProgram) || name.find("libfragtrace_") != name.npos;
  const bool standard = name.find("libstdc++") != name.npos || name.find("libc.so") != name.npos;
  for (int i = 0; (mine || standard) && i < info->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = info->dlpi_phdr[i];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
    const uintptr_t first = info->dlpi_addr + part.p_vaddr;
    (mine ? own : between).add({first, first + part.p_memsz});
  }
  return 0;
}

void findModules() { dl_iterate_phdr(addModule, nullptr); }

const char* setting(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

void readPlan() {
  plan.counts = std::string_view(program_invocation_short_name) == setting("FRAGTRACE_SYSTEM_PROGRAM");
  plan.interrupts = *setting("FRAGTRACE_SYSTEM_EINTR") != 0;
  plan.losesUnsynced = *setting("FRAGTRACE_SYSTEM_POWER_CUT") != 0;
  std::sscanf(setting("FRAGTRACE_SYSTEM_DELAY"), "%lu,%ld", &plan.seed, &plan.delay);
  char kind[16] = "";
  std::sscanf(setting("FRAGTRACE_SYSTEM_FAIL"), "%15[a-z],%lu", kind, &plan.failingCall);
  plan.failing = Kind(std::ranges::find(kKinds, kind) - kKinds.begin());
}

void shareCounts() {
  const char* name = setting("FRAGTRACE_SYSTEM_COUNTS");
  if (!plan.counts || *name == 0) return;
  const int file = REAL(::open)(name, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0 || ::ftruncate(file, sizeof unshared) != 0) return;
  void* memory = REAL(::mmap)(nullptr, sizeof unshared, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (memory != MAP_FAILED) counts = static_cast<std::atomic<uint64_t>*>(memory);
  ::close(file);
}

uint64_t roll() { return mixed(plan.seed * 0x9e3779b97f4a7c15u + ++dice * 0xbf58476d1ce4e5b9u); }

/// One time in `rarity` it waits.
void mayWait(uint64_t rarity, long factor = 1) {
  if (plan.delay <= 0) return;
  const uint64_t number = roll();
  if (number % rarity != 0) return;
  const long microseconds = long((number >> 20) % uint64_t(plan.delay * factor + 1));
  const timespec time{microseconds / 1000000, microseconds % 1000000 * 1000};
  const int code = errno;
  ::nanosleep(&time, nullptr);
  errno = code;
}

__attribute__((constructor)) void start() {
  void* frame = nullptr;
  ::backtrace(&frame, 1);  // loads what it needs
  readPlan();
  shareCounts();
  findModules();
  ready = true;
  mayWait(1, 10);
}

/// Returns true if own code called, perhaps through the standard library.
bool isOwn(const void* caller, bool through = true) {
  if (!ready) return false;
  if (own.holds(caller)) return true;
  if (!through || !between.holds(caller)) return false;
  std::array<void*, 12> frames{};
  const int count = ::backtrace(frames.data(), int(frames.size()));
  bool seen = false;
  for (int i = 0; i < count; ++i) {
    if (frames[i] == caller) seen = true;
    if (seen && !between.holds(frames[i])) return own.holds(frames[i]);
  }
  return false;
}

/// Counts a call by fragtrace; true: it must fail, and errno is set.
bool fails(Kind kind) {
  if (!plan.counts) return false;
  const uint64_t number = ++counts[kind];
  if (kind != plan.failing || number != plan.failingCall) return false;
  errno = kErrors[kind][number % 2 == 0 ? 1 : 0];
  return true;
}

/// Empties a file that the disk does not have yet.
void losePart(const char* path) {
  struct stat status {};
  const int code = errno;
  if (::stat(path, &status) == 0 && status.st_ino != onDisk) (void)!::truncate(path, 0);
  errno = code;
}

bool isInterrupted() {
  if (!plan.interrupts || ++interruptible % 2 == 0) return false;
  errno = EINTR;
  return true;
}

}  // namespace

#define CALLER __builtin_return_address(0)
/// The body of a call that own code may see fail; `wrong` is then returned.
#define PASS(kind, interruptible, wrong, function, ...)                    \
  do {                                                                     \
    if (isOwn(CALLER)) {                                                   \
      mayWait(4);                                                          \
      if (fails(kind) || (interruptible && isInterrupted())) return wrong; \
    }                                                                      \
    return REAL(function)(__VA_ARGS__);                                    \
  } while (false)

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  PASS(Open, true, -1, ::open, path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) { PASS(Open, false, nullptr, ::fopen, path, mode); }
FILE* fopen64(const char* path, const char* mode) { PASS(Open, false, nullptr, ::fopen64, path, mode); }
ssize_t read(int file, void* data, size_t size) { PASS(Read, true, -1, ::read, file, data, size); }
int fsync(int file) {
  struct stat status {};
  if (::fstat(file, &status) == 0) onDisk = status.st_ino;
  PASS(Sync, false, -1, ::fsync, file);
}
int fdatasync(int file) { PASS(Sync, false, -1, ::fdatasync, file); }
int rename(const char* from, const char* to) noexcept {
  if (plan.losesUnsynced && isOwn(CALLER)) losePart(from);
  PASS(Rename, false, -1, ::rename, from, to);
}

ssize_t write(int file, const void* data, size_t size) {
  if (plan.losesUnsynced && isOwn(CALLER)) onDisk = 0;
  // A short write is none that failed.
  if (plan.delay > 0 && size > 64 && isOwn(CALLER)) {
    size = size / 2;
    mayWait(1);
  }
  PASS(Write, true, -1, ::write, file, data, size);
}

void* mmap(void* at, size_t size, int access, int flags, int file, off_t offset) noexcept {
  PASS(Map, false, MAP_FAILED, ::mmap, at, size, access, flags, file, offset);
}

int posix_spawnp(pid_t* process, const char* file, const posix_spawn_file_actions_t* actions,
                 const posix_spawnattr_t* attributes, char* const arguments[], char* const environment[]) {
  if (isOwn(CALLER)) {
    mayWait(1, 4);
    if (fails(Spawn)) return errno;
  }
  return REAL(::posix_spawnp)(process, file, actions, attributes, arguments, environment);
}

pid_t fork() noexcept { PASS(Spawn, false, -1, ::fork); }
pid_t waitpid(pid_t process, int* status, int options) {
  if (isOwn(CALLER)) {
    mayWait(4);
    if (isInterrupted()) return -1;
  }
  return REAL(::waitpid)(process, status, options);
}

int socketpair(int domain, int type, int protocol, int sockets[2]) noexcept {
  PASS(Socket, false, -1, ::socketpair, domain, type, protocol, sockets);
}
int pipe2(int files[2], int flags) noexcept { PASS(Socket, false, -1, ::pipe2, files, flags); }
int memfd_create(const char* name, unsigned flags) noexcept {
  PASS(Socket, false, -1, ::memfd_create, name, flags);
}
ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  PASS(Socket, true, -1, ::sendmsg, socket, message, flags);
}
ssize_t send(int socket, const void* data, size_t size, int flags) {
  PASS(Socket, true, -1, ::send, socket, data, size, flags);
}
ssize_t recv(int socket, void* data, size_t size, int flags) {
  PASS(Socket, true, -1, ::recv, socket, data, size, flags);
}
ssize_t recvmsg(int socket, msghdr* message, int flags) {
  if (ready && plan.counts) findModules();  // the worker has opened its module before
  PASS(Socket, true, -1, ::recvmsg, socket, message, flags);
}
int poll(pollfd* files, nfds_t count, int patience) {
  PASS(Socket, true, -1, ::poll, files, count, patience);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  if (ready && plan.delay > 0) mayWait(isOwn(CALLER, false) ? 16 : 1024);
  return REAL(::pthread_mutex_lock)(mutex);
}

void* malloc(size_t size) noexcept {
  return isOwn(CALLER, false) && fails(Memory) ? nullptr : __libc_malloc(size);
}
void* calloc(size_t count, size_t size) noexcept {
  return isOwn(CALLER, false) && fails(Memory) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) noexcept {
  return isOwn(CALLER, false) && fails(Memory) ? nullptr : __libc_realloc(memory, size);
}

// std::thread::_M_start_thread, by which own code starts all its threads.
void startThread(void* thread, void* state, void (*depend)()) asm(
    "_ZNSt6thread15_M_start_threadESt10unique_ptrINS_6_StateESt14default_deleteIS1_EEPFvvE");
void startThread(void* thread, void* state, void (*depend)()) {
  if (isOwn(CALLER)) {
    mayWait(2);
    if (fails(Thread)) throw std::system_error(EAGAIN, std::generic_category());
  }
  using Start = void (*)(void*, void*, void (*)());
  static const auto next = reinterpret_cast<Start>(::dlsym(
      RTLD_NEXT, "_ZNSt6thread15_M_start_threadESt10unique_ptrINS_6_StateESt14default_deleteIS1_EEPFvvE"));
  next(thread, state, depend);
}

}  // extern "C"

void* operator new(size_t size) {
  void* memory = isOwn(CALLER, false) && fails(Memory) ? nullptr : __libc_malloc(std::max<size_t>(size, 1));
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new[](size_t size) {
  void* memory = isOwn(CALLER, false) && fails(Memory) ? nullptr : __libc_malloc(std::max<size_t>(size, 1));
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  return isOwn(CALLER, false) && fails(Memory) ? nullptr : __libc_malloc(std::max<size_t>(size, 1));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, size_t) noexcept { std::free(memory); }
