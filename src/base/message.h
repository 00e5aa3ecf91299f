// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>

namespace fragtrace {

// The protocol between the program and its worker processes (src/base/worker/main.cpp): a request, which
// brings shared memory, and a reply. Both have one form for all kinds of work.

/// The descriptor of the worker's end of the socket.
inline constexpr int kWorkerSocket = 3;
/// The second argument of a worker that is confined after its first request, not before.
inline constexpr const char* kOpensFiles = "opens-files";
/// The exit status of a worker whose libraries are missing, as that of the loader.
inline constexpr int kNotLoaded = 127;

/// The memory holds the input and, from outputOffset() on, room for the output. The input begins with a
/// message of the kind of work.
struct WorkRequest {
  uint64_t inputBytes = 0;  ///< 0: the worker only answers, which proves that its libraries are there
  uint64_t outputBytes = 0;

  uint64_t outputOffset() const {
    constexpr uint64_t kAlignment = 4096;
    return (inputBytes + kAlignment - 1) / kAlignment * kAlignment;
  }
};

struct WorkReply {
  uint64_t done = 0;         ///< 1, or 0 with a reason
  uint64_t outputBytes = 0;  ///< bytes of the output
  char reason[1000] = {};
  char unconfined[104] = {};  ///< why the worker may use all system calls; empty: it may not
};

template <typename Message>
std::span<const uint8_t> asMessage(const Message& message) {
  return {reinterpret_cast<const uint8_t*>(&message), sizeof message};
}
template <typename Message>
std::span<uint8_t> asMessage(Message& message) {
  return {reinterpret_cast<uint8_t*>(&message), sizeof message};
}

/// Takes a message from the front of the bytes. Throws std::runtime_error where they are fewer.
template <typename Message>
Message takeMessage(std::span<const uint8_t>& bytes) {
  Message message;
  if (bytes.size() < sizeof message) throw std::runtime_error("the data are truncated");
  std::memcpy(&message, bytes.data(), sizeof message);
  bytes = bytes.subspan(sizeof message);
  return message;
}

// Memory that the program shares with a worker process, and messages that carry its descriptor.

/// Memory that both processes see; its size is fixed.
class SharedMemory {
 public:
  /// Throws std::runtime_error.
  explicit SharedMemory(uint64_t size);
  /// The memory that came with a message; takes the file over. Throws std::bad_alloc.
  SharedMemory(int file, uint64_t size);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  std::span<uint8_t> bytes() const { return {bytes_, size_}; }
  int file() const { return file_; }

 private:
  bool map();
  [[noreturn]] void fail();

  uint64_t size_;
  int file_ = -1;
  uint8_t* bytes_ = nullptr;
};

/// Sends a message and a file descriptor; false when nobody listens.
bool sendWithFile(int socket, std::span<const uint8_t> message, int file);
/// Waits for a message of exactly that size; the descriptor becomes the caller's. False when the other side
/// has gone.
bool receiveWithFile(int socket, std::span<uint8_t> message, int& file);

}  // namespace fragtrace
