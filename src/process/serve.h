// SPDX-License-Identifier: MIT
// What our processes with other people's libraries have in common: they answer one request after the other,
// each with the shared memory that came with it, until the program that started them has gone.
#pragma once

#include <sys/socket.h>

#include <exception>
#include <new>

#include "process/shared_memory.h"

namespace fragtrace {

/// Whether there is a socket for requests; else the process was started by hand, which is said on stderr.
bool isStartedByProgram(const char* processName);

/// The memory that came with a request, while it is answered.
class RequestMemory {
 public:
  /// Takes the file over. Throws std::bad_alloc.
  RequestMemory(int file, uint64_t size);
  ~RequestMemory();
  RequestMemory(const RequestMemory&) = delete;
  RequestMemory& operator=(const RequestMemory&) = delete;
  uint8_t* bytes() const { return bytes_; }

 private:
  uint64_t size_;
  uint8_t* bytes_ = nullptr;
};

/// Shortens it to the room that there is.
void setReason(std::span<char> room, const char* reason);

/// Calls perform(request, input, output, reply) for each request. What it throws becomes the reply's reason;
/// otherwise the reply is done.
template <typename Request, typename Reply, typename Perform>
void answerRequests(const Perform& perform) {
  Request request;
  int file = -1;
  while (receiveWithFile(kServiceSocket, asMessage(request), file)) {
    Reply reply;
    try {
      const RequestMemory memory(file, outputOffset(request) + request.outputBytes);
      const std::span<const uint8_t> input(memory.bytes(), request.inputBytes);
      const std::span<uint8_t> output(memory.bytes() + outputOffset(request), request.outputBytes);
      perform(request, input, output, reply);
      reply.done = true;
    } catch (const std::bad_alloc&) {
      setReason(reply.reason, "does not fit into memory");
    } catch (const std::exception& error) {
      setReason(reply.reason, error.what());
    }
    if (::send(kServiceSocket, &reply, sizeof reply, MSG_NOSIGNAL) != ssize_t(sizeof reply)) return;
  }
}

}  // namespace fragtrace
