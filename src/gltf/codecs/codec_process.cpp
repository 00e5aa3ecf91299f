// SPDX-License-Identifier: MIT
#include "gltf/codecs/codec_process.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "advice.h"

namespace fragtrace {
namespace {

/// Of Draco data that hold nothing: an answer to it, which is a refusal, proves that the process works.
CodecRequest emptyRequest() {
  CodecRequest request;
  request.outputBytes = 1;  // shared memory cannot be empty
  return request;
}

}  // namespace

bool CodecProcess::available() {
  if (child_) return true;
  if (!whyNot_.empty()) return false;
  try {
    child_ = startChild("fragtrace_codecs", kServiceSocket);
    // One that lacks a library starts, and ends at once.
    CodecReply reply;
    exchange(emptyRequest(), {}, reply);
  } catch (const std::runtime_error& error) {
    whyNot_ = error.what();
  }
  return child_ != nullptr;
}

std::vector<uint8_t> CodecProcess::decode(const CodecRequest& request, std::span<const uint8_t> encoded) {
  if (!available()) throw std::runtime_error(whyNot_);
  CodecReply reply;
  const std::unique_ptr<SharedMemory> memory = exchange(request, encoded, reply);
  if (!reply.done)
    throw std::runtime_error(std::string(reply.reason, ::strnlen(reply.reason, sizeof reply.reason)));
  const std::span<const uint8_t> decoded =
      memory->bytes().subspan(memory->bytes().size() - request.outputBytes);
  return {decoded.begin(), decoded.end()};
}

std::unique_ptr<SharedMemory> CodecProcess::exchange(CodecRequest request, std::span<const uint8_t> encoded,
                                                     CodecReply& reply) {
  // Draco's tables of corners take some hundred bytes per triangle, of which 24 come out.
  constexpr uint64_t kLibraries = uint64_t(256) << 20;
  constexpr uint64_t kOfAByte = 64;
  constexpr uint64_t kBytesASecond = 5'000'000;
  request.inputBytes = encoded.size();
  const uint64_t bytes = request.inputBytes + request.outputBytes;
  const auto seconds = unsigned(2 + bytes / kBytesASecond);
  auto memory = std::make_unique<SharedMemory>(outputOffset(request) + request.outputBytes);
  std::ranges::copy(encoded, memory->bytes().begin());
  limitChild(*child_, kLibraries + kOfAByte * bytes, seconds);
  // The processor time ends it; this is for one that sleeps.
  const int patienceMs = int(std::min(seconds * 20 + 60, 100'000u)) * 1000;
  if (!sendWithFile(child_->socket, asMessage(std::as_const(request)), memory->file()) ||
      !awaitReply(*child_, asMessage(reply), patienceMs)) {
    const std::string end = endChild(*child_);
    child_.reset();
    throw std::runtime_error(end == kLibraryMissing
                                 ? "its libraries are not installed (" + std::string(kCodecAdvice) + ")"
                                 : "the library that decodes it failed: " + end);
  }
  return memory;
}

}  // namespace fragtrace
