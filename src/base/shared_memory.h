// SPDX-License-Identifier: MIT
// Memory that the program shares with a worker process, and messages that carry its descriptor.
#pragma once

#include <cstdint>
#include <span>

namespace fragtrace {

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
