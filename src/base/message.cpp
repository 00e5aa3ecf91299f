// SPDX-License-Identifier: MIT
#include "base/message.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <new>

#include "base/errors.h"

namespace fragtrace {

namespace {

/// A message that carries one descriptor (man unix, SCM_RIGHTS).
struct Message {
  iovec body{};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr header{};

  Message(void* data, size_t size) : body{data, size} {
    header.msg_iov = &body;
    header.msg_iovlen = 1;
    header.msg_control = control;
    header.msg_controllen = sizeof control;
  }
};

}  // namespace

SharedMemory::SharedMemory(uint64_t size) : size_(size) {
  file_ = ::memfd_create("fragtrace", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (file_ < 0 || ::ftruncate(file_, off_t(size)) != 0) fail();
  // Without the seals, the other side could shorten the file while this one uses it.
  if (::fcntl(file_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) fail();
  if (!map()) fail();
}

SharedMemory::SharedMemory(int file, uint64_t size) : size_(size), file_(file) {
  if (map()) return;
  ::close(file);
  throw std::bad_alloc();
}

bool SharedMemory::map() {
  void* memory = ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (memory == MAP_FAILED) return false;
  bytes_ = static_cast<uint8_t*>(memory);
  return true;
}

SharedMemory::~SharedMemory() {
  if (bytes_ != nullptr) ::munmap(bytes_, size_);
  if (file_ >= 0) ::close(file_);
}

void SharedMemory::fail() {
  const int code = errno;
  if (file_ >= 0) ::close(file_);
  // Shared memory counts as a file.
  throw std::runtime_error(code == EFBIG
                               ? "the limit of the shell on the size of a file is too low (ulimit -f)"
                               : "no memory to share with a process of ours: " + systemReason(code));
}

bool sendWithFile(int socket, std::span<const uint8_t> body, int file) {
  Message message(const_cast<uint8_t*>(body.data()), body.size());  // sendmsg only reads it
  cmsghdr* control = CMSG_FIRSTHDR(&message.header);
  control->cmsg_level = SOL_SOCKET;
  control->cmsg_type = SCM_RIGHTS;
  control->cmsg_len = CMSG_LEN(sizeof file);
  std::memcpy(CMSG_DATA(control), &file, sizeof file);
  ssize_t sent = -1;
  do {
    sent = ::sendmsg(socket, &message.header, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == ssize_t(body.size());
}

bool receiveWithFile(int socket, std::span<uint8_t> body, int& file) {
  Message message(body.data(), body.size());
  ssize_t received = -1;
  do {
    received = ::recvmsg(socket, &message.header, MSG_CMSG_CLOEXEC);
  } while (received < 0 && errno == EINTR);
  const cmsghdr* control = CMSG_FIRSTHDR(&message.header);
  if (received != ssize_t(body.size()) || control == nullptr) return false;
  std::memcpy(&file, CMSG_DATA(control), sizeof file);
  return true;
}

}  // namespace fragtrace
