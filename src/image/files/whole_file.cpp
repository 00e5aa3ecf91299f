// SPDX-License-Identifier: MIT
#include "image/files/whole_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <system_error>

#include "base/errors.h"
#include "base/text.h"

namespace fragtrace {

namespace {

/// The errno of the first failing call, or 0.
int writeAll(int file, std::span<const uint8_t> bytes) {
  int error = 0;
  while (!bytes.empty() && error == 0) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written >= 0)
      bytes = bytes.subspan(size_t(written));
    else if (errno != EINTR)
      error = errno;
  }
  return error;
}

/// Waits until the disk has the file: a power cut after it is renamed could leave an empty one. Returns the
/// errno, or 0; some file systems know no such call.
int keepOnDisk(int file) {
  while (::fsync(file) != 0) {
    if (errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP) return 0;
    if (errno != EINTR) return errno;
  }
  return 0;
}

int writeAndClose(int file, std::span<const uint8_t> bytes, Kept kept) {
  int error = writeAll(file, bytes);
  if (error == 0 && kept == Kept::OnDisk) error = keepOnDisk(file);
  // Network file systems report a full disk only here.
  if (::close(file) != 0 && error == 0) error = errno;
  return error;
}

/// True for a device, a pipe or a socket: what is written to and not replaced.
bool takesWrites(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

/// The place behind symbolic links, whether or not anything is there yet.
std::filesystem::path behindLinks(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // the kernel follows as many
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, error); ++i) {
    const auto target = std::filesystem::read_symlink(path, error);
    path = path.parent_path() / target;  // an absolute target replaces the folder
  }
  return path;
}

/// While an object of this class exists, a handler of signals knows the part.
class NamedPart {
 public:
  explicit NamedPart(const std::filesystem::path& part) {
    const std::string name = std::filesystem::absolute(part).string();
    if (name.size() >= partBeingWritten.size()) return;
    // The first character comes last, since a handler may look at any time.
    std::copy(name.begin() + 1, name.end(), partBeingWritten.begin() + 1);
    partBeingWritten[name.size()] = '\0';
    std::atomic_signal_fence(std::memory_order_seq_cst);
    partBeingWritten[0] = name[0];
  }
  ~NamedPart() { partBeingWritten[0] = '\0'; }
  NamedPart(const NamedPart&) = delete;
  NamedPart& operator=(const NamedPart&) = delete;
};

std::filesystem::path folderOf(const std::filesystem::path& target) {
  return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
}

RenderError cannotWrite(const std::filesystem::path& path, int code) {
  std::error_code error;
  const std::filesystem::path folder = folderOf(path);
  const bool missing = code == ENOENT && !std::filesystem::exists(folder, error);
  return RenderError("cannot write " + path.string() + ": " + systemReason(code) +
                     (missing ? ": there is no folder " + folder.string() : ""));
}

/// Throws the reason in `code` if that is not 0. Then, and if the name cannot be changed, the part is
/// removed.
void renamePart(const std::filesystem::path& path, int code) {
  const std::filesystem::path part = partOf(path);
  filesMayBeWritten = 1;
  if (code == 0 && ::rename(part.c_str(), behindLinks(path).c_str()) != 0) code = errno;
  if (code == 0) return;
  ::unlink(part.c_str());
  throw cannotWrite(path, code);
}

/// The beginning of the names of a file's parts, next to what symbolic links lead to: .NAME.
std::filesystem::path beginningOfParts(const std::filesystem::path& path) {
  // A name may be as long as the file system allows (255 bytes); its part must then be cut.
  constexpr size_t kMaximumNameLength = 220;
  const std::filesystem::path target = behindLinks(path);
  return target.parent_path() / ("." + target.filename().string().substr(0, kMaximumNameLength) + ".");
}

/// -MACHINE.part, by which parts of processes with one number differ where machines or containers share a
/// folder.
const std::string& endOfParts() {
  static const std::string theOne = [] {
    std::string machine(256, '\0');
    ::gethostname(machine.data(), machine.size());
    std::string boot;
    std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
    std::error_code unknown;
    machine += boot + std::filesystem::read_symlink("/proc/self/ns/pid", unknown).string();
    return formatted("-%08x.part", uint32_t(std::hash<std::string>()(machine)));
  }();
  return theOne;
}

}  // namespace

std::filesystem::path partOf(const std::filesystem::path& path) {
  return beginningOfParts(path) += std::to_string(::getpid()) + endOfParts();
}

void removeParts(const std::filesystem::path& path, PartsOf whose) {
  const std::filesystem::path beginning = beginningOfParts(path);
  const std::string first = beginning.filename().string();
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folderOf(beginning), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(first) || !name.ends_with(".part")) continue;
    const std::string behind =
        name.substr(std::min(name.size(), name.find_first_not_of("0123456789", first.size())));
    const int process = std::atoi(name.c_str() + first.size());
    const bool hasEnded = behind == endOfParts() && process > 0 && ::kill(process, 0) != 0 && errno == ESRCH;
    if (hasEnded || whose == PartsOf::All) ::unlink(entry->path().c_str());
  }
}

void takePart(const std::filesystem::path& path) {
  const std::filesystem::path part = partOf(path);
  const int file = ::open(part.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  const int code = file < 0 ? errno : keepOnDisk(file);
  if (file >= 0) ::close(file);
  renamePart(path, code);
}

std::vector<uint8_t> readOpenFile(int file, const MemoryBudget& memory, const BeginningCheck& check,
                                  const ReadProgress& progress) {
  struct Closing {
    int file;
    ~Closing() { ::close(file); }
  } const closing{file};
  struct stat status {};
  if (::fstat(file, &status) != 0) throw std::runtime_error("cannot be read: " + systemReason(errno));
  if (S_ISDIR(status.st_mode)) throw std::runtime_error("is a folder, not a file");
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode))
    throw std::runtime_error("is a device, neither a file nor a pipe");

  // The size is only a hint: a pipe has none, and a file may grow meanwhile.
  const uint64_t size = S_ISREG(status.st_mode) ? uint64_t(status.st_size) : 0;
  constexpr size_t kBlock = 1 << 16;
  constexpr size_t kMostAtOnce = 1 << 24;  // between two calls of `progress`
  uint64_t most = std::numeric_limits<uint64_t>::max();
  bool isChecked = !check;
  uint64_t told = 0;
  std::vector<uint8_t> bytes;
  for (;;) {
    MemoryBudget(memory).take(std::max(size, uint64_t(bytes.size())));
    const size_t before = bytes.size();
    if (isChecked && size > before) bytes.reserve(size_t(std::min(size + 1, most)));
    const size_t room = isChecked && bytes.capacity() > before ? bytes.capacity() : before + kBlock;
    bytes.resize(size_t(std::min<uint64_t>({room, most, before + kMostAtOnce})));
    const ssize_t count = ::read(file, bytes.data() + before, bytes.size() - before);
    const int code = errno;
    bytes.resize(before + size_t(std::max<ssize_t>(count, 0)));
    if (count < 0 && code != EINTR) throw std::runtime_error("cannot be read: " + systemReason(code));
    const bool ended = count == 0;
    if (progress && (ended || bytes.size() - told >= kMostAtOnce)) {
      told = bytes.size();
      progress(told, size);
    }
    if (!isChecked && (ended || bytes.size() >= kBlock)) {
      most = check(bytes, size);
      isChecked = true;
      if (bytes.size() > most) bytes.resize(size_t(most));
    }
    if (ended || bytes.size() >= most) return bytes;
  }
}

std::vector<uint8_t> readBytes(const std::filesystem::path& path, uint64_t limit, const BeginningCheck& check,
                               const ReadProgress& progress) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (file < 0) throw std::runtime_error("cannot be opened: " + systemReason(errno));
  return readOpenFile(file, MemoryBudget(limit), check, progress);
}

std::vector<uint8_t> readWholeFile(const std::filesystem::path& path, uint64_t limit) {
  try {
    return readBytes(path, limit);
  } catch (const std::runtime_error& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

void checkReplaceable(const std::filesystem::path& path) {
  const auto check = [&](int code) {
    if (code != 0) throw cannotWrite(path, code);
  };
  if (takesWrites(path)) return check(::access(path.c_str(), W_OK) != 0 ? errno : 0);
  const std::filesystem::path target = behindLinks(path);
  const std::filesystem::path folder = folderOf(target);
  std::error_code error;
  check(!target.has_filename() || std::filesystem::is_directory(target, error) ? EISDIR : 0);
  const auto status = std::filesystem::status(folder, error);
  check(!std::filesystem::exists(status) ? ENOENT : !std::filesystem::is_directory(status) ? ENOTDIR : 0);
  check(::access(folder.c_str(), W_OK | X_OK) != 0 ? errno : 0);
}

void checkRoom(const std::filesystem::path& path, uint64_t bytes) {
  if (takesWrites(path)) return;
  const auto fail = [&](int code) {
    throw RenderError("cannot write " + path.string() + ", which may take " +
                      std::to_string((bytes + 999'999) / 1'000'000) + " MB: " + systemReason(code));
  };
  rlimit size{};
  if (::getrlimit(RLIMIT_FSIZE, &size) == 0 && size.rlim_cur != RLIM_INFINITY && bytes > size.rlim_cur)
    fail(EFBIG);
  struct statvfs disk {};
  if (::statvfs(folderOf(behindLinks(path)).c_str(), &disk) != 0 || disk.f_blocks == 0) return;
  const uint64_t blocks = ::geteuid() == 0 ? disk.f_bfree : disk.f_bavail;
  if (bytes / disk.f_frsize >= blocks) fail(ENOSPC);
}

void writeToStandardOutput(std::span<const uint8_t> bytes) {
  filesMayBeWritten = 1;
  const int code = writeAll(STDOUT_FILENO, bytes);
  if (code != 0) throw RenderError("cannot write to standard output: " + systemReason(code));
}

void replaceFile(const std::filesystem::path& path, std::span<const uint8_t> bytes, Kept kept) {
  if (!path.has_filename()) throw cannotWrite(path, EISDIR);
  if (takesWrites(path)) {
    filesMayBeWritten = 1;
    const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    const int code = file < 0 ? errno : writeAndClose(file, bytes, Kept::Briefly);
    if (code != 0) throw cannotWrite(path, code);
    return;
  }
  // Looking through the folder takes time, which a status file has once.
  static std::atomic<bool> hasLooked{false};
  if (kept == Kept::OnDisk || !hasLooked.exchange(true)) removeParts(path);
  const std::filesystem::path part = partOf(path);
  const NamedPart named(part);
  const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file < 0) throw cannotWrite(path, errno);
  renamePart(path, writeAndClose(file, bytes, kept));
}

}  // namespace fragtrace
