// SPDX-License-Identifier: MIT
// What we share with a process of our own: memory, and messages that carry its descriptor.
#pragma once

#include <cstdint>
#include <span>

namespace fragtrace {

/// Memory that both processes see; its size is fixed.
class SharedMemory {
 public:
  /// Throws std::runtime_error.
  explicit SharedMemory(uint64_t size);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  std::span<uint8_t> bytes() const { return {bytes_, size_}; }
  int file() const { return file_; }

 private:
  [[noreturn]] void fail();

  uint64_t size_;
  int file_ = -1;
  uint8_t* bytes_ = nullptr;
};

/// The descriptor of the process's end of the socket.
inline constexpr int kServiceSocket = 3;

/// A request's memory holds its input and, from here on, the output.
template <typename Request>
uint64_t outputOffset(const Request& request) {
  constexpr uint64_t kAlignment = 4096;
  return (request.inputBytes + kAlignment - 1) / kAlignment * kAlignment;
}

/// Sends a message and a file descriptor; false when nobody listens.
bool sendWithFile(int socket, std::span<const uint8_t> message, int file);
/// Waits for a message of exactly that size; the descriptor becomes the caller's. False when the other side
/// has gone.
bool receiveWithFile(int socket, std::span<uint8_t> message, int& file);

template <typename Message>
std::span<const uint8_t> asMessage(const Message& message) {
  return {reinterpret_cast<const uint8_t*>(&message), sizeof message};
}
template <typename Message>
std::span<uint8_t> asMessage(Message& message) {
  return {reinterpret_cast<uint8_t*>(&message), sizeof message};
}

}  // namespace fragtrace
