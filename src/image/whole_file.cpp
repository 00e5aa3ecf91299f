// SPDX-License-Identifier: MIT
#include "image/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "errors.h"

namespace fragtrace {
namespace {

std::string systemReason(int code) { return std::generic_category().message(code); }

/// The errno of the first failing call, or 0.
int writeAndClose(int file, std::span<const uint8_t> bytes) {
  int error = 0;
  while (!bytes.empty() && error == 0) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written >= 0)
      bytes = bytes.subspan(size_t(written));
    else if (errno != EINTR)
      error = errno;
  }
  // Network file systems report a full disk only here.
  if (::close(file) != 0 && error == 0) error = errno;
  return error;
}

std::filesystem::path partOf(const std::filesystem::path& path) {
  // A name may be as long as the file system allows (255 bytes); its part must then be cut.
  constexpr size_t kMaximumNameLength = 240;
  std::string name(".");
  name += path.filename().string().substr(0, kMaximumNameLength);
  name += ".part";
  return path.parent_path() / name;
}

}  // namespace

std::vector<uint8_t> readWholeFile(const std::filesystem::path& path) {
  const auto fail = [&](int code) -> InputError {
    return InputError("cannot read " + path.string() + ": " + systemReason(code));
  };
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw fail(errno);

  std::vector<uint8_t> bytes;
  std::array<uint8_t, 1 << 16> block;
  for (;;) {
    const ssize_t count = ::read(file, block.data(), block.size());
    if (count > 0) {
      bytes.insert(bytes.end(), block.begin(), block.begin() + count);
    } else if (count == 0) {
      ::close(file);
      return bytes;
    } else if (errno != EINTR) {
      const int code = errno;
      ::close(file);
      throw fail(code);
    }
  }
}

void checkReplaceable(const std::filesystem::path& path) {
  const auto check = [&](int code) {
    if (code != 0) throw RenderError("cannot write " + path.string() + ": " + systemReason(code));
  };
  const std::filesystem::path folder =
      path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code error;
  check(!path.has_filename() || std::filesystem::is_directory(path, error) ? EISDIR : 0);
  const auto status = std::filesystem::status(folder, error);
  check(!std::filesystem::exists(status) ? ENOENT : !std::filesystem::is_directory(status) ? ENOTDIR : 0);
  check(::access(folder.c_str(), W_OK | X_OK) != 0 ? errno : 0);
}

void replaceFile(const std::filesystem::path& path, std::span<const uint8_t> bytes) {
  const auto fail = [&](int code) -> RenderError {
    return RenderError("cannot write " + path.string() + ": " + systemReason(code));
  };
  if (!path.has_filename()) throw fail(EISDIR);
  const std::filesystem::path part = partOf(path);
  const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file < 0) throw fail(errno);

  int code = writeAndClose(file, bytes);
  if (code == 0 && ::rename(part.c_str(), path.c_str()) != 0) code = errno;
  if (code != 0) {
    ::unlink(part.c_str());
    throw fail(code);
  }
}

}  // namespace fragtrace
