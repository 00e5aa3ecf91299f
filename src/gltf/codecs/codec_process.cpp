// SPDX-License-Identifier: MIT
#include "gltf/codecs/codec_process.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "process/shared_memory.h"

namespace fragtrace {

bool CodecProcess::available() {
  if (child_) return true;
  try {
    child_ = startChild("fragtrace_codecs", kServiceSocket);
  } catch (const std::runtime_error& error) {
    whyNot_ = error.what();
  }
  return child_ != nullptr;
}

std::vector<uint8_t> CodecProcess::decode(CodecRequest request, std::span<const uint8_t> encoded) {
  // Draco's tables of corners take some hundred bytes per triangle, of which 24 come out.
  constexpr uint64_t kLibraries = uint64_t(256) << 20;
  constexpr uint64_t kOfAByte = 64;
  constexpr uint64_t kBytesASecond = 5'000'000;
  if (!available()) throw std::runtime_error(whyNot_);
  request.inputBytes = encoded.size();
  const uint64_t bytes = request.inputBytes + request.outputBytes;
  const auto seconds = unsigned(2 + bytes / kBytesASecond);
  SharedMemory memory(outputOffset(request) + request.outputBytes);
  std::ranges::copy(encoded, memory.bytes().begin());
  limitChild(*child_, kLibraries + kOfAByte * bytes, seconds);
  CodecReply reply;
  // The processor time ends it; this is for one that sleeps.
  const int patienceMs = int(std::min(seconds * 20 + 60, 100'000u)) * 1000;
  if (!sendWithFile(child_->socket, asMessage(std::as_const(request)), memory.file()) ||
      !awaitReply(*child_, asMessage(reply), patienceMs)) {
    const std::string end = endChild(*child_);
    child_.reset();
    throw std::runtime_error("the library that decodes it failed: " + end);
  }
  if (!reply.done)
    throw std::runtime_error(std::string(reply.reason, ::strnlen(reply.reason, sizeof reply.reason)));
  const std::span<const uint8_t> decoded = memory.bytes().subspan(outputOffset(request));
  return {decoded.begin(), decoded.end()};
}

}  // namespace fragtrace
