// SPDX-License-Identifier: MIT
// fragtrace_codecs: the libraries of compressed geometry in a process of its own, with limits that the loader
// sets. It ends when the loader does.
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <new>
#include <stdexcept>

#include "gltf/codecs/decode.h"
#include "image/shared_memory.h"

namespace fragtrace {
namespace {

CodecReply refusal(const char* reason) {
  CodecReply reply;
  std::strncpy(reply.reason, reason, sizeof reply.reason - 1);
  return reply;
}

CodecReply answer(const CodecRequest& request, int memoryFile) {
  const uint64_t size = decodedOffset(request) + request.outputBytes;
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, memoryFile, 0);
  ::close(memoryFile);
  if (memory == MAP_FAILED) return refusal("does not fit into memory");
  auto* bytes = static_cast<uint8_t*>(memory);
  const std::span<const uint8_t> input(bytes, request.inputBytes);
  const std::span<uint8_t> output(bytes + decodedOffset(request), request.outputBytes);
  CodecReply reply;
  try {
    request.codec == Codec::Draco ? decodeDraco(request, input, output)
                                  : decodeMeshopt(request, input, output);
    reply.done = true;
  } catch (const std::bad_alloc&) {
    reply = refusal("does not fit into memory");
  } catch (const std::exception& error) {
    reply = refusal(error.what());
  }
  ::munmap(memory, size);
  return reply;
}

}  // namespace
}  // namespace fragtrace

int main() {
  using namespace fragtrace;
  struct stat status {};
  if (::fstat(kCodecProcessSocket, &status) != 0 || !S_ISSOCK(status.st_mode)) {
    static constexpr char kHint[] = "fragtrace_codecs: started by fragtrace, not by hand\n";
    (void)!::write(STDERR_FILENO, kHint, sizeof kHint - 1);
    return 2;
  }
  CodecRequest request;
  int memoryFile = -1;
  while (receiveWithFile(kCodecProcessSocket, asMessage(request), memoryFile)) {
    const CodecReply reply = answer(request, memoryFile);
    if (::send(kCodecProcessSocket, &reply, sizeof reply, MSG_NOSIGNAL) != ssize_t(sizeof reply)) break;
  }
  return 0;
}
